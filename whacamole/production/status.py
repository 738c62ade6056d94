"""How far a dataset is, read from its folder alone, so that any terminal on any machine may ask."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from whacamole.dataset import DatasetLayout, read_json
from whacamole.errors import DatasetError
from whacamole.production.worklist import failure_note, work_of
from whacamole.recipe import Recipe

__all__ = ["Status", "status_of"]


@dataclass(frozen=True)
class Status:
    """The state of a dataset.

    Attributes:
        dataset: its folder.
        asked: sequences that its recipe asks for.
        finished: how many of them are there.
        begun: sequence id → (frames rendered, frames to render), of those not finished.
        failed: sequence id → one-line error, of those given up in the last run that tried them.
    """

    dataset: str
    asked: int
    finished: int
    begun: dict[str, tuple[int, int]]
    failed: dict[str, str]

    def as_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return asdict(self)

    def as_text(self) -> str:
        """Return the state as lines for a terminal."""
        lines = [f"{self.dataset}: {self.finished} of {self.asked} sequences finished"]
        lines += [f"  {name}: {done} of {total or '?'} frames" for name, (done, total) in self.begun.items()]
        lines += [f"  {name}: failed: {error}" for name, error in self.failed.items()]
        return "\n".join(lines)


def status_of(root: Path) -> Status:
    """Return the state of the dataset at ``root``.

    Raises:
        DatasetError: there is no dataset.
    """
    layout = DatasetLayout(root.resolve())
    if not (layout.root / "recipe.json").exists():
        raise DatasetError(f"{root}: no dataset made by `whacamole render` (recipe.json is not there)")
    worklist = work_of(Recipe.model_validate(read_json(layout.root / "recipe.json")), layout.root)
    begun: dict[str, tuple[int, int]] = {}
    failed: dict[str, str] = {}
    for order in worklist.open:
        work = layout.work_of(order.sequence_id)
        if failure_note(order).exists():
            failed[order.sequence_id] = str(read_json(failure_note(order))["error"])
        elif work.exists():
            begun[order.sequence_id] = (_frames_done(work), order.recipe.frames)
    done = len(worklist.orders) - len(worklist.open)
    return Status(str(layout.root), len(worklist.orders), done, begun, failed)


def _frames_done(work: Path) -> int:
    return sum(1 for path in (work / "job" / "out" / "rgb").glob("*") if not path.name.startswith("."))
