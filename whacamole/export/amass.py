"""AMASS, SMPL-X edition: the motion of one person in the world (z up), one ``.npz`` each, flat hands zero."""

from pathlib import Path

import numpy as np

from whacamole.dataset.files import write_arrays
from whacamole.export.rows import full_pose, person_name
from whacamole.export.source import Source

__all__ = ["write_amass"]


def write_amass(source: Source, folder: Path) -> list[str]:
    """Write ``<sequence>_<track>_stageii.npz``."""
    for sequence in source:
        people = sequence.people
        poses = full_pose(people, people["global_orient_world"])
        for person in range(len(people["track_id"])):
            pose = poses[person]
            arrays = {
                "gender": people["gender"][person],
                "surface_model_type": "smplx",
                "mocap_frame_rate": float(sequence.camera["fps"]),
                "mocap_time_length": len(pose) / float(sequence.camera["fps"]),
                "num_betas": people["betas"].shape[1],
                "betas": people["betas"][person].astype(np.float64),
                "trans": people["transl_world"][person],
                "poses": pose,
                "root_orient": pose[:, :3],
                "pose_body": pose[:, 3:66],
                "pose_jaw": pose[:, 66:69],
                "pose_eye": pose[:, 69:75],
                "pose_hand": pose[:, 75:],
                "body_model": people["body_model"],
                "body_model_sha256": people["body_model_sha256"],
            }
            write_arrays(folder / f"{person_name(sequence, person)}_stageii.npz", arrays)
    return []
