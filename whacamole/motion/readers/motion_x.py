"""Motion-X: one array (T,322), 30 fps, y up.

Columns: root 3, body 63, fingers 90, jaw 3, expression 50, face shape 100, translation 3, betas 10. The jaw
comes *after* the fingers, unlike in SMPL-X; the eyes are missing; the first 10 expression coefficients are
SMPL-X's.
"""

from __future__ import annotations

import numpy as np

from whacamole.motion.container import ARRAY_KEY, Record
from whacamole.motion.reader import RawPerson, Reader, constant_rate, frames_of

_WIDTH = 322
_ROOT_BODY, _FINGERS, _JAW = slice(0, 66), slice(66, 156), slice(156, 159)
_EXPRESSION, _TRANS, _BETAS = slice(159, 169), slice(309, 312), slice(312, 322)
_rate = constant_rate(30)


def _matches(record: Record) -> bool:
    shape = record.shape(ARRAY_KEY)
    return shape is not None and len(shape) == 2 and shape[1] == _WIDTH


def _read(record: Record) -> tuple[RawPerson, ...]:
    rows = record.array(ARRAY_KEY, _WIDTH)
    eyes = np.zeros((len(rows), 6))
    pose = np.concatenate([rows[:, _ROOT_BODY], rows[:, _JAW], eyes, rows[:, _FINGERS]], axis=1)
    return (
        RawPerson(
            where=record.where,
            model="smplx",
            rate=_rate(record),
            gender="neutral",
            betas=rows[:, _BETAS].mean(axis=0) if len(rows) else np.zeros(10),
            pose=pose.reshape(-1, 55, 3),
            trans=rows[:, _TRANS],
            expression=rows[:, _EXPRESSION],
        ),
    )


READER = Reader(
    name="motion-x",
    title="Motion-X",
    up="+y",
    licence="Motion-X: non-commercial research, https://github.com/IDEA-Research/Motion-X",
    matches=_matches,
    frames=frames_of(ARRAY_KEY),
    rate=_rate,
    read=_read,
)
