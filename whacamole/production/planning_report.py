"""What a person sees of planning: progress, a table of shots, and every finding on a line."""

from pathlib import Path

from rich.console import Console

from whacamole.dataset import DatasetLayout
from whacamole.production.locations import places_of
from whacamole.production.planning import Planned, make_plans
from whacamole.production.tables import table_console, table_of
from whacamole.recipe import Recipe
from whacamole.words import counted

__all__ = ["plan_with_progress", "print_plans"]


def plan_with_progress(
    recipe: Recipe, out: Path, jobs: int, *, quiet: bool
) -> tuple[list[Planned], list[str]]:
    """Make the plans of ``recipe``; return them and the one-line reasons of refused files."""
    console = Console(stderr=True, quiet=quiet)
    with console.status("planning") as status:
        made = 0

        def tell(entry: Planned) -> None:
            nonlocal made
            made += 1
            status.update(f"planning: {made} done, last {entry.sequence_id}")

        worklist, planned = make_plans(recipe, out, jobs=jobs, on_plan=tell)
    problems = places_of(recipe, DatasetLayout(out.resolve())).problems
    return planned, [*(str(file.problem) for file in worklist.refused), *problems]


def print_plans(planned: list[Planned], refused: list[str], *, quiet: bool) -> None:
    """Print a table of the plans, and every error and finding on a line of its own."""
    errors = Console(stderr=True, soft_wrap=True, highlight=False)
    if not quiet:
        table = table_of("sequence", "frames", "shots", "mended", "findings")
        for entry in planned:
            shots = ", ".join(entry.shots)
            table.add_row(
                entry.sequence_id, str(entry.frames), shots, str(entry.mends), str(len(entry.findings))
            )
        console = table_console()
        console.print(table)
        breaches = sum(not entry.ok for entry in planned)
        console.print(f"{counted(len(planned), 'plan')}, {breaches} with a breach or an error")
    for reason in refused:
        errors.print(f"refused: {reason}", markup=False)
    for entry in planned:
        if entry.error:
            errors.print(f"{entry.sequence_id}: {entry.error}", markup=False)
        for finding in entry.findings:
            place = f"frame {finding.frame}"
            text = f"{finding.rule} {finding.value:.4g}, limit {finding.limit:.4g}"
            errors.print(f"{entry.sequence_id}: {place}: {text}", markup=False)
