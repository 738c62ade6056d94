"""A worker of the farm whose pixels cost nothing, with faults to order: ``python farm_stand_in.py ORDER …``.

All but the making is the product's own: process, events, lock, resuming, the move into the dataset. The
labels are those of a finished sequence, with body shapes drawn from the seed of the order; frames come one at
a time and go on where a killed attempt stopped.

The folder in ``STAND_IN`` holds ``template/``, a sequence, and ``faults/<sequence id>.<fault>``. A fault is
met once, at the third frame; its file goes first. ``faults/disk-full`` stands for as long as it is there.
Every sequence that is moved into the dataset is written to ``made.log``.
"""

import errno
import os
import shutil
import signal
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from whacamole.dataset import SequenceLayout, read_json, write_summary
from whacamole.dataset.files import write_arrays
from whacamole.production.place import make_in_place
from whacamole.production.worker import Say, main
from whacamole.production.worklist import SequenceOrder, motion_checksum
from whacamole.seeds import generator

FAULTY_FRAME = 2
MEMORY_MB = 900
LABELS = ("camera", "people", "contact", "shot")


def home() -> Path:
    """The folder of the stand-in."""
    return Path(os.environ["STAND_IN"])


def make(order: SequenceOrder, say: Say, **_: Any) -> None:
    """Make a sequence, or meet a fault."""

    def fill(sequence: SequenceLayout, work: Path) -> None:
        frames = work / "job" / "out" / "rgb"
        frames.mkdir(parents=True, exist_ok=True)
        there = len(list(frames.iterdir()))
        template = SequenceLayout(home() / "template")
        images = sorted((template.folder / "rgb").iterdir())
        say("step", name="render", frames=len(images), done=there)
        for number, image in enumerate(images):
            if number >= there:
                _meet_fault(order.sequence_id, number)
                shutil.copy(image, work / "beside")
                (work / "beside").rename(frames / image.name)
                say("frame", index=number)
        _meet_full_disk()  # of frames none may be left to draw, and labels take room too
        say("step", name="label", frames=len(images))
        _label(order, template, sequence)
        frames.rename(sequence.folder / "rgb")
        write_summary(sequence, _facts(order, template))

    if not make_in_place(order.root, order.sequence_id, fill):
        return
    with (home() / "made.log").open("a", encoding="utf-8") as log:
        log.write(f"{order.sequence_id}\n")


def _label(order: SequenceOrder, template: SequenceLayout, sequence: SequenceLayout) -> None:
    shutil.rmtree(sequence.folder, ignore_errors=True)
    sequence.folder.mkdir()
    for name in LABELS:
        if name != "people":
            shutil.copy(getattr(template, name), getattr(sequence, name))
    with np.load(template.people, allow_pickle=False) as stored:
        people = {key: stored[key] for key in stored.files}
    rng = generator(order.recipe.seed, order.motion.id, order.shot_index, "stand-in")
    people["betas"] = rng.normal(size=people["betas"].shape).astype(people["betas"].dtype)
    people["motion_id"] = np.full(people["motion_id"].shape, order.motion.id)
    write_arrays(sequence.people, people)


def _facts(order: SequenceOrder, template: SequenceLayout) -> dict[str, Any]:
    changed = {"passes": ["rgb"], "shot_index": order.shot_index, "mean_visible_fraction": 1.0}
    facts = {**read_json(template.summary), **changed}
    facts.pop("checksums")
    motion = {"motion_id": order.motion.id, "motion_sha256": motion_checksum(order.motion)}
    return {**facts, "id": order.sequence_id, **motion}


def _meet_full_disk() -> None:
    if (home() / "faults" / "disk-full").exists():
        (home() / "met-disk-full").touch()
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def _meet_fault(sequence_id: str, frame: int) -> None:
    _meet_full_disk()
    if frame != FAULTY_FRAME:
        return
    for file in (home() / "faults").glob(f"{sequence_id}.*"):
        file.unlink()
        match file.suffix.removeprefix("."):
            case "abort":
                os.abort()
            case "kill":
                os.kill(os.getpid(), signal.SIGKILL)
            case "kill-parent":
                parent = Path("/proc", str(os.getppid()), "cmdline").read_bytes()
                worker_of_a_cluster = b"farm_driver" not in parent  # else the test's own run would end
                os.kill(os.getppid() if worker_of_a_cluster else os.getpid(), signal.SIGKILL)
                time.sleep(600)
            case "hang":
                time.sleep(600)
            case "hunger":
                hoard = np.ones(MEMORY_MB * 2**17)
                time.sleep(600)
                del hoard
            case "hold":
                while not (home() / "go").exists():
                    time.sleep(0.1)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], make))
