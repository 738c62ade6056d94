"""The command line: one file a command, each thin, nothing heavy imported before it is needed."""

import errno
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from whacamole import __version__
from whacamole.cli.baseline import app as baseline
from whacamole.cli.body import body
from whacamole.cli.check import check
from whacamole.cli.doctor import doctor
from whacamole.cli.evaluate import evaluate
from whacamole.cli.export import export
from whacamole.cli.page import page
from whacamole.cli.plan import plan
from whacamole.cli.preview import preview
from whacamole.cli.recipe import recipe
from whacamole.cli.render import render
from whacamole.cli.split import split
from whacamole.cli.stats import stats
from whacamole.cli.status import status
from whacamole.cli.view import view

__all__ = ["app", "main"]

COMMANDS: tuple[Callable[..., Any], ...] = (
    render, plan, check, status, stats, view, preview, page, split, export, evaluate, body, recipe, doctor,
)  # fmt: skip

_CLOSED = (errno.EACCES, errno.EPERM, errno.EROFS)

app = typer.Typer(
    name="whacamole",
    no_args_is_help=True,
    add_completion=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
for command in COMMANDS:
    app.command(command.__name__)(command)
app.add_typer(baseline, name="baseline")


def _tell_version(asked: bool) -> None:
    if asked:
        typer.echo(f"whacamole {__version__}")
        raise typer.Exit


@app.callback()
def _every_command(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_tell_version, is_eager=True, help="Print the version and exit."),
    ] = False,
) -> None:
    """Synthetic video datasets of people and cameras in one metric world."""


def main() -> None:
    """Run the command line; an error a user can mend is one line, not a traceback."""
    try:
        app()
    except Exception as error:
        if not _is_ours(error):
            raise
        typer.echo(f"error: {_told(error)}", err=True)
        sys.exit(1)


def _is_ours(error: Exception) -> bool:
    """Return whether the error is one that names its remedy (the trees are imported late, they cost time)."""
    from camera_rigs import PlanError
    from render_jobs import RenderJobError
    from whacamole.errors import WhacamoleError

    if isinstance(error, OSError):  # of a file, a full disk or missing rights, not of a bug
        return error.filename is not None and error.strerror is not None
    return isinstance(error, WhacamoleError | RenderJobError | PlanError)


def _told(error: Exception) -> str:
    if isinstance(error, OSError) and error.errno in _CLOSED:
        path = Path(error.filename)
        if path.exists() and not os.access(path, os.R_OK):
            return f"{path}: not readable ({error.strerror}); ask its owner for the right to read it"
        place = path if path.is_dir() else path.parent
        return (
            f"{place}: nothing can be written there ({error.strerror}); name another place where the command "
            "takes one, or work on a copy"
        )
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}; check the path, its rights and the disk"
    return str(error)
