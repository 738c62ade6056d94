"""Bundle adjustment: all cameras and all points, by Levenberg-Marquardt on the Schur complement of the
cameras."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve
from scipy.spatial.transform import Rotation

from whacamole.baseline.rigid import FloatArray

_NOISE = 0.6  # px, of a tracked corner
_ROBUST = 3.0  # standard deviations at which a residual counts a quarter


@dataclass(frozen=True, eq=False)
class Bundle:
    """Cameras and points.

    Attributes:
        R, t: world to camera, (C, 3, 3) and (C, 3).
        points: (M, 3).
    """

    R: FloatArray
    t: FloatArray
    points: FloatArray


@dataclass(frozen=True, eq=False)
class Sightings:
    """Which camera saw which point where.

    Attributes:
        camera, point: (S,) numbers.
        pixels: (S, 2).
        K: (C, 3, 3).
    """

    camera: NDArray[np.intp]
    point: NDArray[np.intp]
    pixels: FloatArray
    K: FloatArray


def adjust(bundle: Bundle, seen: Sightings, rounds: int = 12) -> Bundle:
    """The bundle that explains the sightings best; camera 0 stays, and the scale hardly moves."""
    damping, best = 1e-3, _cost(bundle, seen)
    for _ in range(rounds):
        step = _step(bundle, seen, damping)
        cost = _cost(step, seen)
        if cost < best:
            done = best - cost < 1e-4 * best
            bundle, best, damping = step, cost, damping * 0.2
            if done:
                break
        else:
            damping *= 10.0
    return bundle


def reprojection(bundle: Bundle, seen: Sightings) -> tuple[FloatArray, FloatArray]:
    """Errors (S, 2) [px] and depths (S,) of all sightings."""
    local = _local(bundle, seen)
    depth = local[:, 2]
    safe = np.where(np.abs(depth) < 1e-6, 1e-6, depth)
    K = seen.K[seen.camera]
    projected = local[:, :2] / safe[:, None] * K[:, [0, 1], [0, 1]] + K[:, :2, 2]
    return projected - seen.pixels, depth


def _local(bundle: Bundle, seen: Sightings) -> FloatArray:
    turned = np.einsum("sij,sj->si", bundle.R[seen.camera], bundle.points[seen.point])
    local: FloatArray = turned + bundle.t[seen.camera]
    return local


def _cost(bundle: Bundle, seen: Sightings) -> float:
    error, depth = reprojection(bundle, seen)
    square = (error**2).sum(axis=1) / _NOISE**2
    behind = np.where(depth > 0.0, square, np.inf)
    robust = _ROBUST**2 * (1.0 - 1.0 / (1.0 + behind / _ROBUST**2))
    return float(robust.sum())


def _step(bundle: Bundle, seen: Sightings, damping: float) -> Bundle:
    C, M = len(bundle.R), len(bundle.points)
    A, B, error = _jacobians(bundle, seen)
    trust = 1.0 / (1.0 + (error**2).sum(axis=1) / _ROBUST**2) ** 2
    WA, WB = trust[:, None, None] * A, trust[:, None, None] * B
    cameras = _summed(np.swapaxes(A, -1, -2) @ WA, seen.camera, C)
    points = _summed(np.swapaxes(B, -1, -2) @ WB, seen.point, M)
    g_cameras = _summed(np.einsum("sij,si->sj", WA, error), seen.camera, C)
    g_points = _summed(np.einsum("sij,si->sj", WB, error), seen.point, M)
    for blocks in (cameras, points):
        diagonal = np.einsum("nii->ni", blocks)
        diagonal += damping * diagonal + 1e-9
    coupling = np.zeros((C, M, 6, 3))
    np.add.at(coupling, (seen.camera, seen.point), np.swapaxes(A, -1, -2) @ WB)
    inverse = np.linalg.inv(points)
    E = coupling.transpose(0, 2, 1, 3).reshape(6 * C, 3 * M)
    EP = np.einsum("cmij,mjk->cmik", coupling, inverse).transpose(0, 2, 1, 3).reshape(6 * C, 3 * M)
    schur = -EP @ E.T
    for camera in range(C):
        part = slice(6 * camera, 6 * camera + 6)
        schur[part, part] += cameras[camera]
    right = g_cameras.ravel() - EP @ g_points.ravel()
    free = slice(6, None)  # camera 0 holds the world
    move = np.zeros(6 * C)
    move[free] = -cho_solve(cho_factor(schur[free, free]), right[free])
    shift = -np.einsum("mij,mj->mi", inverse, g_points + (E.T @ move).reshape(M, 3))
    turn = Rotation.from_rotvec(move.reshape(C, 6)[:, :3]).as_matrix()
    return Bundle(turn @ bundle.R, bundle.t + move.reshape(C, 6)[:, 3:], bundle.points + shift)


def _jacobians(bundle: Bundle, seen: Sightings) -> tuple[FloatArray, FloatArray, FloatArray]:
    """By the camera (S, 2, 6): its turn, its place; by the point (S, 2, 3); errors (S, 2); in deviations."""
    local = _local(bundle, seen)
    error, _ = reprojection(bundle, seen)
    turned = local - bundle.t[seen.camera]
    depth = np.maximum(local[:, 2], 1e-6)
    focal = seen.K[seen.camera][:, [0, 1], [0, 1]] / _NOISE
    projection = np.zeros((len(local), 2, 3))
    projection[:, [0, 1], [0, 1]] = focal / depth[:, None]
    projection[:, :, 2] = -focal * local[:, :2] / depth[:, None] ** 2
    # A small turn ω of the camera moves the turned point p by ω × p = −[p]× ω.
    cross = np.zeros((len(local), 3, 3))
    cross[:, [1, 2, 0], [2, 0, 1]] = turned
    cross[:, [2, 0, 1], [1, 2, 0]] = -turned
    A = np.concatenate([projection @ cross, projection], axis=-1)
    return A, projection @ bundle.R[seen.camera], error / _NOISE


def _summed(values: FloatArray, index: NDArray[np.intp], count: int) -> FloatArray:
    total = np.zeros((count, *values.shape[1:]))
    np.add.at(total, index, values)
    return total
