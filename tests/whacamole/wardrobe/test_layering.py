"""Clothes over clothes, and clothes over skin."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from whacamole.body import JOINT_INDEX, BodyParams, vertex_normals
from whacamole.wardrobe.cast import UNDER_HAT, cast
from whacamole.wardrobe.catalogue import catalogue
from whacamole.wardrobe.hooks import hang
from whacamole.wardrobe.layer import item_layer
from whacamole.wardrobe.layering import wear_all
from whacamole.wardrobe.skin import beside, drawn_in, keep_below

PAIRS = (("pullover", "jeans_worn"), ("tee", "jeans"), ("suit_jacket", "suit_trousers"))


def params(turns, betas, frames=9):
    """From rest to a pose in equal steps; a name without a side turns both."""
    arrays = BodyParams.zeros(frames, betas).to_arrays()
    steps = np.linspace(0, 1, frames)[:, None]
    for joint, turn in turns.items():
        for side, mirror in (("left_", 1), ("right_", -1)):
            name = joint if joint in JOINT_INDEX else side + joint
            arrays["body_pose"][:, JOINT_INDEX[name] - 1] = steps * turn * [1, mirror, mirror]
    return BodyParams.from_arrays(arrays)


BEND = {"hip": (-1.3, 0, 0), "spine1": (0.4, 0, 0), "spine2": (0.3, 0, 0)}
SIT = {"hip": (-1.5, 0, 0.1), "knee": (1.5, 0, 0)}


def worn(body, outer, inner, moment):
    """Layers posed alone, the inner one worn under the outer, and what of it is left out."""
    wardrobe = catalogue()
    layers = [item_layer(wardrobe, name) for name in (outer, inner)]
    over, alone = (layer.pose(body, moment) for layer in layers)
    under = alone.copy()
    items = [wardrobe.items[name] for name in (outer, inner)]
    rest = [layer.rest(moment.betas) for layer in layers]
    return over, alone, under, wear_all(wardrobe, items, rest, [over, under])[1]


def spread(cloth, faces):
    """Points ``(n, 3)`` over a cloth and the normals there."""
    corners = np.where(faces < 0, faces[:, 2:3], faces)
    t = np.linspace(0, 1, 5)
    u, v = (grid.ravel() for grid in np.meshgrid(t, t))
    shares = np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], axis=1)
    normals = vertex_normals(cloth, np.concatenate([corners[:, :3], corners[:, [0, 2, 3]]]))
    at, out = (np.einsum("pk,fkc->fpc", shares, values[corners]) for values in (cloth, normals))
    return at.reshape(-1, 3), out.reshape(-1, 3)


def outside(points, cloth, faces, patch=None):
    """How far points (n, 3) are outside a cloth, and from it; of each, only some of its points may count."""
    at, out = spread(cloth, faces)
    if patch is None:
        patch = cKDTree(at).query(points)[1][:, None]
    apart = points[:, None] - at[patch]
    nearest = np.linalg.norm(apart, axis=2).argmin(axis=1)
    rows = np.arange(len(points))
    apart = apart[rows, nearest]
    return np.einsum("nk,nk->n", apart, out[patch[rows, nearest]]), np.linalg.norm(apart, axis=1)


@pytest.mark.parametrize("turns", [BEND, SIT])
def test_waistbands_stay_below_the_hems_over_them(body, turns):
    """Of what a hem covers closely at rest next to nothing comes out; left to itself much does."""
    covered, through, alone_through = 0, 0, 0
    for outer, inner in PAIRS:
        over, alone, under, hidden = worn(body, outer, inner, params(turns, np.linspace(-1, 1, 10)))
        faces = catalogue().geometry(outer).faces
        depth, distance = outside(under[0], over[0], faces)
        chosen = np.flatnonzero(~hidden & (distance < 0.03) & (-depth > 0.8 * distance))
        patch = cKDTree(spread(over[0], faces)[0]).query(under[0][chosen], k=60)[1]
        covered += len(chosen)
        through += (outside(under[-1][chosen], over[-1], faces, patch)[0] > 0.002).sum()
        alone_through += (outside(alone[-1][chosen], over[-1], faces, patch)[0] > 0.002).sum()
    assert covered > 100
    assert through < 0.03 * covered
    assert alone_through > 0.1 * covered


@pytest.mark.parametrize(("outer", "inner"), PAIRS)
def test_trouser_legs_keep_their_own_motion(body, outer, inner):
    moment = params(SIT, np.zeros(10))
    over, alone, under, _ = worn(body, outer, inner, moment)
    moved = np.linalg.norm(under - alone, axis=2)
    far = outside(alone[0], over[0], catalogue().geometry(outer).faces)[1] > 0.10
    assert far.sum() > 100
    np.testing.assert_array_equal(moved[:, far], 0)
    assert moved[0].max() < 0.02  # at rest it is tucked in, no more


@pytest.mark.parametrize(("outer", "inner"), PAIRS)
def test_the_pull_does_not_jump(body, outer, inner):
    """With sixteen times as many frames the largest step is several times smaller, in sharp folds too."""
    steps = []
    for frames in (21, 321):
        _, alone, under, hidden = worn(body, outer, inner, params(BEND, np.zeros(10), frames))
        steps.append(np.abs(np.diff(under - alone, axis=0))[:, ~hidden].max())
    assert steps[1] < max(steps[0] / 4, 0.004)


def test_what_hangs_keeps_its_place_in_the_cloth_when_that_is_carried_off_rigidly():
    rng = np.random.default_rng(0)
    x, y = np.meshgrid(np.linspace(0, 0.3, 7), np.linspace(0, 0.3, 7))
    cloth = np.stack([x.ravel(), y.ravel(), 0.05 * np.sin(9 * x.ravel())], axis=1)
    corner = np.array([7 * j + i for j in range(6) for i in range(6)])
    faces = np.stack([corner, corner + 1, corner + 8, corner + 7], axis=1).astype(np.int32)
    below = cloth[rng.choice(49, 12)] - [0, 0, 0.01]
    hooks = hang(faces, cloth, below)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    both = np.stack([cloth, cloth @ turn.T + [1, 2, 3]]).astype(np.float32)
    points, axes = hooks.frames(both)
    place = np.einsum("tmij,tmj->tmi", axes, np.stack([below, below @ turn.T + [1, 2, 3]]) - points)
    np.testing.assert_allclose(place[1], place[0], atol=2e-6)
    assert (place[0][:, 0] < -0.005).all()
    length = np.linalg.norm(axes, axis=-1)
    assert (length > 0.9).all()
    assert (length < 1 + 1e-5).all()
    across = axes @ axes.swapaxes(2, 3) / length[..., None] / length[..., None, :]
    np.testing.assert_allclose(across, np.tile(np.eye(3), (2, 12, 1, 1)), atol=1e-5)


@pytest.mark.parametrize("name", ["shorts", "track_shorts", "tee"])
def test_skin_below_a_hem_is_pushed_in_where_a_bend_brings_it_out(body, name):
    wardrobe, moment = catalogue(), params(SIT | {"spine1": (0.5, 0, 0)}, np.zeros(10))
    item, geometry = wardrobe.items[name], wardrobe.geometry(name)
    cloth = item_layer(wardrobe, name).pose(body, moment)
    kept = geometry.under & beside(body, ~geometry.hidden)
    assert kept.sum() > 20
    before = drawn_in(body, body.pose(moment).vertices, kept)
    after = before.copy()
    keep_below(wardrobe, body, [item], [cloth], after, kept)
    np.testing.assert_array_equal(after[:, ~kept], before[:, ~kept])
    patch = cKDTree(spread(cloth[0], geometry.faces)[0]).query(before[0][kept], k=30)[1]
    close = outside(before[0][kept], cloth[0], geometry.faces)[1] < 0.03
    out = [
        (outside(skin[-1][kept], cloth[-1], geometry.faces, patch)[0][close] > 0.002).sum()
        for skin in (before, after)
    ]
    assert out[1] <= min(out[0], 0.05 * close.sum())


@pytest.mark.parametrize("hat", ["fedora", "fedora_cocked"])
@pytest.mark.parametrize("hair", UNDER_HAT)
def test_hair_shows_below_the_brim_and_not_through_the_hat(body, hat, hair):
    wardrobe, names = catalogue(), (hat, hair)
    rest = [item_layer(wardrobe, name).rest(np.zeros(10)) for name in names]
    items = [wardrobe.items[name] for name in names]
    hidden = wear_all(wardrobe, items, rest, [vertices[None].copy() for vertices in rest])[1]
    faces = wardrobe.geometry(hair).corners
    kept = ~hidden[faces].all(axis=1)
    assert 0.1 < kept.mean() < 0.9
    shown = rest[1][np.unique(faces[kept])]
    crown = rest[0][:, 1].max()
    assert (shown[:, 1] < crown - 0.05).all()
    through, distance = outside(shown, rest[0], wardrobe.geometry(hat).faces)
    above_brim = shown[:, 1] > np.quantile(rest[0][:, 1], 0.5)
    assert ((through > 0.002) & (distance < 0.02) & above_brim).mean() < 0.01


def test_who_wears_a_hat_wears_short_hair_or_none():
    hats = [m for m in map(cast, range(120)) if any(w.item.startswith("fedora") for w in m.worn)]
    assert len(hats) > 3
    hair = [[w.item for w in m.worn if w.item.startswith("hair")] for m in hats]
    assert sum(bool(h) for h in hair) > len(hats) / 2
    assert all(item in UNDER_HAT for h in hair for item in h)
