"""``whacamole plan``: cameras without pixels, and the judging of plans."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from whacamole.cli.options import OwnBodyModel

__all__ = ["plan"]


def plan(
    motions: Annotated[
        Path | None,
        typer.Option(help="Folder or file of motion capture.", show_default="embedded motions"),
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder for the plans.")] = Path("plans"),
    check: Annotated[
        Path | None, typer.Option(help="Judge the plans in this folder or dataset instead of making any.")
    ] = None,
    shots: Annotated[
        str | None, typer.Option(help="Camera moves to choose from.", show_default="auto")
    ] = None,
    shots_per_motion: Annotated[
        int | None, typer.Option(help="Sequences made of each motion.", show_default="1")
    ] = None,
    people: Annotated[
        str | None, typer.Option(help="People in a scene of single motions.", show_default="1")
    ] = None,
    stages: Annotated[
        str | None,
        typer.Option(help="Places to choose from: names, files, folders.", show_default="all built in"),
    ] = None,
    frames: Annotated[
        int | None, typer.Option(help="Frames a sequence at most; 0: all.", show_default="240")
    ] = None,
    size: Annotated[str | None, typer.Option(help="WIDTHxHEIGHT in pixels.", show_default="640x360")] = None,
    fps: Annotated[float | None, typer.Option(help="Frames a second.", show_default="30")] = None,
    focal_mm: Annotated[
        str | None, typer.Option(help="Lens in millimetres: 35, or 24,50.", show_default="24,50")
    ] = None,
    body_model: OwnBodyModel = None,
    seed: Annotated[int | None, typer.Option(help="The one seed of all choices.", show_default="0")] = None,
    limit: Annotated[
        int | None, typer.Option(help="Make at most so many plans.", show_default="no limit")
    ] = None,
    recipe: Annotated[
        Path | None, typer.Option(help="YAML file of these options; what is typed here goes over it.")
    ] = None,
    jobs: Annotated[int, typer.Option(min=1, help="Processes that plan side by side.")] = 1,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")] = False,
    json_output: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Plan the cameras that `render` would film by, with pictures; or judge plans, exit 1 on a breach."""
    from whacamole.production.planning import check_plans
    from whacamole.production.planning_report import plan_with_progress, print_plans
    from whacamole.recipe import load_recipe

    refused: list[str] = []
    if check is not None:
        planned = check_plans(check)
    else:
        given = {
            "motions": motions, "shots": shots, "shots_per_motion": shots_per_motion, "people": people,
            "stages": stages, "frames": frames, "size": size, "fps": fps, "focal_mm": focal_mm,
            "body_model": body_model, "seed": seed, "limit": limit,
        }  # fmt: skip
        overrides: dict[str, Any] = {name: value for name, value in given.items() if value is not None}
        planned, refused = plan_with_progress(
            load_recipe(recipe, overrides), out, jobs, quiet=quiet or json_output
        )
    if json_output:
        typer.echo(json.dumps({"plans": [p.as_dict() for p in planned], "refused": refused}, indent=1))
    else:
        print_plans(planned, refused, quiet=quiet)
    raise typer.Exit(0 if not refused and all(entry.ok for entry in planned) else 1)
