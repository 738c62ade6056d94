"""Train and test, by motion.

Which side a motion falls on depends on its id alone, so a motion that is added later moves no other,
and all shots and all people of a motion are on one side.
"""

from collections.abc import Iterable

from whacamole.dataset.files import write_text
from whacamole.dataset.layout import DatasetLayout
from whacamole.seeds import stable_hash

__all__ = ["side_of", "write_splits"]


def side_of(motion_id: str, test_fraction: float) -> str:
    """Return ``"train"`` or ``"test"`` for a motion.

    The hash of the id is uniform on [0, 1); below ``test_fraction`` the motion is in the test split.
    """
    return "test" if stable_hash(f"split/{motion_id}") / 2**64 < test_fraction else "train"


def write_splits(layout: DatasetLayout, motion_of: Iterable[tuple[str, str]], test_fraction: float) -> None:
    """Write ``splits/train.txt`` and ``splits/test.txt`` from pairs (sequence id, motion id)."""
    sides: dict[str, list[str]] = {"train": [], "test": []}
    for sequence_id, motion_id in sorted(motion_of):
        sides[side_of(motion_id, test_fraction)].append(sequence_id)
    layout.splits.mkdir(parents=True, exist_ok=True)
    for side, ids in sides.items():
        write_text(layout.splits / f"{side}.txt", "".join(f"{sequence_id}\n" for sequence_id in ids))
