"""Joint positions as weighted means of surface vertices, for every body shape."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.optimize import nnls

from open_people.base_mesh import BODY_VERTICES, BaseMesh
from open_people.shape_space import Samples, ShapeSpace
from open_people.skeleton import INDEX, JOINTS, PARENTS

DIRECTIONS: Final = 48
NEAREST: Final = 6
"""Candidates: the nearest few vertices in each of many directions round the joint."""

MEAN_SHAPE_WEIGHT: Final = 20.0
"""The mean shape counts as this many samples (its rows are exact for betas 0, where people look first)."""

SMALLEST: Final = 1e-3
"""Lesser weights are dropped."""


def fit_joint_regressor(
    mesh: BaseMesh, weights: sparse.csr_matrix, samples: Samples, space: ShapeSpace
) -> NDArray[np.float64]:
    """Sparse regressor ``(55, V)`` over the model's vertices; rows are non-negative and sum to 1.

    ``weights (N, 55)`` are the skinning weights of the base mesh: a joint is found among vertices that it
    moves.
    """
    keep = mesh.model_vertices
    model_weights = weights[keep].toarray()
    out = np.zeros((len(JOINTS), len(keep)))
    rows = samples.vertices[::3]
    for joint, name in enumerate(JOINTS):
        if name.endswith("eye"):
            group = mesh.vertex_groups["helper-l-eye" if name.startswith("left") else "helper-r-eye"]
            candidates = np.flatnonzero(np.isin(keep, group))
        else:
            candidates = _candidates(space.mean[keep], space.joints_mean[joint], model_weights, joint)
        out[joint, candidates] = _solve(
            rows[:, keep[candidates]],
            samples.joints[::3, joint],
            space.mean[keep[candidates]],
            space.joints_mean[joint],
        )
    return out


def _candidates(
    vertices: NDArray[np.float64], joint_at: NDArray[np.float64], weights: NDArray[np.float64], joint: int
) -> NDArray[np.int64]:
    skin = weights[:BODY_VERTICES]
    if joint == INDEX["pelvis"]:
        moved = (skin[:, joint] > 0.05) | (skin[:, INDEX["spine1"]] > 0.3)
    else:
        moved = skin[:, joint] + skin[:, PARENTS[joint]] > 0.25
    index = np.flatnonzero(moved)
    offset = vertices[index] - joint_at
    distance = np.linalg.norm(offset, axis=1)
    nearest_direction = np.argmax((offset / distance[:, None]) @ _sphere(DIRECTIONS).T, axis=1)
    order = np.argsort(distance, kind="stable")
    chosen = [order[nearest_direction[order] == k][:NEAREST] for k in range(DIRECTIONS)]
    return index[np.concatenate(chosen)]


def _sphere(count: int) -> NDArray[np.float64]:
    """``(count, 3)`` directions spread evenly (Fibonacci lattice)."""
    k = np.arange(count) + 0.5
    polar, azimuth = np.arccos(1 - 2 * k / count), np.pi * (1 + np.sqrt(5)) * k
    return np.stack([np.cos(azimuth) * np.sin(polar), np.sin(azimuth) * np.sin(polar), np.cos(polar)], axis=1)


def _solve(
    vertices: NDArray[np.float32],
    joints: NDArray[np.float64],
    mean_vertices: NDArray[np.float64],
    mean_joint: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Non-negative weights for ``vertices (S, n, 3)`` that meet ``joints (S, 3)``.

    Rows are centred on the joint and in centimetres, or the solver stops early; a QR step makes the
    system small and a slight ridge makes it definite.
    """
    count = vertices.shape[1]
    centred = 100 * (vertices - joints[:, None])
    mean_rows = MEAN_SHAPE_WEIGHT * 100 * (mean_vertices - mean_joint).T
    system = np.concatenate([*centred.transpose(2, 0, 1), mean_rows, np.full((1, count), 100.0)])
    goal = np.zeros(len(system))
    goal[-1] = 100.0
    q, r = np.linalg.qr(system)
    ridge = 1e-3 * np.eye(count)
    solution, _ = nnls(
        np.concatenate([r, ridge]), np.concatenate([q.T @ goal, np.zeros(count)]), maxiter=20 * count
    )
    solution[solution < SMALLEST] = 0
    return solution / solution.sum()
