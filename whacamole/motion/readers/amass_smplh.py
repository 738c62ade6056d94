"""AMASS SMPL+H: ``poses`` (T,156) = root 3, body 63, fingers 90; ``trans``; ``mocap_framerate``; z up.

Finger angles are full rotations (a flat hand is zero); body-only captures hold MANO's mean hand in every
frame.
"""

from __future__ import annotations

from fractions import Fraction

from whacamole.motion.container import Record
from whacamole.motion.reader import RawPerson, Reader, betas_of, frames_of, gender_of, stored_rate

_WIDTH = 156


def _matches(record: Record) -> bool:
    # Also takes damaged AMASS files that no other reader claims, to say what is wrong with them.
    return "poses" in record.keys or {"trans", "mocap_framerate"} <= record.keys


def _rate(record: Record) -> Fraction:
    return stored_rate(record, "mocap_framerate", "mocap_frame_rate")


def _read(record: Record) -> tuple[RawPerson, ...]:
    poses = record.array("poses")
    if poses.ndim != 2 or poses.shape[1] != _WIDTH:
        raise record.fail(
            f"'poses' has shape {poses.shape}, expected (frames, 156) of SMPL+H or (frames, 165) of SMPL-X; "
            "export the full pose"
        )
    return (
        RawPerson(
            where=record.where,
            model="smplh",
            rate=_rate(record),
            gender=gender_of(record.text("gender")),
            betas=betas_of(record),
            pose=poses.reshape(-1, 52, 3),
            trans=record.array("trans", 3),
        ),
    )


READER = Reader(
    name="amass-smplh",
    title="AMASS SMPL+H",
    up="+z",
    licence="AMASS: non-commercial research, https://amass.is.tue.mpg.de/license.html",
    matches=_matches,
    frames=frames_of("poses"),
    rate=_rate,
    read=_read,
)
