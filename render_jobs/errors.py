"""What can go wrong with a render job, as exceptions.

::

    RenderJobError           a job cannot be built, read or rendered; the message is one line for the user
    ├── EngineError    this machine cannot run the engine; the message names the remedy
    ├── WorkerError    the child process failed; trying again may help
    └── PostponedError nothing failed, but it cannot be done at present; trying later will help
"""

from __future__ import annotations

from pathlib import Path


class RenderJobError(Exception):
    """A job cannot be built, read or rendered. The message is one line that names the value and the
    remedy."""


class EngineError(RenderJobError):
    """This machine cannot run the engine asked for. The message names the remedy."""


class WorkerError(RenderJobError):
    """The rendering process crashed, hung or reported an error.

    Attributes:
        log: the log file of the job, which holds everything the process printed.
    """

    def __init__(self, message: str, log: Path) -> None:
        super().__init__(message)
        self.log = log

    def __reduce__(self) -> tuple[type[WorkerError], tuple[str, Path]]:
        return type(self), (str(self), self.log)  # it may come back from another machine


class PostponedError(RenderJobError):
    """A task cannot be done at present (somebody else does it, the disk is full); no attempt has failed.

    Attributes:
        patience: seconds for which it makes sense to ask again; None is for ever.
    """

    def __init__(self, message: str, patience: float | None = None) -> None:
        super().__init__(message)
        self.patience = patience
