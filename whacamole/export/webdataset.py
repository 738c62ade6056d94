"""WebDataset: tar files of a thousand frames, for training from disks that like large reads.

A sample is a frame: its images as they are in the dataset, and its labels cut to that frame.
"""

import io
import json
import tarfile
from pathlib import Path
from typing import Any

import numpy as np

from render_jobs import PASSES
from whacamole.dataset import Sequence
from whacamole.dataset.clips import cut
from whacamole.export.source import Source, image_format

__all__ = ["FRAMES_A_SHARD", "write_webdataset"]

FRAMES_A_SHARD = 1000


def write_webdataset(source: Source, folder: Path) -> list[str]:
    """Write ``<label>-000000.tar`` and on; frames in order, so that neighbours in a shard make clips."""
    samples = ((sequence, frame) for sequence in source for frame in source.frames(sequence))
    shard: tarfile.TarFile | None = None
    try:
        for number, (sequence, frame) in enumerate(samples):
            if number % FRAMES_A_SHARD == 0:
                if shard is not None:
                    shard.close()
                shard = tarfile.open(folder / f"{source.label}-{number // FRAMES_A_SHARD:06d}.tar", "w")  # noqa: SIM115
            assert shard is not None
            for suffix, content in _sample(sequence, frame).items():
                _add(shard, f"{sequence.id}/{frame:06d}.{suffix}", content)
    finally:
        if shard is not None:
            shard.close()
    return []


def _sample(sequence: Sequence, frame: int) -> dict[str, bytes]:
    """Return the files of a sample by suffix: ``jpg`` (or ``png``), ``mask.png``, ``people.npz`` …"""
    files = {}
    for name in sequence.facts["passes"]:
        file = PASSES[name].file(frame, image_format(sequence))
        suffix = file.suffix.lstrip(".")
        content = (sequence.layout.folder / file).read_bytes()
        files[suffix if name == "rgb" else f"{name}.{suffix}"] = content
    one = range(frame, frame + 1)
    for kind in ("camera", "people", "contact"):
        files[f"{kind}.npz"] = _npz(cut(kind, getattr(sequence, kind), one))
    keys = ("motion_id", "shots", "stage", "fps", "width", "height")
    facts = {key: sequence.facts[key] for key in keys if key in sequence.facts}
    files["json"] = json.dumps({"sequence": sequence.id, "frame": frame, **facts}).encode()
    return files


def _npz(arrays: dict[str, Any]) -> bytes:
    stream = io.BytesIO()
    np.savez(stream, **arrays)
    return stream.getvalue()


def _add(shard: tarfile.TarFile, name: str, content: bytes) -> None:
    """Add a file of no owner and no date: the same dataset gives the same bytes."""
    entry = tarfile.TarInfo(name)
    entry.size = len(content)
    entry.mode = 0o644
    shard.addfile(entry, io.BytesIO(content))
