"""One ground-truth movement and, for each format, a writer of files of its schema.

The truth is a function of time, so each format gets exact samples at its own rate; it lives in the project's
world (metres, z up). A writer turns it into the format's axes, names, units and order.
"""

import pickle
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

SECONDS = 1.5
Array = NDArray[np.float64]

# Rest pelvis of the mean bodies, and the turn from the project's z-up world into each file's axes.
REST_PELVIS = {
    "smpl": (-0.0018, -0.2233, 0.0282),
    "smplh": (-0.0018, -0.2233, 0.0282),
    "smplx": (0.0031, -0.3514, 0.0120),
}
FROM_Z_UP = {
    "+z": Rotation.identity(),
    "+y": Rotation.from_euler("x", -90, degrees=True),
    "-y": Rotation.from_euler("x", 90, degrees=True),
}


@dataclass(frozen=True)
class Truth:
    """Samples of the movement, T frames: all 55 joints of SMPL-X, the pelvis in the world, the face."""

    pose: Array
    pelvis: Array
    expression: Array

    def in_axes(self, up: str) -> "Truth":
        """The same movement in a world whose ``up`` axis was z."""
        turn = FROM_Z_UP[up]
        pose = self.pose.copy()
        pose[:, 0] = (turn * Rotation.from_rotvec(pose[:, 0])).as_rotvec()
        return Truth(pose, turn.apply(self.pelvis), self.expression)


def truth_at(rate: float, person: int = 0) -> Truth:
    """Someone who stands, waves, looks about, speaks and moves the fingers; person 1 does so on a step."""
    t = np.arange(int(SECONDS * rate) + 1) / rate
    phase = np.linspace(0.0, 2.0, 55)[:, None] + np.array([0.0, 1.0, 2.0]) + person
    pose = 0.3 * np.sin(2.0 * t[:, None, None] + phase)
    pose[:, [1, 2, 4, 5, 7, 8, 10, 11]] = 0.0
    pose[:, 0] = (
        Rotation.from_euler("z", 40.0 + 180.0 * person, degrees=True)
        * Rotation.from_euler("x", 90, degrees=True)
    ).as_rotvec()
    pelvis = np.stack([0.1 + 0.8 * person + 0.0 * t, -0.2 + 0.0 * t, 0.97 + 0.2 * person + 0.0 * t], axis=1)
    expression = np.sin(t[:, None] + np.arange(50))
    return Truth(pose, pelvis, expression)


def rest(model: str) -> Array:
    """Rest pelvis of ``model``."""
    return np.array(REST_PELVIS[model])


def _fingers_last(pose: Array) -> Array:
    return np.concatenate([pose[:, :22], pose[:, 25:]], axis=1)


def write_amass_smplh(folder: Path, **extra: object) -> Path:
    """120.00004577 fps, gender as bytes, as in the wild."""
    truth = truth_at(120.0)
    values = {
        "poses": _fingers_last(truth.pose).reshape(-1, 156),
        "trans": truth.pelvis - rest("smplh"),
        "betas": np.linspace(-1, 1, 16),
        "dmpls": np.zeros((len(truth.pelvis), 8)),
        "gender": np.array(b"female"),
        "mocap_framerate": np.array(120.00004577),
    }
    np.savez(folder / "clip_poses.npz", **(values | extra))
    return folder / "clip_poses.npz"


def write_amass_smplx(folder: Path) -> Path:
    """The other spelling of the frame rate; the pose also in parts."""
    truth = truth_at(60.0)
    T = len(truth.pelvis)
    np.savez_compressed(
        folder / "clip_stageii.npz",
        gender=np.array("male"), surface_model_type=np.array("smplx"), mocap_frame_rate=np.array(60.0),
        mocap_time_length=np.array(T / 60.0), trans=truth.pelvis - rest("smplx"),
        poses=truth.pose.reshape(T, 165),
        betas=np.linspace(-1, 1, 16), num_betas=np.array(16), root_orient=truth.pose[:, 0],
        pose_body=truth.pose[:, 1:22].reshape(T, 63), pose_jaw=truth.pose[:, 22],
        pose_eye=truth.pose[:, 23:25].reshape(T, 6), pose_hand=truth.pose[:, 25:].reshape(T, 90),
    )  # fmt: skip
    return folder / "clip_stageii.npz"


def write_dd100(folder: Path, grouped: bool = False) -> Path:
    """A pair of pickled dictionaries, y down."""
    for person in range(2):
        truth = truth_at(30.0, person).in_axes("-y")
        T = len(truth.pelvis)
        values = {
            "poses": truth.pose if grouped else truth.pose.reshape(T, 165),
            "transl": truth.pelvis - rest("smplx"),
            "betas": np.tile(np.linspace(-1, 1, 10), (T, 1)),
            "global_orient": truth.pose[:, 0],
            "meta": {"gender": "female"},
        }
        np.save(folder / f"Duet_01_02_{person:02d}.npy", np.array(values, dtype=object), allow_pickle=True)
    return folder / "Duet_01_02_00.npy"


def write_bedlam(folder: Path) -> Path:
    """AMASS' names, y up, single precision, the rate a whole number."""
    truth = truth_at(30.0).in_axes("+y")
    T = len(truth.pelvis)
    np.savez(
        folder / "motion.npz",
        motion_info=np.zeros(6), betas=np.linspace(-1, 1, 11, dtype=np.float32),
        poses=truth.pose.reshape(T, 165), global_ori=truth.pose[:, 0], trans=truth.pelvis - rest("smplx"),
        mocap_frame_rate=np.array(30), gender=np.array("male"),
    )  # fmt: skip
    return folder / "motion.npz"


def write_inter_x(folder: Path) -> Path:
    """A folder a scene, a file a person, parts of the body, 120 fps, y up."""
    scene = folder / "G001T000A000R000"
    scene.mkdir()
    for person in range(2):
        truth = truth_at(120.0, person).in_axes("+y")
        np.savez(
            scene / f"P{person + 1}.npz",
            pose_body=truth.pose[:, 1:22], pose_lhand=truth.pose[:, 25:40], pose_rhand=truth.pose[:, 40:55],
            root_orient=truth.pose[:, 0], trans=truth.pelvis - rest("smplx"), betas=np.zeros((1, 10)),
            gender=np.array("female"),
        )  # fmt: skip
    return scene / "P1.npz"


def write_inter_human(folder: Path) -> Path:
    """Both people in one pickle, SMPL-H without fingers, z up."""
    people: dict[str, object] = {}
    for person in range(2):
        truth = truth_at(30.0, person)
        people[f"person{person + 1}"] = {
            "trans": truth.pelvis - rest("smplh"),
            "root_orient": truth.pose[:, 0],
            "pose_body": truth.pose[:, 1:22].reshape(-1, 63),
            "betas": np.zeros(10),
            "gender": "male",
        }
    path = folder / "1234.pkl"
    path.write_bytes(pickle.dumps(people))
    return path


def write_motion_x(folder: Path) -> Path:
    """One array of 322 columns, the jaw after the fingers, y up."""
    truth = truth_at(30.0).in_axes("+y")
    T = len(truth.pelvis)
    columns = [
        truth.pose[:, :22].reshape(T, 66), truth.pose[:, 25:].reshape(T, 90), truth.pose[:, 22],
        truth.expression, np.zeros((T, 100)), truth.pelvis - rest("smplx"), np.zeros((T, 10)),
    ]  # fmt: skip
    np.save(folder / "Walk_clip1.npy", np.concatenate(columns, axis=1))
    return folder / "Walk_clip1.npy"


def write_aist(folder: Path) -> Path:
    """SMPL, scaled, y up, 60 fps."""
    truth = truth_at(60.0).in_axes("+y")
    T = len(truth.pelvis)
    pose = np.concatenate([truth.pose[:, :22], np.zeros((T, 2, 3))], axis=1)
    path = folder / "gBR_sBM_cAll_d04_mBR0_ch01.pkl"
    values = {
        "smpl_poses": pose.reshape(T, 72),
        "smpl_scaling": np.array([93.7]),
        "smpl_trans": (truth.pelvis - rest("smpl")) * 93.7,
    }
    path.write_bytes(pickle.dumps(values))
    return path


WRITERS: dict[str, Callable[[Path], Path]] = {
    "amass-smplh": write_amass_smplh,
    "amass-smplx": write_amass_smplx,
    "dd100": write_dd100,
    "bedlam": write_bedlam,
    "inter-x": write_inter_x,
    "interhuman": write_inter_human,
    "motion-x": write_motion_x,
    "aist++": write_aist,
}


@pytest.fixture(params=sorted(WRITERS))
def schema(request: pytest.FixtureRequest) -> str:
    """The name of each format in turn."""
    return str(request.param)


@pytest.fixture
def write_schema(tmp_path: Path) -> Callable[..., Path]:
    """Write the truth as a file of the named format; gives its path (of a pair, the first file's)."""

    def write(name: str, **options: object) -> Path:
        return WRITERS[name](tmp_path, **options)

    return write


@pytest.fixture
def truth() -> Callable[..., Truth]:
    """The truth sampled at a rate."""
    return truth_at
