"""EMDB's files, ``P0/<name>/P0_<name>_data.pkl``, one a person and sequence, for evaluators of EMDB.

EMDB holds SMPL, this dataset SMPL-X: ``smpl`` has the 21 body joints the two share on a body of mean shape,
its pelvis where the person's is; ``smplx`` beside it has the exact parameters. The world has y up.
"""

import pickle
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from whacamole.body import JOINT_INDEX
from whacamole.dataset import Sequence
from whacamole.export.frames import Y_UP_FROM_Z_UP, WorldPeople, cameras_in, people_in, rest_pelvis
from whacamole.export.rows import person_name
from whacamole.export.source import Source, image_format

__all__ = ["SMPL_REST_PELVIS", "write_emdb"]

SUBJECT = "P0"
SMPL_REST_PELVIS = np.array([-0.0018, -0.2233, 0.0282])
"""Rest pelvis of the male SMPL model of mean shape [m]; ``gender`` in the files is male for that reason."""

SMPL_HANDS = (JOINT_INDEX["left_middle1"], JOINT_INDEX["right_middle1"])
"""SMPL's last two joints are the hands, at the knuckles."""

STILL = 1e-6
"""Pixels; a focal length that changes by more cannot be held by the one matrix EMDB has a sequence."""


def write_emdb(source: Source, folder: Path) -> list[str]:
    """Write one folder a person, with a link to the frames; return the sequences that zoom, left out."""
    notes = []
    for sequence in source:
        if np.ptp(sequence.camera["K"], axis=0).max() > STILL:
            notes.append(f"{sequence.id}: left out, its focal length changes and EMDB holds one a sequence")
            continue
        world = people_in(Y_UP_FROM_Z_UP, sequence.people)
        for person in range(len(sequence.people["track_id"])):
            name = person_name(sequence, person)
            place = folder / SUBJECT / name
            place.mkdir(parents=True)
            image_format(sequence)  # EMDB has a folder of images
            frames = sequence.layout.folder / "rgb"
            (place / "images").symlink_to(source.from_out(frames, f"{SUBJECT}/{name}"))
            with (place / f"{SUBJECT}_{name}_data.pkl").open("wb") as stream:
                pickle.dump(_record(sequence, person, world, f"{SUBJECT}_{name}"), stream, protocol=4)
    return notes


def _record(sequence: Sequence, person: int, world: WorldPeople, name: str) -> dict[str, Any]:
    camera, people = sequence.camera, sequence.people
    width, height = sequence.size
    valid = people["valid"][person]
    points = people["joints_image"][person]
    return {
        "gender": "male",
        "name": name,
        "emdb1": True,
        "emdb2": True,
        "n_frames": len(sequence),
        "good_frames_mask": valid,
        "camera": {
            "intrinsics": camera["K"][0],
            "extrinsics": cameras_in(Y_UP_FROM_Z_UP, camera),
            "width": width,
            "height": height,
        },
        "smpl": _smpl(people, person, world),
        "smplx": _smplx(people, person, world),
        "kp2d": np.concatenate([points[:, :22], points[:, SMPL_HANDS]], axis=1),
        "bboxes": {"bboxes": people["bbox_xyxy"][person], "invalid_idxs": np.flatnonzero(~valid)},
        "body_model": str(people["body_model"]),
        "body_model_sha256": str(people["body_model_sha256"]),
    }


def _smpl(people: dict[str, NDArray[Any]], person: int, world: WorldPeople) -> dict[str, NDArray[Any]]:
    body = people["body_pose"][person].reshape(len(world.transl[person]), -1)
    pelvis = world.transl[person] + rest_pelvis(people)[person]
    return {
        "poses_root": world.global_orient[person],
        "poses_body": np.pad(body, ((0, 0), (0, 6))),
        "trans": pelvis - SMPL_REST_PELVIS,
        "betas": np.zeros(10),
    }


def _smplx(people: dict[str, NDArray[Any]], person: int, world: WorldPeople) -> dict[str, NDArray[Any]]:
    shared = (
        "betas", "expression", "body_pose", "left_hand_pose", "right_hand_pose",
        "jaw_pose", "leye_pose", "reye_pose",
    )  # fmt: skip
    return {
        **{name: people[name][person] for name in shared},
        "global_orient": world.global_orient[person],
        "transl": world.transl[person],
    }
