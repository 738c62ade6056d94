"""SLAHMR: the newest ``*_world_results.npz`` of a phase and ``track_info.json``."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from whacamole.errors import EvaluationError
from whacamole.evaluation.core.alignment import FloatArray
from whacamole.evaluation.io.arrays import axis_angles, poses, read_npz, take
from whacamole.evaluation.records import BoolArray, CameraTrack, PersonTrack, Placement, Recording

_PHASES = ("motion_chunks", "smooth_fit", "root_fit")


def read_slahmr(folder: Path, sequence_id: str, fps: float) -> Recording:
    """Read a result folder: SMPL-H, neutral, in the world, and world-to-camera ``cam_R``, ``cam_t``.

    The last phase that has results counts; of its files the one of the last iteration. ``track_info.json``
    says on which frames a track was seen, and which frames of the video the run covers.

    Raises:
        EvaluationError: a file is missing or cannot be used; one line.
    """
    path = _newest(folder)
    values = read_npz(path)
    B, T = take(values, "trans", path, (None, None, 3)).shape[:2]
    start, seen, ids = _tracks(folder / "track_info.json", B, T)
    R = take(values, "cam_R", path, (B, T, 3, 3), (T, 3, 3)).reshape(-1, T, 3, 3)[0]
    t = take(values, "cam_t", path, (B, T, 3), (T, 3)).reshape(-1, T, 3)[0]
    turned = np.swapaxes(R, -1, -2)
    people = tuple(_person(values, path, b, (B, T), seen[b], ids[b]) for b in range(B))
    camera = CameraTrack(poses(turned, -np.einsum("tij,tj->ti", turned, t)), np.ones(T, dtype=bool))
    return Recording(
        id=sequence_id,
        frame_index=start + np.arange(T),
        fps=fps,
        people=people,
        camera=camera,
        method="SLAHMR",
        by_position=True,
    )


def _newest(folder: Path) -> Path:
    for phase in (*_PHASES, "."):
        files = sorted((folder / phase).glob("*_world_results.npz"), key=lambda p: p.stem.split("_")[-3:-2])
        if files:
            return files[-1]
    raise EvaluationError(
        f"{folder}: no *_world_results.npz; give the folder that SLAHMR wrote for this sequence"
    )


def _person(
    values: dict[str, Any], path: Path, b: int, shape: tuple[int, int], seen: BoolArray, track_id: int
) -> PersonTrack:
    B, T = shape
    arrays: dict[str, FloatArray] = {
        key: take(values, key, path, (B, T, size))[b]
        for key, size in {"trans": 3, "root_orient": 3, "pose_body": 63}.items()
    }
    return PersonTrack(
        track_id=track_id,
        kind="smplh",
        betas=take(values, "betas", path, (B, None))[b],
        body_pose=axis_angles(arrays["pose_body"]),
        valid=seen,
        world=Placement(arrays["root_orient"], arrays["trans"]),
    )


def _tracks(path: Path, B: int, T: int) -> tuple[int, list[BoolArray], list[int]]:
    """First frame, and for every track where it was seen and its id; without the file all are seen."""
    if not path.exists():
        return 0, [np.ones(T, dtype=bool)] * B, list(range(B))
    try:
        info = json.loads(path.read_text(encoding="utf-8"))
        first = int(info["meta"]["data_interval"][0])
        tracks = sorted(info["tracks"].items(), key=lambda item: item[1]["index"])
        masks = [np.asarray(track["vis_mask"], dtype=bool) for _, track in tracks]
        ids = [int(key) for key, _ in tracks]
    except (OSError, ValueError, KeyError, TypeError, IndexError) as error:
        raise EvaluationError(f"{path}: not SLAHMR's track list ({error}); write it again") from error
    kept = [(mask, key) for mask, key in zip(masks, ids, strict=True) if mask.any()]
    if len(kept) != B:
        raise EvaluationError(f"{path}: {len(kept)} visible tracks but {B} in the results")
    every = np.any([mask for mask, _ in kept], axis=0)
    span = slice(int(every.argmax()), len(every) - int(every[::-1].argmax()))
    cut = [mask[span] for mask, _ in kept]
    if len(cut[0]) != T:
        raise EvaluationError(f"{path}: tracks span {len(cut[0])} frames but the results have {T}")
    return first + span.start, cut, [key for _, key in kept]
