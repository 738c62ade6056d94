"""What a run ends with: how many, how fast, what failed, where to look."""

import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from whacamole.dataset import DatasetLayout, read_summary
from whacamole.production.profiling import profile_as_dict, profile_table, read_profiles
from whacamole.production.space import readable_bytes, sequence_bytes
from whacamole.production.tables import table_console, table_of
from whacamole.production.worklist import Worklist
from whacamole.viewing.places import Places

__all__ = ["Production"]


MOST_ROWS = 60
"""A table with more sequences is for `whacamole stats`, not for the end of a run."""


@dataclass(frozen=True)
class Production:
    """The result of :func:`whacamole.production.produce`.

    Attributes:
        root: the dataset.
        worklist: what the recipe asks for, and what of it is finished now.
        failures: sequence id → one-line error.
        seconds: wall time of the run.
        sides: split → ids of its sequences.
        kept: how many sequences were already finished when it began.
        dry_run: nothing was made.
        problems: stages and maps that could not be used, a line each.
    """

    root: Path
    worklist: Worklist
    failures: dict[str, str]
    seconds: float
    sides: dict[str, list[str]]
    kept: int = 0
    dry_run: bool = False
    problems: tuple[str, ...] = ()

    @property
    def complete(self) -> bool:
        """Whether every sequence is there (of a dry run: could be made) and every file could be used."""
        nothing_refused = not self.worklist.refused and not self.problems
        return nothing_refused and (self.dry_run or not self.worklist.open)

    @property
    def finished(self) -> list[str]:
        """Ids of the sequences asked for that are there, sorted."""
        return sorted(self.worklist.finished & {order.sequence_id for order in self.worklist.orders})

    @property
    def bytes_to_come(self) -> float:
        """What the sequences that are still to be made take on the disk."""
        return sum(sequence_bytes(order) for order in self.worklist.open)

    @cached_property
    def fewer_people(self) -> dict[str, int]:
        """People of each sequence of a single motion that has fewer than the recipe's least number.

        Of one that is not made yet, how many it can have at most.
        """
        found = {}
        for order in self.worklist.orders:
            if order.motion.num_people > 1 or order.recipe.people[0] == 1:
                continue
            made = order.sequence_id in self.worklist.finished
            summary = DatasetLayout(self.root).sequence(order.sequence_id)
            people = int(read_summary(summary)["people"]) if made else order.people
            if people < order.recipe.people[0]:
                found[order.sequence_id] = people
        return found

    def as_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {
            "dataset": str(self.root),
            "sequences": [order.sequence_id for order in self.worklist.orders],
            "finished": self.finished,
            "failed": self.failures,
            "refused": {str(file.path): file.problem for file in self.worklist.refused},
            "refused_stages": list(self.problems),
            "fewer_people": self.fewer_people,
            "bytes_to_come": round(self.bytes_to_come),
            "seconds": round(self.seconds, 3),
            "complete": self.complete and not self.worklist.open,
        }

    def report(self, *, quiet: bool = False, as_json: bool = False, profile: bool = False) -> None:
        """Print the result: a table and what to do next, or JSON; errors in any case.

        Args:
            quiet: print errors only.
            as_json: print JSON alone.
            profile: tell where the time went, in a table or in the JSON.
        """
        profiles = read_profiles(self.root, self.finished) if profile else {}
        if as_json:
            more = {"profile": profile_as_dict(profiles)} if profile else {}
            Console(soft_wrap=True).print_json(json.dumps(self.as_dict() | more))
            return
        errors = Console(stderr=True, soft_wrap=True, highlight=False)
        if not quiet:
            self._print_table(table_console())
            if self.fewer_people:
                Console(soft_wrap=True, highlight=False).print(self._people_note(), markup=False)
        if profiles:
            table_console().print(profile_table(profiles))
        for file in self.worklist.refused:
            errors.print(f"refused: {file.problem}", markup=False)
        for problem in self.problems:
            errors.print(f"refused: {problem}", markup=False)
        for error in self.failures.values():
            errors.print(f"failed: {error}", markup=False)

    def _print_table(self, console: Console) -> None:
        if self.dry_run:
            console.print(self._plan_table())
            to_make = len(self.worklist.open)
            size = readable_bytes(self.bytes_to_come)
            kept = len(self.worklist.orders) - to_make
            console.print(f"{to_make} to make (about {size} on disk), {kept} finished")
            return
        if len(self.worklist.orders) <= MOST_ROWS:
            console.print(self._made_table())
        finished = [order for order in self.worklist.orders if order.sequence_id in self.worklist.finished]
        made = len(finished) - self.kept
        console.print(
            f"{len(finished)} of {len(self.worklist.orders)} sequences in {self.root} "
            f"({made} made in {self.seconds:.0f} s)",
            soft_wrap=True,
        )
        if finished:
            console.print(f"Open {Places(self.root).page} in a browser", soft_wrap=True)

    def _people_note(self) -> str:
        """One line on the sequences with fewer people than asked, and why."""
        orders = {order.sequence_id: order for order in self.worklist.orders}
        few = [orders[name] for name in self.fewer_people]
        fewest = few[0].recipe.people[0]
        causes = []
        if any(order.people < fewest for order in few):
            causes.append("--motions holds too few other motions of one person that last as long")
        if any(self.fewer_people[order.sequence_id] < order.people for order in few):
            causes.append(
                "no free ground was found for all, try a longer list of --stages or fewer --frames "
                "(or a motion is damaged)"
            )
        return (
            f"{len(few)} of {len(orders)} sequences have fewer than {fewest} people, "
            f"{few[0].sequence_id} has {self.fewer_people[few[0].sequence_id]}: {'; '.join(causes)}"
        )

    def _plan_table(self) -> Table:
        table = table_of("sequence", "motion", "format", "people", "frames")
        for order in self.worklist.orders:
            shown = "?" if order.motion.num_frames is None else str(order.frames)
            table.add_row(
                order.sequence_id, str(order.motion.path), order.motion.source, str(order.people), shown
            )
        return table

    def _made_table(self) -> Table:
        layout = DatasetLayout(self.root)
        table = table_of("sequence", "people", "frames", "shots", "split", "visible")
        for order in self.worklist.orders:
            if order.sequence_id not in self.worklist.finished:
                table.add_row(order.sequence_id, "", "", "[red]missing[/]", "", "")
                continue
            facts = read_summary(layout.sequence(order.sequence_id))
            table.add_row(
                order.sequence_id,
                str(facts["people"]),
                str(facts["frames"]),
                ", ".join(facts["shots"]),
                next((side for side, ids in self.sides.items() if order.sequence_id in ids), ""),
                f"{facts['mean_visible_fraction']:.2f}",
            )
        return table
