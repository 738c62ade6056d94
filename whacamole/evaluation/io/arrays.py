"""Taking arrays out of files, with errors that name the file, the key and the remedy."""

import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from whacamole.errors import EvaluationError
from whacamole.evaluation.core.alignment import FloatArray
from whacamole.evaluation.records import IntArray

MAX_FRAMES = 1_000_000
"""Of a video: nine hours at 30 frames a second; a larger number is a damaged one."""


def read_npz(path: Path) -> dict[str, Any]:
    """All arrays of an ``.npz``, nothing unpickled.

    Raises:
        EvaluationError: the file is missing, damaged or holds Python objects.
    """
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as archive:
            if not hasattr(archive, "files"):
                raise EvaluationError(f"{path}: one array, not an .npz archive; save it with numpy.savez")
            return {key: archive[key] for key in archive.files}
    except FileNotFoundError:
        raise EvaluationError(f"{path}: not there") from None
    except (OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile, zlib.error) as error:
        what = (
            "holds Python objects"
            if "pickle" in str(error).lower() and zipfile.is_zipfile(path)
            else "damaged"
        )
        raise EvaluationError(f"{path}: {what}, so not read; write it again with numpy.savez") from error


def take(
    values: Mapping[Any, Any], key: str, path: Path, *shapes: tuple[int | None, ...], default: Any = None
) -> FloatArray:
    """The floats under ``key``, in one of the shapes (``None`` for any length).

    Raises:
        EvaluationError: absent without a default, not numbers, or of another shape.
    """
    if key not in values:
        if default is None:
            raise EvaluationError(f"{path}: no key {key!r}, only {', '.join(sorted(map(str, values)))[:200]}")
        return np.asarray(default, dtype=np.float64)
    try:
        array = np.asarray(values[key], dtype=np.float64)
    except (TypeError, ValueError):
        raise EvaluationError(f"{path}: {key!r} holds no numbers") from None
    for shape in shapes:
        if array.ndim == len(shape) and all(w in (None, n) for w, n in zip(shape, array.shape, strict=True)):
            return array
    if shapes:
        wanted = " or ".join("×".join("any" if w is None else str(w) for w in shape) for shape in shapes)
        raise EvaluationError(
            f"{path}: {key!r} is {'×'.join(map(str, array.shape)) or 'one value'}, expected {wanted}"
        )
    return array


def whole_numbers(
    values: Mapping[Any, Any], key: str, path: Path, *shapes: tuple[int | None, ...], default: Any = None
) -> IntArray:
    """:func:`take` of whole numbers.

    Raises:
        EvaluationError: also where a value is none.
    """
    given = take(values, key, path, *shapes, default=default)
    if not (np.abs(given) < 2.0**53).all() or (given != np.round(given)).any():
        raise EvaluationError(f"{path}: {key!r} holds values that are no whole numbers")
    return given.astype(np.intp)


def text(values: Mapping[str, Any], key: str, default: str = "") -> str:
    """A string stored as a 0-d array."""
    return str(values[key]) if key in values else default


def axis_angles(pose: FloatArray) -> FloatArray:
    """(…, 3 n) flat axis-angles as (…, n, 3)."""
    return pose.reshape(*pose.shape[:-1], -1, 3)


def from_matrices(rotations: FloatArray) -> FloatArray:
    """Axis-angles (…, 3) of rotation matrices (…, 3, 3), which need only be rotations to float precision.

    Rows that are not finite give NaN, which the scores count and leave out.
    """
    flat = rotations.reshape(-1, 3, 3)
    finite = np.isfinite(flat).all(axis=(1, 2)) & (np.abs(np.linalg.det(np.nan_to_num(flat))) > 1e-6)
    result = np.full((len(flat), 3), np.nan)
    if finite.any():
        result[finite] = Rotation.from_matrix(flat[finite]).as_rotvec()
    return result.reshape(*rotations.shape[:-2], 3)


def poses(rotations: FloatArray, centres: FloatArray) -> FloatArray:
    """Camera to world (T, 4, 4) of its rotations (T, 3, 3) and centres (T, 3)."""
    T_world_camera = np.tile(np.eye(4), (len(rotations), 1, 1))
    T_world_camera[:, :3, :3], T_world_camera[:, :3, 3] = rotations, centres
    return T_world_camera


def intrinsics(focal: FloatArray, centre: FloatArray, frames: int) -> FloatArray:
    """K (T, 3, 3) of one focal length and principal point [px]."""
    K = np.tile(np.eye(3), (frames, 1, 1))
    K[:, 0, 0] = K[:, 1, 1] = float(np.ravel(focal)[0])
    K[:, :2, 2] = np.ravel(centre)[:2]
    return K


def frame_numbers(values: Mapping[Any, Any], key: str, path: Path, count: int | None = None) -> IntArray:
    """Frames (F,) of a track, counted from 0: not negative, each once, below ``count``.

    Raises:
        EvaluationError: anything else.
    """
    given = whole_numbers(values, key, path, (None,))
    most = MAX_FRAMES if count is None else count
    if len(given) and not (given.min() >= 0 and given.max() < most and len(np.unique(given)) == len(given)):
        raise EvaluationError(f"{path}: {key!r} is not of different frames from 0 to {most - 1}")
    return given


def spread_rows(values: FloatArray, rows: IntArray, frames: int) -> FloatArray:
    """``values`` (F, …) at ``rows`` (F,) of (frames, …), NaN elsewhere."""
    result = np.full((frames, *values.shape[1:]), np.nan)
    result[rows] = values
    return result
