"""Single vertices with a name: nose, eyes, ears, heels, tips of toes and fingers.

The ``smplx`` package reads these points at fixed vertex numbers (those of SMPL-X). The body is therefore
numbered so that the vertex at each such number is the point the package means.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from open_people.base_mesh import BODY_VERTICES, BaseMesh
from open_people.rig import Rig
from open_people.skeleton import FINGER_NUMBERS

SMPLX_NUMBERS: Final = {
    "nose": 9120, "reye": 9929, "leye": 9448, "rear": 616, "lear": 6,
    "rthumb": 8079, "rindex": 7669, "rmiddle": 7794, "rring": 7905, "rpinky": 8022,
    "lthumb": 5361, "lindex": 4933, "lmiddle": 5058, "lring": 5169, "lpinky": 5286,
    "LBigToe": 5770, "LSmallToe": 5780, "LHeel": 8846, "RBigToe": 8463, "RSmallToe": 8474, "RHeel": 8635,
}  # fmt: skip
"""Where every tool that speaks SMPL-X looks for these points."""


def named_vertices(mesh: BaseMesh, rig: Rig, vertices: NDArray[np.float64]) -> dict[str, int]:
    """Base-mesh vertex by name, found on the T-pose ``vertices (N, 3)``; the right side mirrors the left."""
    found: dict[str, int] = {"nose": _nose_tip(vertices, rig)}
    left: dict[str, int] = {"eye": _farthest(vertices, mesh.vertex_groups["helper-l-eye"], [0, 0, 1])}
    left["ear"] = _ear(vertices, rig)
    for finger, number in FINGER_NUMBERS.items():
        direction = rig.tails @ vertices - rig.heads @ vertices
        bone = rig.index[f"finger{number}-3.L"]
        left[finger] = _farthest(vertices, _moved_by(rig, f"finger{number}-3.L"), direction[bone])
    left["BigToe"] = _farthest(vertices, _moved_by(rig, "toe1-2.L"), [0, 0, 1])
    left["SmallToe"] = _farthest(vertices, _moved_by(rig, "toe5-3.L"), [0, 0, 1])
    left["Heel"] = _heel(vertices, rig)
    for name, vertex in left.items():
        for letter, chosen in (("l", vertex), ("r", int(mesh.mirror[vertex]))):
            found[(letter.upper() if name[0].isupper() else letter) + name] = chosen
    return found


def model_order(mesh: BaseMesh, named: dict[str, int]) -> NDArray[np.int64]:
    """Base-mesh indices in the order of the model: as in the base mesh, with the named ones swapped into
    place."""
    order = mesh.model_vertices.copy()
    for name, number in SMPLX_NUMBERS.items():
        present = int(np.flatnonzero(order == named[name])[0])
        order[[present, number]] = order[[number, present]]
    return order


def _moved_by(rig: Rig, bone: str) -> NDArray[np.int64]:
    """Skin vertices that mostly follow one bone."""
    weights = rig.weights[:BODY_VERTICES, rig.index[bone]].toarray().ravel()
    return np.flatnonzero(weights > 0.5)


def _farthest(
    vertices: NDArray[np.float64], among: NDArray[np.int64], direction: NDArray[np.float64] | list[float]
) -> int:
    return int(among[np.argmax(vertices[among] @ np.asarray(direction, float))])


def _head(rig: Rig) -> NDArray[np.int64]:
    weights = rig.weights[:BODY_VERTICES].toarray()
    names = [name for name in rig.names if name == "head" or rig.parent_name(name) == "head"]
    return np.flatnonzero(weights[:, [rig.index[name] for name in names]].sum(axis=1) > 0.5)


def _nose_tip(vertices: NDArray[np.float64], rig: Rig) -> int:
    """The foremost point of the head's middle line."""
    head = np.arange(BODY_VERTICES)[vertices[:BODY_VERTICES, 1] > vertices[_head(rig), 1].min()]
    return _farthest(vertices, head[np.abs(vertices[head, 0]) < 1e-4], [0, 0, 1])


def _ear(vertices: NDArray[np.float64], rig: Rig) -> int:
    """The middle of the ear: of the part that stands out from the head, the vertex nearest to its mean."""
    head = _head(rig)
    widest = vertices[head, 0].max()
    ear = head[vertices[head, 0] > widest - 0.018]
    return int(ear[np.argmin(np.linalg.norm(vertices[ear] - vertices[ear].mean(axis=0), axis=1))])


def _heel(vertices: NDArray[np.float64], rig: Rig) -> int:
    """The rearmost point of the foot, a little above the ground."""
    foot = _moved_by(rig, "foot.L")
    low = foot[vertices[foot, 1] < vertices[foot, 1].min() + 0.03]
    return _farthest(vertices, low, [0, 0, -1])
