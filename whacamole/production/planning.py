"""Cameras without pixels: the plans that `render` would film by, as files and pictures, and their judging."""

from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from camera_rigs import Finding, Plan, PlanError, judge_document, to_nerfstudio, to_tum
from whacamole.dataset import DatasetLayout, SequenceLayout, read_json
from whacamole.dataset.files import write_arrays, write_json, write_text
from whacamole.errors import DatasetError, WhacamoleError
from whacamole.labels.camera import camera_arrays
from whacamole.production.drawing import plan_svg
from whacamole.production.filming import film_of, plan_camera
from whacamole.production.sequence import take_of
from whacamole.production.worklist import SequenceOrder, Worklist, work_of
from whacamole.recipe import Recipe

__all__ = ["Planned", "check_plans", "make_plans"]


@dataclass(frozen=True)
class Planned:
    """What became of one sequence's plan.

    Attributes:
        sequence_id: its name.
        frames: T.
        shots: kinds, in order.
        mends: how many times a draft was changed to keep the rules.
        findings: rules still broken.
        error: one line where there is no plan.
    """

    sequence_id: str
    frames: int = 0
    shots: tuple[str, ...] = ()
    mends: int = 0
    findings: tuple[Finding, ...] = ()
    error: str = ""

    @property
    def ok(self) -> bool:
        """Whether there is a plan and it breaks no rule."""
        return not self.error and not self.findings

    def as_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {
            "id": self.sequence_id,
            "frames": self.frames,
            "shots": list(self.shots),
            "mends": self.mends,
            "findings": [vars(finding) for finding in self.findings],
            "error": self.error,
        }


def make_plans(
    recipe: Recipe, out: Path, *, jobs: int = 1, on_plan: Callable[[Planned], None] = lambda _: None
) -> tuple[Worklist, list[Planned]]:
    """Plan every sequence of ``recipe`` into folders below ``out/sequences``.

    Each holds ``camera.npz`` and ``shot.json`` as a rendered sequence would, ``camera.tum``,
    ``transforms.json`` and the picture ``plan.svg``.

    Args:
        jobs: processes.
        on_plan: told of each plan as it is made.

    Raises:
        MotionError: there is no motion.
    """
    worklist = work_of(recipe, out.resolve())
    planned = []
    for result in _mapped(plan_sequence, list(worklist.orders), jobs):
        on_plan(result)
        planned.append(result)
    return worklist, planned


def _mapped(
    function: Callable[[SequenceOrder], Planned], orders: list[SequenceOrder], jobs: int
) -> Iterator[Planned]:
    if jobs == 1:
        yield from map(function, orders)
        return
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(function, orders)


def plan_sequence(order: SequenceOrder) -> Planned:
    """Plan one sequence and write its files; an error is told, not raised, so that the others go on."""
    try:
        take = take_of(order, textures=None)
        plan = plan_camera(take, order.recipe, order.shot_index)
    except (WhacamoleError, PlanError) as error:
        return Planned(order.sequence_id, error=str(error))
    sequence = DatasetLayout(order.root).sequence(order.sequence_id)
    sequence.folder.mkdir(parents=True, exist_ok=True)
    film = film_of(take, plan, order.recipe, order.shot_index)
    write_arrays(sequence.camera, camera_arrays(plan.path, film))
    write_json(sequence.shot, plan.to_json())
    write_text(sequence.folder / "camera.tum", to_tum(plan.path))
    write_json(sequence.folder / "transforms.json", to_nerfstudio(plan.path))
    picture = plan_svg(plan, take.subject, take.stage.world, f"{order.sequence_id} ({take.stage.name})")
    write_text(sequence.folder / "plan.svg", picture)
    return _told(order.sequence_id, plan)


def _told(sequence_id: str, plan: Plan) -> Planned:
    kinds = tuple(shot.kind for shot in plan.shots)
    return Planned(sequence_id, plan.path.num_frames, kinds, len(plan.mends), plan.findings)


def check_plans(root: Path) -> list[Planned]:
    """Judge every stored plan below ``root`` again: a folder of plans, a dataset, or one sequence.

    Raises:
        DatasetError: there is no plan.
    """
    folders = sorted({path.parent for path in root.rglob("shot.json") if ".work" not in path.parts})
    if not folders:
        raise DatasetError(f"{root}: holds no shot.json; make plans with `whacamole plan --out {root}`")
    return [_judged(SequenceLayout(folder)) for folder in folders]


def _judged(sequence: SequenceLayout) -> Planned:
    name = sequence.folder.name
    try:
        document = read_json(sequence.shot)
        with sequence.camera.open("rb") as stream, np.load(stream, allow_pickle=False) as camera:
            findings = judge_document(
                document, camera["K"], camera["T_world_camera"], int(camera["width"]), int(camera["height"])
            )
            frames = len(camera["K"])
    except (WhacamoleError, PlanError) as error:
        return Planned(name, error=f"{sequence.shot}: {error}")
    except (OSError, ValueError, KeyError) as error:
        return Planned(name, error=f"{sequence.camera}: not readable ({error}); plan it again")
    kinds = tuple(str(shot["kind"]) for shot in document["shots"])
    return Planned(name, frames, kinds, len(document["mends"]), findings)
