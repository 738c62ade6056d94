"""The one tree of exceptions of ``whacamole``.

::

    WhacamoleError
    ├── MotionError        a motion file cannot be used
    ├── BodyModelError     a body model file cannot be used
    ├── RecipeError        the recipe or a command-line option is wrong
    ├── TakeError          a scene cannot be staged
    ├── DatasetError       a dataset folder is broken or is not one
    ├── BaselineError      the baseline cannot run on this input
    └── EvaluationError    predictions or ground truth cannot be scored

Every message names the file, the value and the remedy, and fits on one line.
``camera_rigs`` and ``render_jobs`` stand below this package and own their errors
(:class:`camera_rigs.PlanError`, :class:`render_jobs.RenderJobError`).
"""


class WhacamoleError(Exception):
    """Base of all errors a user can mend."""


class MotionError(WhacamoleError):
    """A motion file cannot be used."""


class BodyModelError(WhacamoleError):
    """A body model file cannot be used."""


class RecipeError(WhacamoleError):
    """The recipe or a command-line option is wrong."""


class TakeError(WhacamoleError):
    """A scene cannot be staged."""


class DatasetError(WhacamoleError):
    """A dataset folder is broken or is not one."""


class BaselineError(WhacamoleError):
    """The baseline cannot run on this input."""


class EvaluationError(WhacamoleError):
    """Predictions or ground truth cannot be scored."""
