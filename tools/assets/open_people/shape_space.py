"""Ten shape parameters: PCA over many adults, turned so that the first axes mean something.

Any rotation of whitened coefficients is again N(0, I), so the axes are turned towards things one can name.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from open_people.base_mesh import BODY_VERTICES, BaseMesh
from open_people.rig import Rig
from open_people.skeleton import PELVIS_AT_REST, joint_positions
from open_people.targets import MacroShape, TargetLibrary
from open_people.tpose import to_tpose

NUM_BETAS: Final = 10

AXES: Final = ("stature", "weight", "male", "age", "muscle", "proportions", "african-asian", "caucasian")
"""What the first axes follow; the last two are what remains."""

INNER_WEIGHT: Final = 0.3
"""Eyes, teeth and tongue count less than skin of the same area."""


@dataclass(frozen=True, eq=False)
class Samples:
    """Adults in the T-pose, pelvis at its rest place.

    Attributes:
        vertices: float32 ``(S, N, 3)``.
        joints: ``(S, 55, 3)``.
        sliders: ``(S, 11)``, columns as :meth:`MacroShape.names`.
    """

    vertices: NDArray[np.float32]
    joints: NDArray[np.float64]
    sliders: NDArray[np.float64]

    def slider(self, name: str) -> NDArray[np.float64]:
        """One slider over all samples."""
        return self.sliders[:, MacroShape.names().index(name)]

    @property
    def statures(self) -> NDArray[np.float64]:
        """``(S,)`` body height in metres."""
        y = self.vertices[:, :BODY_VERTICES, 1]
        return (y.max(axis=1) - y.min(axis=1)).astype(np.float64)


@dataclass(frozen=True, eq=False)
class ShapeSpace:
    """vertices(betas) = mean + Σ betas[k] directions[k], for every vertex of the base mesh, helpers included.

    Attributes:
        mean: ``(N, 3)``.
        directions: ``(10, N, 3)``; metres a standard deviation.
        coefficients: ``(S, 10)`` betas of the samples.
        joints_mean: ``(55, 3)`` mean of the wanted joints.
    """

    mean: NDArray[np.float64]
    directions: NDArray[np.float64]
    coefficients: NDArray[np.float64]
    joints_mean: NDArray[np.float64]


def random_adult(rng: np.random.Generator) -> MacroShape:
    """An adult: half women, half men, 23 to 85 years, all builds and origins; stature in a believable range.

    MakeHuman's height slider spans 1.29 to 2.38 m, so it is kept in a narrow band.
    """

    def slider(mean: float, deviation: float) -> float:
        return float(np.clip(rng.normal(mean, deviation), 0, 1))

    gender = slider(float(rng.random() < 0.5), 0.12)
    old = rng.random() < 0.9
    age = float(np.clip(0.5 + 0.5 * rng.beta(1.5, 3), 0.5, 0.95)) if old else 0.5 - 0.04 * float(rng.random())
    build = {
        "muscle": slider(0.52, 0.25),
        "weight": slider(0.60, 0.28),
        "height": slider(0.535, 0.04),
        "proportions": slider(0.6, 0.18),
        "cup": slider(0.5, 0.17),
        "firmness": slider(0.5, 0.15),
    }
    african, asian, caucasian = (float(x) for x in rng.dirichlet([0.6, 0.6, 0.6]))
    return MacroShape(gender=gender, age=age, african=african, asian=asian, caucasian=caucasian, **build)


def pose_adult(
    mesh: BaseMesh, rig: Rig, library: TargetLibrary, shape: MacroShape
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Vertices ``(N, 3)`` and joints ``(55, 3)`` of one adult in the T-pose, pelvis at its rest place."""
    tpose = to_tpose(rig, library.morph(mesh.vertices, shape))
    joints = joint_positions(rig, tpose.heads)
    shift = PELVIS_AT_REST - joints[0]
    return tpose.vertices + shift, joints + shift


def draw_samples(mesh: BaseMesh, rig: Rig, library: TargetLibrary, count: int, seed: int) -> Samples:
    """``count`` random adults."""
    rng = np.random.default_rng(seed)
    vertices = np.zeros((count, mesh.num_vertices, 3), np.float32)
    joints = np.zeros((count, 55, 3))
    sliders = np.zeros((count, len(MacroShape.names())))
    for k in range(count):
        shape = random_adult(rng)
        vertices[k], joints[k] = pose_adult(mesh, rig, library, shape)
        sliders[k] = shape.values()
    return Samples(vertices, joints, sliders)


def vertex_areas(vertices: NDArray[np.float64], quads: NDArray[np.int64]) -> NDArray[np.float64]:
    """``(N,)`` a quarter of the area of every quad at the vertex."""
    p = vertices[quads]
    area = np.linalg.norm(np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1]), axis=1) / 2
    share = np.repeat(area / 4, 4)
    return np.bincount(quads.ravel(), weights=share, minlength=len(vertices)).astype(np.float64)


def fit_shape_space(mesh: BaseMesh, samples: Samples) -> ShapeSpace:
    """Area-weighted PCA of the body, axes turned as :data:`AXES` says, all vertices regressed on the
    result."""
    count = len(samples.vertices)
    mean = samples.vertices.mean(axis=0, dtype=np.float64)
    keep = mesh.model_vertices
    area = vertex_areas(mean, mesh.quads[np.isin(mesh.quads, keep).all(axis=1)])[keep]
    weight = np.sqrt(area / area.mean())
    weight[BODY_VERTICES:] *= INNER_WEIGHT
    delta = ((samples.vertices[:, keep] - mean[keep]) * weight[:, None]).reshape(count, -1)
    values, vectors = np.linalg.eigh(delta @ delta.T)
    coefficients = vectors[:, np.argsort(-values)[:NUM_BETAS]] * np.sqrt(count)
    coefficients = coefficients @ _named_axes(coefficients, samples)
    flat = (samples.vertices - mean.astype(np.float32)).reshape(count, -1)
    directions = np.linalg.solve(coefficients.T @ coefficients, coefficients.T @ flat)
    return ShapeSpace(mean, directions.reshape(NUM_BETAS, -1, 3), coefficients, samples.joints.mean(axis=0))


def _named_axes(coefficients: NDArray[np.float64], samples: Samples) -> NDArray[np.float64]:
    """Orthogonal ``(10, 10)``: columns point where each named quantity grows fastest, made orthogonal in
    turn."""
    goals = [
        samples.statures,
        samples.slider("weight"),
        samples.slider("gender"),
        samples.slider("age"),
        samples.slider("muscle"),
        samples.slider("proportions"),
        samples.slider("african") - samples.slider("asian"),
        samples.slider("caucasian"),
    ]
    columns: list[NDArray[np.float64]] = []
    gradients = [np.linalg.lstsq(coefficients, goal - goal.mean(), rcond=None)[0] for goal in goals]
    # The unit vectors complete the basis; those already spanned vanish and are left out.
    for candidate in [*gradients, *np.eye(NUM_BETAS)]:
        left = candidate / np.linalg.norm(candidate)
        for column in columns:
            left = left - column * (column @ left)
        if np.linalg.norm(left) > 0.05 and len(columns) < NUM_BETAS:
            columns.append(left / np.linalg.norm(left))
    return np.stack(columns, axis=1)


def shape_statistics(samples: Samples, space: ShapeSpace) -> dict[str, list[list[float]]]:
    """How betas go with gender, age and origin: betas ~ N(matrix · x, deviation · deviationᵀ).

    x = (1, male, years past 25 as a share of 65, African, Asian).
    """
    columns = [
        np.ones(len(samples.sliders)),
        samples.slider("gender"),
        (samples.slider("age") - 0.5) / 0.5,
        samples.slider("african"),
        samples.slider("asian"),
    ]
    x = np.stack(columns, axis=1)
    matrix = np.linalg.lstsq(x, space.coefficients, rcond=None)[0].T
    deviation = np.linalg.cholesky(np.cov((space.coefficients - x @ matrix.T).T))
    return {"matrix": matrix.round(4).tolist(), "deviation": deviation.round(4).tolist()}
