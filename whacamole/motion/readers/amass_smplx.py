"""AMASS SMPL-X: ``poses`` (T,165) in SMPL-X order; ``trans``; ``mocap_frame_rate``; z up."""

from __future__ import annotations

from fractions import Fraction

from whacamole.motion.container import Record
from whacamole.motion.reader import RawPerson, Reader, betas_of, frames_of, gender_of, stored_rate


def _matches(record: Record) -> bool:
    shape = record.shape("poses") if "poses" in record.keys else None
    return "trans" in record.keys and shape is not None and shape[1:] in ((165,), (55, 3))


def _rate(record: Record) -> Fraction:
    return stored_rate(record, "mocap_frame_rate", "mocap_framerate")


def read_smplx(record: Record, rate: Fraction) -> tuple[RawPerson, ...]:
    """The person of a file with SMPL-X ``poses`` and ``trans`` at ``rate``."""
    return (
        RawPerson(
            where=record.where,
            model="smplx",
            rate=rate,
            gender=gender_of(record.text("gender")),
            betas=betas_of(record),
            pose=record.array("poses", 55, 3),
            trans=record.array("trans", 3),
        ),
    )


def _read(record: Record) -> tuple[RawPerson, ...]:
    return read_smplx(record, _rate(record))


READER = Reader(
    name="amass-smplx",
    title="AMASS SMPL-X",
    up="+z",
    licence="AMASS: non-commercial research, https://amass.is.tue.mpg.de/license.html",
    matches=_matches,
    frames=frames_of("poses"),
    rate=_rate,
    read=_read,
)
