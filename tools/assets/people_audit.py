"""Measures the people: ``python tools/assets/people_audit.py [--people 40] [--around 8]``.

In every pose of ``hard_poses.py``: the volume of the skin against that at rest, and how much of what cloth
covers at rest comes out of it: skin out of clothes, clothes out of the clothes over them. With ``--around``
the first few people are also looked at from all sides for gaps (``seen.py``; half a minute each).
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

sys.path.insert(0, str(Path(__file__).parents[2]))
sys.path.insert(0, str(Path(__file__).parent))

from hard_poses import HARD_POSES, hard_pose
from seen import inside_seen

from render_jobs.scene import Mesh
from whacamole.body import BodyModel, BodyParams, mesh_volume
from whacamole.wardrobe import CastMember, cast, dress
from whacamole.wardrobe.catalogue import catalogue
from whacamole.wardrobe.layering import OVER

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

NEAR_M: Final = 0.03
"""What lies farther under cloth at rest does not count as covered by it."""

OUT_M: Final = 0.002
"""What lies farther than this outside the cloth has come through it."""

STRAIGHT: Final = 0.7
"""Least cosine between the way to the nearest cloth and its normal; past an edge it is less."""

PATCH: Final = 24
"""Points of the cloth that make the patch over a point."""

SPLITS: Final = 3
"""Points along either side of a cloth face."""


@dataclass
class Count:
    """Covered points, and those that came through."""

    covered: int = 0
    through: int = 0
    deepest_mm: float = 0.0
    worst: list[tuple[float, str]] = field(default_factory=list)

    def add(self, outside: Floats, what: str) -> None:
        """Counts points by how far outside they are [m]."""
        self.covered += len(outside)
        self.through += int((outside > OUT_M).sum())
        if len(outside):
            self.deepest_mm = max(self.deepest_mm, 1e3 * float(outside.max()))
            self.worst.append((float((outside > OUT_M).sum()), what))

    def as_dict(self) -> dict[str, object]:
        """For the report."""
        share = 100 * self.through / max(self.covered, 1)
        worst = [f"{what}: {number:.0f}" for number, what in sorted(self.worst, reverse=True)[:4] if number]
        return {
            "covered": self.covered,
            "through": self.through,
            "share_percent": round(share, 3),
            "deepest_mm": round(self.deepest_mm, 1),
            "worst": worst,
        }


def params_of(member: CastMember, poses: list[Floats]) -> BodyParams:
    """A frame for each body pose ``(21, 3)``."""
    arrays = BodyParams.zeros(len(poses), member.betas).to_arrays()
    arrays["body_pose"] = np.stack(poses)
    return BodyParams.from_arrays(arrays)


def cloth_points(faces: NDArray[np.int32]) -> tuple[Indices, Floats]:
    """Corners ``(n, 4)`` and weights ``(n, 4)`` of points spread over the faces ``(F, 3 or 4)``."""
    corners = faces if faces.shape[1] == 4 else np.column_stack([faces, faces[:, 2]])
    corners = np.where(corners < 0, corners[:, 2:3], corners)
    t = np.linspace(0, 1, SPLITS)
    u, v = (grid.ravel() for grid in np.meshgrid(t, t))
    weights = np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], axis=1)
    return np.repeat(corners, len(weights), axis=0), np.tile(weights, (len(corners), 1))


class Cover:
    """Which points a cloth covers at rest, and by which of its patches; then how far they come out of those.

    Only the patch that covers a point at rest counts: at a hip that bends a shirt folds into the crease and
    the trousers of the thigh come to lie over it, as they should. Of a patch only the sheet nearest at rest
    counts: a collar is folded, and its other sheet faces the other way.
    """

    def __init__(self, points: Floats, cloth: Floats, faces: NDArray[np.int32]) -> None:
        self._corners, self._weights = cloth_points(faces)
        self._patch = np.zeros((len(points), PATCH), np.intp)
        at, normal = self._surface(cloth)
        _, self._patch = cKDTree(at).query(points, k=PATCH)
        first = self._patch[:, :1]
        same_sheet = np.einsum("nkc,nkc->nk", normal[self._patch], normal[first]) > 0
        self._patch = np.where(same_sheet, self._patch, first)
        depth, distance = self._outside(points, cloth)
        self.covered = (depth < 0.0) & (distance < NEAR_M) & (-depth > STRAIGHT * distance)

    def outside(self, points: Floats, cloth: Floats) -> Floats:
        """How far the covered points lie outside the cloth [m]; 0 for one that left it past an edge."""
        depth, distance = self._outside(points, cloth)
        out = np.where(np.abs(depth) > STRAIGHT * distance, depth, 0.0)
        return np.asarray(out[self.covered])

    def _surface(self, cloth: Floats) -> tuple[Floats, Floats]:
        p = cloth[self._corners]
        normal = np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1])
        length = np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
        return np.einsum("nk,nkc->nc", self._weights, p), normal / length

    def _outside(self, points: Floats, cloth: Floats) -> tuple[Floats, Floats]:
        at, normal = self._surface(cloth)
        apart = points[:, None] - at[self._patch]
        distance = np.linalg.norm(apart, axis=2)
        nearest = distance.argmin(axis=1)
        rows = np.arange(len(points))
        depth = np.einsum("nk,nk->n", apart[rows, nearest], normal[self._patch[rows, nearest]])
        return depth, distance[rows, nearest]


def dressed(member: CastMember, body: BodyModel, textures: str) -> dict[str, Mesh]:
    """A member's meshes by item; frame 0 is at rest, then come the hard poses."""
    params = params_of(member, [np.zeros((21, 3)), *map(hard_pose, HARD_POSES)])
    meshes = dress(member, body, params, textures=Path(textures))
    return {mesh.name.removeprefix("person-"): mesh for mesh in meshes}


def audit(count: int) -> Iterator[tuple[str, str, Floats, str]]:
    """For every person, pose and pair of layers: pair, pose, how far covered points are outside [m], what."""
    body = BodyModel.embedded()
    with tempfile.TemporaryDirectory() as textures:
        for seed in range(count):
            member = cast(seed)
            meshes = dressed(member, body, textures)
            slots = {catalogue().items[worn.item].slot: worn.item for worn in member.worn}
            for slot in ("bottom", "shoes", "top"):
                outer = slots[slot]
                over = meshes[outer]
                for inner in ("skin", *(slots[under] for above, under in OVER if above == slot)):
                    under = meshes[inner]
                    cloth, skin = (np.asarray(m.vertices, np.float64) for m in (over, under))
                    cover = Cover(skin[0], cloth[0], over.faces)
                    pair = "skin" if inner == "skin" else "cloth"
                    for frame, pose in enumerate(HARD_POSES, start=1):
                        out = cover.outside(skin[frame], cloth[frame])
                        yield pair, pose, out, f"{seed} {inner} through {outer}"


def insides(count: int) -> dict[str, object]:
    """By pose: of the pixels that show a person from all sides, those with the inside of a surface [%]."""
    body = BodyModel.embedded()
    shown, inside = Counter[str](), Counter[str]()
    with tempfile.TemporaryDirectory() as textures:
        for seed in range(count):
            meshes = dressed(cast(seed), body, textures)
            solid = {name: mesh for name, mesh in meshes.items() if mesh.material.alpha_mode == "opaque"}
            for frame, pose in enumerate(("rest", *HARD_POSES)):
                for pixels, backs in inside_seen(solid, frame):
                    shown[pose] += pixels
                    inside[pose] += sum(backs.values())
    return {pose: round(100 * inside[pose] / shown[pose], 3) for pose in shown}


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--people", type=int, default=40)
    parser.add_argument("--around", type=int, default=0, help="people to look at from all sides")
    parser.add_argument(
        "--body", type=Path, help="measure the volume of this body instead of the shipped one"
    )
    arguments = parser.parse_args()
    body = BodyModel.load(arguments.body) if arguments.body else BodyModel.embedded()
    skin = body.faces[body.extras["vertex_part"][body.faces[:, 0]] == 0]
    params = params_of(cast(0), [hard_pose(name) for name in HARD_POSES])
    rest = mesh_volume(body.rest_vertices(params.betas), skin)
    posed = body.pose(params).vertices
    volumes = {name: round(mesh_volume(p, skin) / rest, 3) for name, p in zip(HARD_POSES, posed, strict=True)}
    counts: dict[str, dict[str, Count]] = {"skin": {}, "cloth": {}}
    for pair, pose, out, what in audit(arguments.people):
        counts[pair].setdefault(pose, Count()).add(out, what)
    report = {
        "volume_against_rest": volumes,
        **{
            f"{pair} through cloth": {pose: count.as_dict() for pose, count in by_pose.items()}
            for pair, by_pose in counts.items()
        },
    }
    if arguments.around:
        report["insides_seen_percent"] = insides(arguments.around)
    print(json.dumps(report, indent=1))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
