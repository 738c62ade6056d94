"""InterHuman: one pickle with ``person1`` and ``person2``, SMPL-H without fingers, 30 fps, z up.

Each person: ``root_orient`` (T,3), ``pose_body`` (T,63), ``trans`` (T,3), ``betas`` (10). A
``mocap_framerate`` beside the people overrides the rate.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from whacamole.motion.container import Record
from whacamole.motion.reader import RawPerson, Reader, betas_of, gender_of, rate_or

_PEOPLE = ("person1", "person2")


def _matches(record: Record) -> bool:
    return set(_PEOPLE) <= record.keys


def _rate(record: Record) -> Fraction:
    return rate_or(record, 30, "mocap_framerate", "mocap_frame_rate")


def _frames(record: Record) -> int | None:
    shapes = [record.child(name).shape("trans") for name in _PEOPLE]
    lengths = [shape[0] for shape in shapes if shape]
    return min(lengths) if len(lengths) == len(_PEOPLE) else None


def _read(record: Record) -> tuple[RawPerson, ...]:
    return tuple(_person(record.child(name), _rate(record)) for name in _PEOPLE)


def _person(person: Record, rate: Fraction) -> RawPerson:
    root, body = person.array("root_orient", 1, 3), person.array("pose_body", 21, 3)
    if len(root) != len(body):
        raise person.fail(f"{len(root)} 'root_orient' but {len(body)} 'pose_body'; cut both to one length")
    return RawPerson(
        where=person.where,
        model="smplh",
        rate=rate,
        gender=gender_of(person.text("gender")),
        betas=betas_of(person),
        pose=np.concatenate([root, body], axis=1),
        trans=person.array("trans", 3),
    )


READER = Reader(
    name="interhuman",
    title="InterHuman",
    up="+z",
    licence="InterHuman: CC BY-NC-SA 4.0, https://github.com/tr3e/InterGen",
    matches=_matches,
    frames=_frames,
    rate=_rate,
    read=_read,
    people=2,
)
