"""AIST++: a pickle with ``smpl_poses`` (T,72), ``smpl_trans`` (T,3) and ``smpl_scaling``; 60 fps, y up.

The bodies are SMPL bodies *scaled*: x = scaling · SMPL(pose) + trans, in centimetres or so. Divided by the
scaling it is an SMPL body of its own size again, in metres. An ``fps`` beside it overrides the rate
(generated dances have 30).
"""

from __future__ import annotations

from fractions import Fraction

from whacamole.motion.container import Record
from whacamole.motion.reader import RawPerson, Reader, betas_of, frames_of, gender_of, rate_or


def _matches(record: Record) -> bool:
    return "smpl_poses" in record.keys


def _rate(record: Record) -> Fraction:
    return rate_or(record, 60, "fps")


def _read(record: Record) -> tuple[RawPerson, ...]:
    scaling = record.number("smpl_scaling")
    if scaling <= 0:
        raise record.fail(f"'smpl_scaling' is {scaling:g}; give the body's scale, a number above zero")
    return (
        RawPerson(
            where=record.where,
            model="smpl",
            rate=_rate(record),
            gender=gender_of(record.text("gender")),
            betas=betas_of(record),
            # SMPL's last two joints are hands without fingers; SMPL-X has no place for them.
            pose=record.array("smpl_poses", 24, 3)[:, :22],
            trans=record.array("smpl_trans", 3) / scaling,
        ),
    )


READER = Reader(
    name="aist++",
    title="AIST++",
    up="+y",
    licence="AIST++: CC BY 4.0 (annotations), https://google.github.io/aistplusplus_dataset",
    matches=_matches,
    frames=frames_of("smpl_poses"),
    rate=_rate,
    read=_read,
)
