"""Contact between people: closed forms on toys, brute force on posed bodies, and what must always hold.

Brute force here is a slow and plain second way that shares no code with the package.
"""

import numpy as np
import pytest
import scipy.sparse
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from whacamole.body import BodyParams
from whacamole.labels import BodyParts, model_parts
from whacamole.labels.closest import SkinSearch
from whacamole.labels.flood import _connect
from whacamole.labels.patches import PosedSkin, SkinMap
from whacamole.labels.skin import OuterSkin
from whacamole.labels.touch import EXACT_WITHIN, Touch, touch
from whacamole.labels.winding import inside
from whacamole.motion import embedded_motions, read_motion

THRESHOLD = 0.01


def winding_numbers(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """How often a closed surface ``(F, 3, 3)`` goes round each point, by van Oosterom and Strackee."""
    turns = np.empty(len(points))
    for row, point in enumerate(points):
        a, b, c = np.moveaxis(triangles - point, 1, 0)
        la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
        volume = (a * np.cross(b, c)).sum(axis=1)
        spread = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
        turns[row] = 2 * np.arctan2(volume, spread).sum() / (4 * np.pi)
    return turns


def distances(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Distance to the nearest of all triangles, each point against each triangle.

    Inside the prism over a triangle it is the height; elsewhere the nearest point of a side.
    """
    a, b, c = np.moveaxis(triangles, 1, 0)
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    best = np.empty(len(points))
    for row, point in enumerate(points):
        height = np.abs(((point - a) * normal).sum(axis=1))
        over = np.ones(len(a), dtype=bool)
        nearest = np.full(len(a), np.inf)
        for start, end in ((a, b), (b, c), (c, a)):
            side = end - start
            over &= (np.cross(side, point - start) * normal).sum(axis=1) >= 0
            along = ((point - start) * side).sum(axis=1) / (side * side).sum(axis=1)
            foot = start + np.clip(along, 0, 1)[:, None] * side
            nearest = np.minimum(nearest, np.linalg.norm(point - foot, axis=1))
        best[row] = np.where(over, height, nearest).min()
    return best


def signed_distances(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Negative inside."""
    far = distances(points, triangles)
    return np.where(winding_numbers(points, triangles) > 0.5, -far, far)


class Toy:
    """A mesh as a body, with its parts."""

    def __init__(self, vertices: np.ndarray, faces: np.ndarray, parts: BodyParts) -> None:
        self.skin = OuterSkin.build(vertices, faces)
        self.map = SkinMap.build(self.skin, parts, vertices)
        self.parts = parts

    def posed(self, vertices: np.ndarray) -> PosedSkin:
        return PosedSkin(self.map, self.skin.close(vertices))

    def touch(self, a: np.ndarray, b: np.ndarray) -> tuple[Touch, Touch]:
        return touch(self.posed(a), self.posed(b), len(self.parts.names), THRESHOLD)

    def vertices(self, side: Touch) -> np.ndarray:
        """Touching vertices, by their number on the mesh."""
        return np.sort(self.map.ids[side.points])


def one_part(vertices: np.ndarray) -> BodyParts:
    return BodyParts(("all",), np.zeros(len(vertices), dtype=np.int32))


def halves(vertices: np.ndarray) -> BodyParts:
    """Two parts, cut at x = 0."""
    return BodyParts(("right", "left"), (vertices[:, 0] > 0).astype(np.int32))


@pytest.fixture(scope="module")
def human(model):
    return Toy(model.v_template, model.faces, model_parts(model))


@pytest.mark.parametrize("gap", [0.2, 0.04, 0.009, 0.0, -0.008, -0.02])
def test_two_boxes_approach(box, gap):
    toy = Toy(*box, halves(box[0]))
    offset = np.array([1 + gap, 0.013, -0.007])
    a, b = toy.touch(box[0], box[0] + offset)
    # A's left half (x > 0) faces B's right half.
    tolerance = 1e-9 if gap <= EXACT_WITHIN else 1e-3
    assert a.distance[1] == pytest.approx(gap, abs=tolerance)
    assert b.distance[0] == pytest.approx(gap, abs=tolerance)
    np.testing.assert_array_equal(a.other_part, [-1, 0 if gap <= THRESHOLD else -1])
    np.testing.assert_array_equal(b.other_part, [1 if gap <= THRESHOLD else -1, -1])
    face = box[0][:, 0] == 0.5
    if gap > THRESHOLD:
        assert not a.points.any()
    else:
        # Every vertex of A's face that lies opposite B's face, or inside B, and none beyond reach of its rim.
        y, z = box[0][:, 1] - 0.013, box[0][:, 2] + 0.007
        opposite = face & (np.abs(y) <= 0.5) & (np.abs(z) <= 0.5)
        near = face & (np.abs(y) <= 0.5 + THRESHOLD) & (np.abs(z) <= 0.5 + THRESHOLD)
        touching = toy.vertices(a)
        assert np.isin(np.flatnonzero(opposite), touching).all()
        assert np.isin(touching, np.flatnonzero(near)).all()


def test_far_gaps_are_never_too_short_and_nearly_right(human, model, standing):
    a, b = (model.pose(standing(1, x=x, seed=s)).vertices[0] for x, s in ((0, 1), (3, 2)))
    sides = human.touch(a, b)
    for mine, theirs, side in ((a, b, sides[0]), (b, a, sides[1])):
        corner = cKDTree(theirs[human.skin.vertices]).query(mine)[0]
        for part in range(len(human.parts.names)):
            members = np.intersect1d(human.parts.vertices(human.parts.names[part]), human.skin.vertices)
            exact = corner[members].min()
            assert exact - 1e-6 <= side.distance[part] <= exact + 0.05
        assert (side.other_part == -1).all()
        assert not side.points.any()


def capsule() -> trimesh.Trimesh:
    return trimesh.creation.capsule(height=1.0, radius=0.25, count=[40, 40])


def test_signed_distance_to_a_capsule():
    mesh = capsule()
    vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.faces)
    toy = Toy(vertices, faces, one_part(vertices))
    rng = np.random.default_rng(5)
    points = rng.uniform([-0.6, -0.6, -0.6], [0.6, 0.6, 1.6], size=(500, 3))
    axis = np.clip(points[:, 2], vertices[:, 2].min() + 0.25, vertices[:, 2].max() - 0.25)
    exact = np.linalg.norm(points - np.column_stack([np.zeros((500, 2)), axis]), axis=1) - 0.25
    found = SkinSearch(toy.posed(vertices), np.arange(len(toy.map.patches.part))).closest(points[:, :])
    np.testing.assert_allclose(found.distance, exact, atol=4e-3)  # the mesh lies inside the capsule
    clear = np.abs(exact) > 5e-3
    np.testing.assert_array_equal(found.distance[clear] < 0, exact[clear] < 0)


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=15, deadline=None, derandomize=True)
def test_signed_distance_by_brute_force(seed):
    """A star of spikes: sharp edges and corners, inside and out, points on the surface among them."""
    rng = np.random.default_rng(seed)
    mesh = trimesh.creation.icosphere(subdivisions=2)
    vertices = np.asarray(mesh.vertices) * rng.uniform(0.3, 1.5, size=(len(mesh.vertices), 1))
    toy = Toy(vertices, np.asarray(mesh.faces), one_part(vertices))
    points = np.concatenate(
        [rng.normal(scale=0.8, size=(60, 3)), 0.999 * vertices[:20], 1.001 * vertices[:20]]
    )
    search = SkinSearch(toy.posed(vertices), np.arange(len(toy.map.patches.part)))
    expected = signed_distances(points, vertices[mesh.faces])
    np.testing.assert_allclose(search.closest(points).distance, expected, atol=1e-9)
    low, high = search.bounds(points, 10.0)
    assert (low <= np.abs(expected) + 1e-12).all()
    assert (high >= np.abs(expected) - 1e-12).all()


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=15, deadline=None, derandomize=True)
def test_points_of_a_triangle_are_within_reach_of_a_corner(seed):
    """Needles and flat triangles among them. The bound is attained; twice as wide at most where obtuse."""
    rng = np.random.default_rng(seed)
    ball = trimesh.creation.icosphere(subdivisions=1)
    vertices, faces = np.asarray(ball.vertices), np.asarray(ball.faces)
    skin = Toy(vertices, faces, one_part(vertices)).posed(
        vertices * [1, 1, 10.0 ** rng.uniform(-9, 1)] + rng.normal(scale=0.2, size=vertices.shape) * [1, 1, 0]
    )
    reach = skin.corner_reach(skin.map.corner)
    weights = rng.dirichlet([0.7, 0.7, 0.7], size=4000)
    for triangle, bound in zip(skin.points[skin.map.faces], reach, strict=True):
        nearest = np.linalg.norm((weights @ triangle)[:, None] - triangle, axis=2).min(axis=1).max()
        assert nearest <= np.sqrt(bound) * (1 + 1e-6)
        assert nearest >= 0.45 * np.sqrt(bound)


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=30, deadline=None, derandomize=True)
def test_components_are_those_of_scipy(seed):
    rng = np.random.default_rng(seed)
    start, end = rng.integers(0, 200, size=(2, rng.integers(0, 250)))
    graph = scipy.sparse.coo_array((np.ones(len(start)), (start, end)), shape=(200, 200))
    _, expected = connected_components(graph, directed=False)
    label = _connect(start, end, 200)
    np.testing.assert_array_equal(label[:, None] == label, expected[:, None] == expected)


@pytest.mark.parametrize(("seed", "offset"), [(3, 0.45), (4, 0.3), (6, 0.0)])
def test_posed_people_against_brute_force(human, model, standing, seed, offset):
    """Every vertex decision, every part and every gap within the exact range."""
    a = model.pose(standing(1, seed=seed)).vertices[0].astype(np.float64)
    b = model.pose(standing(1, x=offset, y=0.6 * offset, seed=seed + 10)).vertices[0].astype(np.float64)
    skins = human.posed(a), human.posed(b)
    sides = touch(*skins, len(human.parts.names), THRESHOLD)
    rng = np.random.default_rng(seed)
    for own, other, side in ((*skins, sides[0]), (*skins[::-1], sides[1])):
        near = np.flatnonzero(
            ((own.points > other.low - 0.05) & (own.points < other.high + 0.05)).all(axis=1)
        )
        some = rng.permutation(near)[:50]
        exact = signed_distances(own.points[some], other.points[human.map.faces])
        np.testing.assert_array_equal(side.points[some], exact <= THRESHOLD)
        for part in np.unique(human.map.part[some]):
            least = exact[human.map.part[some] == part].min()
            if least <= EXACT_WITHIN:
                assert side.distance[part] <= least + 1e-9


def test_gap_of_every_part_by_brute_force(human, model, standing):
    """The reported gap is attained: full brute force over all vertices of a hand near another person."""
    a = model.pose(standing(1, seed=3)).vertices[0].astype(np.float64)
    b = model.pose(standing(1, x=0.45, y=0.27, seed=13)).vertices[0].astype(np.float64)
    own, other = human.posed(a), human.posed(b)
    side, back = touch(own, other, len(human.parts.names), THRESHOLD)
    mine = np.flatnonzero(side.distance <= EXACT_WITHIN)
    assert len(mine) >= 3
    for part in mine:
        members = np.flatnonzero(human.map.part == part)
        close = np.linalg.norm(own.points[members, None] - other.centre, axis=2).min(axis=1)
        some = members[np.argsort(close)[:40]]
        exact = signed_distances(own.points[some], other.points[human.map.faces]).min()
        # Touching vertices of the other person that land on this part may bring the gap down further.
        assert side.distance[part] <= exact + 1e-9
        if back.distance.min() > THRESHOLD:
            assert side.distance[part] == pytest.approx(exact, abs=1e-9)


@given(seed=st.integers(0, 10_000), offset=st.floats(0.0, 0.7), turn=st.floats(-3, 3))
@settings(max_examples=12, deadline=None, derandomize=True)
def test_invariants(human, model, standing, seed, offset, turn):
    a = model.pose(standing(1, seed=seed)).vertices[0].astype(np.float64)
    b = model.pose(standing(1, x=offset, y=0.1, seed=seed + 1)).vertices[0].astype(np.float64)
    one, two = human.touch(a, b)
    for side in (one, two):
        np.testing.assert_array_equal(side.other_part >= 0, side.distance <= THRESHOLD)
        # A touching vertex makes its part touch.
        parts = human.map.part[side.points]
        assert (side.other_part[parts] >= 0).all()
    # Touch is mutual, and so is the deepest gap of touching people.
    assert (one.other_part >= 0).any() == (two.other_part >= 0).any()
    if (one.other_part >= 0).any():
        assert one.distance.min() == pytest.approx(two.distance.min(), abs=1e-12)
    # Swapping the people swaps the answer; moving both moves nothing.
    swapped = human.touch(b, a)
    np.testing.assert_array_equal(swapped[0].distance, two.distance)
    np.testing.assert_array_equal(swapped[1].points, one.points)
    R = Rotation.from_rotvec([0, 0, turn]).as_matrix()
    moved = human.touch(a @ R.T + [5, -2, 1], b @ R.T + [5, -2, 1])
    exact = one.distance <= EXACT_WITHIN
    np.testing.assert_allclose(moved[0].distance[exact], one.distance[exact], atol=1e-9)


def test_a_person_wholly_inside_another(ball):
    """The flood must not take an enclosed body for one outside."""
    toy = Toy(*ball, halves(ball[0]))
    inner, outer = 0.4 * ball[0], ball[0]
    small, large = toy.touch(inner, outer)
    assert small.points.all()
    np.testing.assert_allclose(small.distance, -0.6, atol=5e-3)
    assert (small.other_part >= 0).all()
    # The outer one touches too, through the points that lie in it, though none of its vertices does.
    assert not large.points.any()
    np.testing.assert_allclose(large.distance, -0.6, atol=5e-3)


def crawling(model, frame: int) -> np.ndarray:
    person = read_motion(embedded_motions() / "crawl.npz").people[0]
    rest = BodyParams.zeros(1)
    fields = {name: np.array(getattr(rest, name)) for name in BodyParams.__dataclass_fields__}
    for name in ("global_orient", "body_pose"):
        fields[name] = getattr(person, name)[frame].reshape(fields[name].shape)
    fields["transl"] = person.pelvis[frame, None] - model.rest_joints(np.zeros(10))[0]
    return model.pose(BodyParams(**fields)).vertices[0].astype(np.float64)


def test_no_vertex_inside_is_missed_where_a_skin_crosses_itself(human, model):
    """Crouching skins cross themselves at hips and armpits, and normals then tell the wrong side."""
    a, b = crawling(model, 10), crawling(model, 35) + np.array([0, 0, 0.28])
    own, other = human.posed(a), human.posed(b)
    side = touch(own, other, len(human.parts.names), THRESHOLD)[0]
    near = cKDTree(other.points).query(own.points, distance_upper_bound=0.08)[0] < 0.08
    left = np.flatnonzero(near & ~side.points)
    assert len(left) > 1000
    assert not inside(own.points[left], other).any()
    some = left[:: len(left) // 40]
    assert (winding_numbers(own.points[some], other.points[human.map.faces]) < 0.5).all()
    deep = np.flatnonzero(side.points)[::30]
    far = signed_distances(own.points[deep], other.points[human.map.faces])
    assert (far <= THRESHOLD).all()
    for part in np.unique(human.map.part[deep]):
        assert side.distance[part] <= far[human.map.part[deep] == part].min() + 1e-9


@pytest.mark.parametrize(("seed", "offset"), [(104, 0.3), (125, 0.15)])
def test_a_sheet_turned_inside_out_draws_nobody_in(human, model, standing, seed, offset):
    """Normals take points before such a sheet for inside, and all that are tied to them are drawn in."""
    a = model.pose(standing(1, seed=seed)).vertices[0].astype(np.float64)
    b = model.pose(standing(1, x=offset, y=0.1, seed=seed + 1000)).vertices[0].astype(np.float64)
    skins = human.posed(a), human.posed(b)
    sides = touch(*skins, len(human.parts.names), THRESHOLD)
    for own, other, side in ((*skins, sides[0]), (*skins[::-1], sides[1])):
        touching = np.flatnonzero(side.points)
        some = touching[:: max(1, len(touching) // 60)]
        exact = signed_distances(own.points[some], other.points[human.map.faces])
        assert (exact <= THRESHOLD).all()


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=10, deadline=None, derandomize=True)
def test_inside_by_solid_angles(seed):
    """A ball whose top is pushed anywhere: it crosses itself, with lobes counted twice or negative."""
    rng = np.random.default_rng(seed)
    ball = trimesh.creation.icosphere(subdivisions=2)
    vertices, faces = np.asarray(ball.vertices), np.asarray(ball.faces)
    toy = Toy(vertices, faces, one_part(vertices))
    push = rng.normal(scale=0.8, size=3)
    folded = vertices * rng.uniform(0.7, 1.3, 3) + np.outer(vertices[:, 2] > 0.3, push)
    points = rng.uniform(-1.5, 1.5, size=(200, 3))
    turns = winding_numbers(points, folded[faces])
    np.testing.assert_array_equal(inside(points, toy.posed(folded)), turns > 0.5)
