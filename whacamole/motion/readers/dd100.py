"""DD100 (Duolando): a pickled dictionary a dancer, ``NAME_00.npy`` and ``NAME_01.npy``; 30 fps, y down.

``poses`` (T,165) or (T,55,3) in SMPL-X order with flat hands at zero; ``transl``; ``betas`` a row a frame;
``meta`` with the gender. The file stores no rate. Which half leads is no question of contact or of labels, so
both halves are simply people, in the order of their names.
"""

from __future__ import annotations

from fractions import Fraction

from whacamole.motion.container import Record
from whacamole.motion.reader import (
    PairNames,
    RawPerson,
    Reader,
    betas_of,
    constant_rate,
    frames_of,
    gender_of,
)


def _matches(record: Record) -> bool:
    return {"poses", "transl"} <= record.keys


def _read(record: Record) -> tuple[RawPerson, ...]:
    gender = record.text("gender")
    if "meta" in record.keys:
        gender = record.child("meta").text("gender", gender)
    return (
        RawPerson(
            where=record.where,
            model="smplx",
            rate=Fraction(30),
            gender=gender_of(gender),
            betas=betas_of(record),
            pose=record.array("poses", 55, 3),
            trans=record.array("transl", 3),
        ),
    )


READER = Reader(
    name="dd100",
    title="DD100",
    up="-y",
    licence="DD100: non-commercial research, https://github.com/lisiyao21/Duolando",
    matches=_matches,
    frames=frames_of("poses"),
    rate=constant_rate(30),
    read=_read,
    pair=PairNames("_00", "_01"),
    up_stated=False,
)
