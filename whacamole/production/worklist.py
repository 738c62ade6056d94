"""What there is to make: one order a sequence, each independent of all the others."""

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

from whacamole.dataset import DatasetLayout, read_summary
from whacamole.dataset.files import sha256_of
from whacamole.errors import DatasetError
from whacamole.motion import FPS, MotionFile, embedded_motions, find_motions
from whacamole.recipe import Recipe
from whacamole.seeds import generator, stable_hash

__all__ = ["SequenceOrder", "Worklist", "companions_of", "failure_note", "motion_checksum", "work_of"]


UNKNOWN_FRAMES = 240
"""Taken for the length of a motion whose header does not tell it."""


@dataclass(frozen=True)
class SequenceOrder:
    """Everything a process needs to make one sequence, as plain data.

    Attributes:
        sequence_id: its name in the dataset.
        motion: the file(s) it comes from.
        shot_index: the how-manieth sequence of this motion.
        root: the dataset's folder.
        recipe: what is made.
        companions: motions of further people in the scene.
    """

    sequence_id: str
    motion: MotionFile
    shot_index: int
    root: Path
    recipe: Recipe
    companions: tuple[MotionFile, ...] = ()

    @property
    def frames(self) -> int:
        """How many frames it will have, as far as the header of the motion tells."""
        whole, asked = self.motion.num_frames, self.recipe.frames
        if whole is None:
            return asked or UNKNOWN_FRAMES
        filmed = max(1, int((whole - 1) * self.recipe.fps / FPS) - 1)
        return min(filmed, asked or filmed)

    @property
    def people(self) -> int:
        """How many people it will have."""
        return self.motion.num_people + len(self.companions)

    def as_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {
            "sequence_id": self.sequence_id,
            "motion": _file_as_dict(self.motion),
            "companions": [_file_as_dict(file) for file in self.companions],
            "shot_index": self.shot_index,
            "root": str(self.root),
            "recipe": self.recipe.save_as_dict(),
        }

    @classmethod
    def from_dict(cls, value: dict[str, Any]) -> Self:
        """Return the order that :meth:`as_dict` wrote."""
        return cls(
            sequence_id=value["sequence_id"],
            motion=_file_from_dict(value["motion"]),
            companions=tuple(_file_from_dict(file) for file in value["companions"]),
            shot_index=value["shot_index"],
            root=Path(value["root"]),
            recipe=Recipe.model_validate(value["recipe"]),
        )


@dataclass(frozen=True)
class Worklist:
    """The orders of a run, what is finished of them, and the files that cannot be used."""

    orders: tuple[SequenceOrder, ...]
    finished: frozenset[str]
    refused: tuple[MotionFile, ...]

    @property
    def open(self) -> tuple[SequenceOrder, ...]:
        """The orders still to be made."""
        return tuple(order for order in self.orders if order.sequence_id not in self.finished)

    def part(self, index: int, count: int) -> Self:
        """Return every ``count``-th order from the ``index``-th on (from 1); all parts together are all.

        An order's part does not depend on what is finished.
        """
        return replace(self, orders=self.orders[index - 1 :: count])


def work_of(recipe: Recipe, root: Path) -> Worklist:
    """Return what ``recipe`` asks for in the dataset at ``root``.

    Orders go shot by shot, so that a run stopped early has seen every motion.

    Raises:
        MotionError: there is no motion at all.
        DatasetError: a finished sequence was made from another file of the same name.
    """
    files = find_motions(recipe.motions if recipe.motions is not None else embedded_motions())
    usable = [file for file in files if file.problem is None]
    orders = [
        SequenceOrder(
            f"{file.id}-{shot:02d}", file, shot, root, recipe, companions_of(file, shot, usable, recipe)
        )
        for shot in range(recipe.shots_per_motion)
        for file in usable
    ][: recipe.limit]
    finished = frozenset(DatasetLayout(root).finished())
    for order in orders:
        if order.sequence_id in finished:
            _check_same_motion(order)
    return Worklist(tuple(orders), finished, tuple(file for file in files if file.problem is not None))


def companions_of(
    motion: MotionFile, shot_index: int, usable: list[MotionFile], recipe: Recipe
) -> tuple[MotionFile, ...]:
    """Draw the motions of further people for a single person's sequence; a pair stays by itself.

    Each candidate is ranked by a hash of its own id with the sequence's, so a motion added later displaces at
    most one of them, and only where it ranks first.
    """
    fewest, most = recipe.people
    if motion.num_people > 1 or most == 1:
        return ()
    count = int(generator(recipe.seed, motion.id, shot_index, "people").integers(fewest, most + 1)) - 1
    whole = motion.num_frames or 0  # as MotionFile counts them, at 30 fps
    needed = min(whole, math.ceil((recipe.frames + 2) * FPS / recipe.fps) if recipe.frames else whole)
    fitting = [
        file
        for file in usable
        if file.num_people == 1 and file.id != motion.id and (file.num_frames or 0) >= needed
    ]
    key = f"{recipe.seed}/{motion.id}/{shot_index}"
    return tuple(sorted(fitting, key=lambda file: stable_hash(f"{key}/{file.id}"))[:count])


def _file_as_dict(file: MotionFile) -> dict[str, Any]:
    return {
        "id": file.id, "paths": [str(path) for path in file.paths], "source": file.source,
        "num_frames": file.num_frames, "num_people": file.num_people,
    }  # fmt: skip


def _file_from_dict(value: dict[str, Any]) -> MotionFile:
    paths = tuple(Path(path) for path in value["paths"])
    return MotionFile(
        id=value["id"], paths=paths, source=value["source"],
        num_frames=value["num_frames"], num_people=value["num_people"],
    )  # fmt: skip


def failure_note(order: SequenceOrder) -> Path:
    """Return the file that says why a sequence was given up."""
    return DatasetLayout(order.root).work_of(order.sequence_id) / "failed.json"


def motion_checksum(motion: MotionFile) -> str:
    """Return the sha256 of the motion's file, or those of its files joined by ``+``."""
    return "+".join(sha256_of(path) for path in motion.paths)


def _check_same_motion(order: SequenceOrder) -> None:
    made_of = read_summary(DatasetLayout(order.root).sequence(order.sequence_id)).get("motion_sha256")
    if made_of != motion_checksum(order.motion):
        raise DatasetError(
            f"{order.root}: {order.sequence_id} was made from another file than {order.motion.path}; "
            "choose another --out, or delete the sequence's folder"
        )
