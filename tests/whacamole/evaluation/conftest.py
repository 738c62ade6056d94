"""Datasets and predictions by the contract (docs/format.md), made of NumPy and the embedded body alone."""

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from whacamole.body import BodyModel, BodyParams

Arrays = dict[str, Any]


@dataclass(frozen=True)
class Scene:
    """The arrays of one sequence: ``camera.npz``, ``people.npz``, ``contact.npz`` and ``shot.json``."""

    id: str
    camera: Arrays
    people: Arrays
    contact: Arrays
    shot: Arrays


def smooth_walk(rng: np.random.Generator, frames: int, scale: float, size: int) -> np.ndarray:
    """A smooth random curve (frames, size): a few random cosines."""
    time = np.linspace(0.0, 1.0, frames)[:, None]
    waves = [
        rng.normal(size=size) * np.cos(2 * np.pi * (k * time + rng.uniform(size=size))) / k for k in (1, 2, 3)
    ]
    return scale * np.sum(waves, axis=0)


def make_camera(rng: np.random.Generator, frames: int, *, static: bool = False) -> Arrays:
    """A camera some 5 m away that looks at the origin at hip height and moves by about a metre."""
    eye = np.array([5.0, 0.0, 1.5]) + (0.0 if static else 1.0) * smooth_walk(rng, frames, 0.7, 3)
    forward = np.array([0.0, 0.0, 1.0]) - eye
    forward /= np.linalg.norm(forward, axis=1, keepdims=True)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    T_world_camera = np.tile(np.eye(4), (frames, 1, 1))
    T_world_camera[:, :3, :3] = np.stack([right, np.cross(forward, right), forward], axis=-1)
    T_world_camera[:, :3, 3] = eye
    K = np.tile([[500.0, 0.0, 320.0], [0.0, 500.0, 180.0], [0.0, 0.0, 1.0]], (frames, 1, 1))
    return {
        "K": K,
        "T_world_camera": T_world_camera,
        "T_camera_world": np.linalg.inv(T_world_camera),
        "fps": np.array(30.0),
        "width": np.array(640),
        "height": np.array(360),
        "frame_index": np.arange(frames),
    }


def make_person(
    rng: np.random.Generator, frames: int, place: np.ndarray, *, still: bool = False
) -> BodyParams:
    """A person who stands upright near ``place`` [m] and moves."""
    moving = 0.0 if still else 1.0
    pose = BodyParams.zeros(frames, rng.normal(size=10))
    upright = Rotation.from_euler("x", 90, degrees=True)
    turn = Rotation.from_rotvec(smooth_walk(rng, frames, moving, 1) * [0.0, 0.0, 1.0])
    return BodyParams(
        betas=pose.betas,
        expression=smooth_walk(rng, frames, 0.5, 10),
        global_orient=(turn * upright).as_rotvec(),
        transl=place + moving * smooth_walk(rng, frames, 0.5, 3) * [1, 1, 0.1] + [0, 0, 0.95],
        body_pose=moving * smooth_walk(rng, frames, 0.2, 63).reshape(frames, 21, 3),
        left_hand_pose=smooth_walk(rng, frames, 0.1, 45).reshape(frames, 15, 3),
        right_hand_pose=smooth_walk(rng, frames, 0.1, 45).reshape(frames, 15, 3),
        jaw_pose=pose.jaw_pose,
        leye_pose=pose.leye_pose,
        reye_pose=pose.reye_pose,
    )


def make_scene(
    sequence_id: str,
    *,
    frames: int = 60,
    people: int = 2,
    seed: int = 0,
    static_camera: bool = False,
    still_people: bool = False,
    shots: Sequence[str] = ("arc", "tracking"),
) -> Scene:
    """One sequence with exact labels: people in a row, seen by one camera."""
    rng = np.random.default_rng(seed)
    model = BodyModel.embedded()
    camera = make_camera(rng, frames, static=static_camera)
    bodies = [
        make_person(rng, frames, np.array([0.0, 1.2 * (i - (people - 1) / 2), 0.0]), still=still_people)
        for i in range(people)
    ]
    seen = [body.transformed(camera["T_camera_world"], model.rest_joints(body.betas)[0]) for body in bodies]
    arrays: Arrays = {
        "track_id": np.arange(1, people + 1),
        "motion_id": np.array([f"made/{sequence_id}"] * people),
        "gender": np.array(["neutral"] * people),
        "body_model": np.array(model.name),
        "body_model_sha256": np.array(model.sha256),
    }
    for name in BodyParams.zeros(1).to_arrays():
        key = name.removesuffix("_world")
        if key != name:
            arrays[f"{key}_camera"] = np.stack([getattr(body, key) for body in seen])
        arrays[name] = np.stack([getattr(body, key) for body in bodies])
    joints = np.stack([model.pose_joints(body) for body in bodies])
    arrays |= {
        "joints_world": joints,
        "joints_camera": np.stack([model.pose_joints(body) for body in seen]),
        "visible_fraction": np.clip(0.7 + smooth_walk(rng, frames, 0.3, people).T, 0.0, 1.0),
        "valid": np.ones((people, frames), dtype=bool),
    }
    contact = {
        "part_names": np.array(["left_foot", "right_foot"]),
        "ground_contact": joints[:, :, [10, 11], 2] < 0.07,
    }
    edges = np.linspace(0, frames - 1, len(shots) + 1).round().astype(int)
    shot = {
        "shots": [
            {"kind": kind, "start": int(a), "end": int(b)}
            for kind, a, b in zip(shots, edges[:-1], edges[1:], strict=True)
        ]
    }
    return Scene(sequence_id, camera, arrays, contact, shot)


def write_dataset(root: Path, scenes: Sequence[Scene], split: str = "test") -> Path:
    """Write scenes as a dataset folder with one split."""
    for scene in scenes:
        folder = root / "sequences" / scene.id
        folder.mkdir(parents=True)
        np.savez(folder / "camera.npz", **scene.camera)
        np.savez(folder / "people.npz", **scene.people)
        np.savez(folder / "contact.npz", **scene.contact)
        (folder / "shot.json").write_text(json.dumps(scene.shot), encoding="utf-8")
    (root / "splits").mkdir(exist_ok=True)
    (root / "splits" / f"{split}.txt").write_text("".join(f"{s.id}\n" for s in scenes), encoding="utf-8")
    return root


_COPIED = (
    "track_id", "betas", "expression", "global_orient_world", "transl_world", "global_orient_camera",
    "transl_camera", "body_pose", "left_hand_pose", "right_hand_pose", "jaw_pose", "leye_pose", "reye_pose",
    "valid", "body_model", "body_model_sha256",
)  # fmt: skip


def make_prediction(scene: Scene, *, noise: float = 0.0, seed: int = 0, scale: float = 1.0) -> Arrays:
    """The truth as a prediction in the native form, with noise on pose [rad] and translation [m].

    ``scale`` multiplies where people and camera are in the world, as a wrong metric scale does.
    """
    rng = np.random.default_rng(seed)
    arrays: Arrays = {key: np.array(scene.people[key]) for key in _COPIED}
    arrays |= {key: np.array(scene.camera[key]) for key in ("frame_index", "T_world_camera", "K")}
    for key in ("body_pose", "transl_world", "transl_camera", "global_orient_world"):
        arrays[key] = arrays[key] + noise * rng.normal(size=arrays[key].shape)
    arrays["T_world_camera"][:, :3, 3] += noise * rng.normal(size=(len(arrays["K"]), 3))
    arrays["T_world_camera"][:, :3, 3] *= scale
    pelvis = BodyModel.embedded().rest_joints(arrays["betas"])[:, None, 0]
    arrays["transl_world"] = scale * (arrays["transl_world"] + pelvis) - pelvis
    arrays["method"], arrays["ground_truth_used"] = np.array("noisy truth"), np.array("boxes")
    arrays["scale"] = np.array(1.0)
    return arrays


def write_predictions(root: Path, predictions: dict[str, Arrays]) -> Path:
    """Write native predictions, one file a sequence."""
    root.mkdir(parents=True, exist_ok=True)
    for sequence_id, arrays in predictions.items():
        np.savez(root / f"{sequence_id}.npz", **arrays)
    return root


@pytest.fixture(scope="session")
def scenes() -> list[Scene]:
    """Three short sequences of two people."""
    return [make_scene(f"made-{seed}", frames=40 + 10 * seed, seed=seed) for seed in range(3)]


@pytest.fixture(scope="session")
def dataset(scenes: list[Scene], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The scenes as a dataset."""
    return write_dataset(tmp_path_factory.mktemp("data") / "dataset", scenes)


@pytest.fixture(scope="session")
def make() -> dict[str, Callable[..., Any]]:
    """The makers of this file, for tests that need other scenes."""
    return {
        "scene": make_scene,
        "dataset": write_dataset,
        "prediction": make_prediction,
        "predictions": write_predictions,
        "smpl": make_smpl,
    }


def make_smpl(seed: int, joints: int = 24, vertices: int = 200) -> Arrays:
    """A model in the schema of SMPL (24 joints) or SMPL-H (52) on some of the embedded body's vertices."""
    rng = np.random.default_rng(seed)
    body = BodyModel.embedded()
    kept = np.linspace(0, body.num_vertices - 1, vertices).astype(int)
    template = body.v_template[kept].astype(np.float64) * rng.uniform(0.95, 1.05)
    rest = body.rest_joints(np.zeros(10))
    hands = {24: [[28], [43]], 52: [[j] for j in range(25, 55)]}[joints]
    places = np.concatenate([rest[:22], *(rest[h] for h in hands)])
    regressor = np.zeros((joints, vertices))
    for row, place in enumerate(places):
        nearest = np.argsort(np.linalg.norm(template - place, axis=1))[:5]
        regressor[row, nearest] = 0.2
    weights = np.zeros((vertices, joints))
    weights[:, :22] = body.weights[kept, :22]
    weights[:, 15] += body.weights[kept, 22:25].sum(axis=1)
    if joints == 24:
        weights[:, 22] = body.weights[kept, 25:40].sum(axis=1)
        weights[:, 23] = body.weights[kept, 40:].sum(axis=1)
    else:
        weights[:, 22:] = body.weights[kept, 25:]
    parents = [2**32 - 1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19]
    if joints == 24:
        parents += [20, 21]
    else:
        parents += [20 if i % 3 == 0 else 21 + i for i in range(15)]
        parents += [21 if i % 3 == 0 else 36 + i for i in range(15)]
    return {
        "v_template": template,
        "shapedirs": body.arrays.shapedirs[kept].astype(np.float64),
        "posedirs": 1e-3 * rng.normal(size=(vertices, 3, 9 * (joints - 1))),
        "J_regressor": regressor,
        "weights": weights,
        "kintree_table": np.array([parents, range(joints)]),
        "f": np.zeros((1, 3), dtype=np.uint32),
    }


SMPLX_VERTICES = 400


def make_smplx(seed: int) -> Arrays:
    """A model in the SMPL-X schema on some of the embedded body's vertices, small so that it is quick."""
    rng = np.random.default_rng(seed)
    body = BodyModel.embedded()
    kept = np.linspace(0, body.num_vertices - 1, SMPLX_VERTICES).astype(int)
    regressor = np.zeros((55, SMPLX_VERTICES))
    for row, place in enumerate(body.rest_joints(np.zeros(10))):
        regressor[row, np.argsort(np.linalg.norm(body.v_template[kept] - place, axis=1))[:5]] = 0.2
    parents = np.array([2**32 - 1, *body.parents[1:]])
    return {
        "v_template": body.v_template[kept],
        "f": np.zeros((1, 3), dtype=np.uint32),
        "shapedirs": np.concatenate([body.arrays.shapedirs, body.arrays.expression_dirs], axis=2)[kept],
        "posedirs": 1e-3 * rng.normal(size=(SMPLX_VERTICES, 3, 486)),
        "J_regressor": regressor,
        "weights": body.weights[kept],
        "kintree_table": np.stack([parents, np.arange(55)]),
        "hands_componentsl": rng.normal(size=(45, 45)),
        "hands_componentsr": rng.normal(size=(45, 45)),
        "hands_meanl": 0.1 * rng.normal(size=45),
        "hands_meanr": 0.1 * rng.normal(size=45),
    }


@pytest.fixture(scope="session")
def models(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of body model files: made-up SMPL, SMPL-H and SMPL-X."""
    folder = tmp_path_factory.mktemp("models")
    for gender, seed in {"NEUTRAL": 0, "MALE": 1, "FEMALE": 2}.items():
        np.savez(folder / f"SMPL_{gender}.npz", **make_smpl(seed))
    np.savez(folder / "SMPLH_NEUTRAL.npz", **make_smpl(3, joints=52))
    for gender, seed in {"NEUTRAL": 4, "MALE": 5}.items():
        np.savez(folder / f"SMPLX_{gender}.npz", **make_smplx(seed))
    return folder
