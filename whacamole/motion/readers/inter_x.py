"""Inter-X: ``P1.npz`` and ``P2.npz`` in one folder, SMPL-X by parts, 120 fps, y up.

``root_orient`` (T,3), ``pose_body`` (T,21,3), ``pose_lhand`` and ``pose_rhand`` (T,15,3), ``trans``,
``betas`` (1,10), ``gender``. The file stores no rate. Files of this schema under other names are single
people.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from whacamole.motion.container import Record
from whacamole.motion.reader import PairNames, RawPerson, Reader, betas_of, frames_of, gender_of, rate_or


def _matches(record: Record) -> bool:
    return {"root_orient", "pose_body", "pose_lhand", "pose_rhand"} <= record.keys


def _rate(record: Record) -> Fraction:
    return rate_or(record, 120, "mocap_frame_rate", "mocap_framerate", "fps")


def _read(record: Record) -> tuple[RawPerson, ...]:
    body = record.array("pose_body", 21, 3)
    parts = {
        "root_orient": record.array("root_orient", 1, 3),
        "pose_body": body,
        "pose_lhand": record.array("pose_lhand", 15, 3),
        "pose_rhand": record.array("pose_rhand", 15, 3),
    }
    for key, part in parts.items():
        if len(part) != len(body):
            raise record.fail(
                f"'{key}' has {len(part)} frames, 'pose_body' {len(body)}; cut both to one length"
            )
    return (
        RawPerson(
            where=record.where,
            model="smplx",
            rate=_rate(record),
            gender=gender_of(record.text("gender")),
            betas=betas_of(record),
            # Root, body and fingers without jaw and eyes: the order of SMPL-H with the joints of SMPL-X.
            pose=np.concatenate(list(parts.values()), axis=1),
            trans=record.array("trans", 3),
        ),
    )


READER = Reader(
    name="inter-x",
    title="Inter-X",
    up="+y",
    licence="Inter-X: non-commercial research, https://github.com/liangxuy/Inter-X",
    matches=_matches,
    frames=frames_of("pose_body"),
    rate=_rate,
    read=_read,
    pair=PairNames("P1", "P2"),
)
