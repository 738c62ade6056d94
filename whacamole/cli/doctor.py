"""``whacamole doctor``: what this machine can do."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from whacamole.diagnosis import Check

__all__ = ["doctor"]

_STYLE = {"ok": "green", "warning": "yellow", "error": "red"}


def doctor(
    out: Annotated[
        Path, typer.Option(help="Folder in which datasets would be made; its disk is looked at.")
    ] = Path(),
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print nothing; the exit code tells.")] = False,
    json_output: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Say what this machine can do and, where something is missing, what to do about it.

    The exit code is 0 if `whacamole render` can run here, else 1.
    """
    try:
        from whacamole.diagnosis import can_render, diagnose, report_as_dict
    except ImportError as error:
        typer.echo(f"packages: {error}; pip install --constraint constraints.txt whacamole", err=True)
        raise typer.Exit(1) from None

    checks = diagnose(out)
    if json_output:
        typer.echo(json.dumps(report_as_dict(checks), indent=1))
    elif not quiet:
        _print(checks)
        typer.echo("This machine can render." if can_render(checks) else "This machine cannot render yet.")
    raise typer.Exit(0 if can_render(checks) else 1)


def _print(checks: "list[Check]") -> None:
    """A table of what there is, and under it the remedies on lines of their own, ready to be copied."""
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    table = Table(box=None, pad_edge=False)
    for title in ("", "state", "found"):
        table.add_column(title, overflow="fold")
    for check in checks:
        table.add_row(check.name, f"[{_STYLE[check.state]}]{check.state}[/]", escape(check.found))
    Console().print(table)
    for check in checks:
        if check.remedy:
            typer.echo(f"{check.name}: {check.remedy}")
