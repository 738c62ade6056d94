"""BEDLAM motions: SMPL-X ``poses`` (T,165), ``trans``, ``mocap_frame_rate`` and ``global_ori``; y up.

The same names as AMASS SMPL-X in other axes. ``global_ori`` (a copy of the root) or ``motion_info`` gives
them away.
"""

from __future__ import annotations

from fractions import Fraction

from whacamole.motion.container import Record
from whacamole.motion.reader import RawPerson, Reader, frames_of, rate_or
from whacamole.motion.readers.amass_smplx import read_smplx


def _matches(record: Record) -> bool:
    return {"poses", "trans"} <= record.keys and bool({"global_ori", "motion_info"} & record.keys)


def _rate(record: Record) -> Fraction:
    return rate_or(record, 30, "mocap_frame_rate", "mocap_framerate")


def _read(record: Record) -> tuple[RawPerson, ...]:
    return read_smplx(record, _rate(record))


READER = Reader(
    name="bedlam",
    title="BEDLAM",
    up="+y",
    licence="BEDLAM: non-commercial research, https://bedlam.is.tue.mpg.de/license.html",
    matches=_matches,
    frames=frames_of("poses"),
    rate=_rate,
    read=_read,
)
