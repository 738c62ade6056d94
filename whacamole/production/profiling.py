"""Where the time of a run went: one record a sequence, kept beside the dataset, and their table."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Self

from rich.table import Table

from render_jobs.profile import MEANWHILE
from whacamole.dataset import DatasetLayout, read_json
from whacamole.dataset.files import write_json
from whacamole.errors import DatasetError
from whacamole.production.overlap import LABELLING

__all__ = ["SequenceProfile", "profile_as_dict", "profile_table", "read_profiles"]

REST = "other"


@dataclass(frozen=True)
class SequenceProfile:
    """What one sequence took.

    Attributes:
        frames: how many were rendered for it; those an earlier attempt left are not counted.
        wall: seconds from the start of its process to its end.
        phases: seconds of each phase, one after the other; with ``other`` they add up to ``wall``.
        meanwhile: seconds of what went on beside them, in other threads.
    """

    frames: int
    wall: float
    phases: dict[str, float]
    meanwhile: dict[str, float]

    @classmethod
    def of(cls, frames: int, wall: float, seconds: dict[str, float]) -> Self:
        """Sort the phases, and put what none of them explains under ``other``."""
        beside = MEANWHILE | {LABELLING}
        phases = {name: value for name, value in seconds.items() if name not in beside}
        phases[REST] = wall - sum(phases.values())
        meanwhile = {name: value for name, value in seconds.items() if name in beside}
        return cls(frames, wall, phases, meanwhile)

    @classmethod
    def total(cls, profiles: list[Self]) -> Self:
        """The sum over sequences."""
        return cls(
            sum(profile.frames for profile in profiles),
            sum(profile.wall for profile in profiles),
            _add([profile.phases for profile in profiles]),
            _add([profile.meanwhile for profile in profiles]),
        )

    def save(self, layout: DatasetLayout, sequence_id: str) -> None:
        """Keep the record among the unfinished work, where nothing belongs to the dataset."""
        path = _file(layout, sequence_id)
        path.parent.mkdir(parents=True, exist_ok=True)
        write_json(path, asdict(self))


def read_profiles(root: Path, sequence_ids: list[str]) -> dict[str, SequenceProfile]:
    """The records of those sequences that have one."""
    layout = DatasetLayout(root)
    found = {}
    for name in sequence_ids:
        try:
            found[name] = SequenceProfile(**read_json(_file(layout, name)))
        except (DatasetError, OSError, TypeError):
            continue  # made before, elsewhere, or not at all
    return found


def profile_as_dict(profiles: dict[str, SequenceProfile]) -> dict[str, Any]:
    """Plain values for JSON: each sequence, and the sum."""
    return {
        "sequences": {name: asdict(profile) for name, profile in profiles.items()},
        "sum": asdict(SequenceProfile.total(list(profiles.values()))),
    }


def profile_table(profiles: dict[str, SequenceProfile]) -> Table:
    """A row a phase: seconds, share of the wall time and seconds a frame in sum, then seconds by sequence.

    Only the first sequences get a column of their own.
    """
    total = SequenceProfile.total(list(profiles.values()))
    shown = dict(list(profiles.items())[:6])
    table = Table("phase", title=f"Where the time went, seconds ({len(profiles)} sequences)")
    for name in ("sum", "share", "a frame", *shown):
        table.add_column(name, justify="right", overflow="fold")
    for phase in total.phases:
        table.add_row(
            phase, *_cells(total.phases[phase], total, [p.phases.get(phase) for p in shown.values()])
        )
    table.add_section()
    table.add_row("wall", *_cells(total.wall, total, [profile.wall for profile in shown.values()]))
    table.add_section()
    for phase in total.meanwhile:
        each = [profile.meanwhile.get(phase) for profile in shown.values()]
        table.add_row(f"{phase}, meanwhile", *_cells(total.meanwhile[phase], total, each))
    return table


def _cells(value: float, total: SequenceProfile, each: list[float | None]) -> list[str]:
    share = value / total.wall if total.wall else 0.0
    a_frame = f"{value / total.frames:.3f}" if total.frames else ""
    return [f"{value:.2f}", f"{share:.1%}", a_frame, *("" if one is None else f"{one:.2f}" for one in each)]


def _add(rows: list[dict[str, float]]) -> dict[str, float]:
    added: dict[str, float] = {}
    for row in rows:
        for name, value in row.items():
            added[name] = added.get(name, 0.0) + value
    if REST in added:
        added[REST] = added.pop(REST)  # last
    return added


def _file(layout: DatasetLayout, sequence_id: str) -> Path:
    return layout.profiles / f"{sequence_id}.json"
