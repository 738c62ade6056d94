"""A whole sequence scored by the evaluator and by loops written from the definitions, protocol by protocol.

Nothing of the evaluator but the readers' record types is used on the other side: the alignment is Horn's by
quaternions, segments are cut by hand, joints come from the body model itself.
"""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

from whacamole.body import BodyModel, BodyParams
from whacamole.evaluation import (
    PROTOCOLS,
    Bodies,
    CameraTrack,
    PersonTrack,
    Placement,
    Recording,
    pooled,
    score_recording,
)

T, GAP, FPS = 230, range(90, 110), 25.0
SMPL24 = (*range(22), 28, 43)


def horn(source, target, with_scale=True):
    """Scale, rotation, translation by the largest eigenvector of Horn's matrix (JOSA A 1987)."""
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    S = a.T @ b
    delta = np.array([S[1, 2] - S[2, 1], S[2, 0] - S[0, 2], S[0, 1] - S[1, 0]])
    N = np.block([[np.trace(S), delta], [delta[:, None], S + S.T - np.trace(S) * np.eye(3)]])
    w, x, y, z = np.linalg.eigh(N)[1][:, -1]
    R = Rotation.from_quat([x, y, z, w]).as_matrix()
    s = np.sum(b * (a @ R.T)) / np.sum(a**2) if with_scale else 1.0
    return s, R, target.mean(axis=0) - s * R @ source.mean(axis=0)


def moved(points, found):
    s, R, t = found
    return s * points @ R.T + t


def error(a, b):
    return 1000 * np.linalg.norm(a - b, axis=-1)


def curve(rng, *shape):
    """Smooth along the first axis."""
    return gaussian_filter1d(rng.normal(size=(T, *shape)), 8, axis=0) * 4


def path(rng):
    return np.cumsum(0.02 * curve(rng, 3), axis=0) + 0.001 * rng.normal(size=(T, 3))


class Made:
    """A person in front of a moving camera: somebody new, or a prediction of somebody (``like``)."""

    def __init__(self, rng, like=None):
        new = like is None
        self.betas = np.tile(rng.normal(size=10), (T, 1))
        self.body, self.orient = 0.2 * curve(rng, 21, 3), 0.3 * curve(rng, 3)
        self.transl, turn = path(rng), 0.2 * curve(rng, 3)
        centre = path(rng) - np.array([0.0, 0.0, 5.0])
        if not new:
            self.betas = like.betas + 0.3 * rng.normal(size=(T, 10))
            self.body, self.orient = like.body + 0.1 * self.body, like.orient + 0.1 * self.orient
            self.transl, turn = 1.1 * like.transl + 0.2 * self.transl + 1.0, like.turn + 0.1 * turn
            centre = 0.8 * like.T[:, :3, 3] + 0.1 * centre
        self.turn, self.T = turn, np.tile(np.eye(4), (T, 1, 1))
        self.T[:, :3, :3], self.T[:, :3, 3] = Rotation.from_rotvec(turn).as_matrix(), centre
        source = self if new else like
        pelvis = BodyModel.embedded().rest_joints(source.betas)[:, 0]
        seen = source.params().transformed(np.linalg.inv(source.T), pelvis)
        self.orient_camera, self.transl_camera = seen.global_orient, seen.transl
        if not new:
            self.orient_camera = seen.global_orient + 0.02 * curve(rng, 3)
            self.transl_camera = seen.transl + 0.05 * curve(rng, 3)
        self.valid = np.ones(T, bool)

    def params(self, betas=None, space="world"):
        zero = BodyParams.zeros(T)
        rest = (zero.left_hand_pose, zero.right_hand_pose, zero.jaw_pose, zero.leye_pose, zero.reye_pose)
        root = (self.orient, self.transl) if space == "world" else (self.orient_camera, self.transl_camera)
        return BodyParams(self.betas if betas is None else betas, zero.expression, *root, self.body, *rest)

    def recording(self):
        person = PersonTrack(
            1, "smplx", self.betas, self.body, self.valid, Placement(self.orient, self.transl),
            Placement(self.orient_camera, self.transl_camera), model_sha256=BodyModel.embedded().sha256,
        )  # fmt: skip
        return Recording("seq", np.arange(T), FPS, (person,), CameraTrack(self.T, np.ones(T, bool)))


@pytest.fixture(scope="module")
def both():
    rng = np.random.default_rng(3)
    truth = Made(rng)
    prediction = Made(rng, truth)
    prediction.valid[list(GAP)] = False
    return truth, prediction


def cuts(name, kept):
    """Rows of each segment, counted among those kept; by hand for 230 frames without 20 in the middle."""
    n = len(kept)
    assert n == 210
    if name == "whac":  # frames keep their time: 0 … 99, 100 … 199, 200 … 229
        return [np.flatnonzero((kept >= a) & (kept < b)) for a, b in ((0, 100), (100, 200), (200, 230))]
    ranges = {"tram": [(0, 100), (100, 209)], "bedlam2": [(0, 210)]}
    return [np.arange(a, b) for a, b in ranges.get(name, [(0, 100), (100, 200), (200, 210)])]


@pytest.mark.parametrize("name", PROTOCOLS)
def test_the_numbers_are_those_of_loops(both, name):
    truth, guess = both
    kept = np.flatnonzero(guess.valid)
    model, choice = BodyModel.embedded(), name in ("whac", "bedlam2")
    joints = list(range(22)) if choice else list(SMPL24)
    mean = guess.betas[kept].mean(axis=0) if name == "tram" else None
    world, camera = (
        [model.pose_joints(side.params(betas, space))[kept] for side, betas in ((truth, None), (guess, mean))]
        for space in ("world", "camera")
    )
    orient = [Rotation.from_rotvec(side.orient[kept]).as_matrix() for side in both]
    if name == "tram":  # σ = 3 over the root's path in the world
        root = world[1][:, 0].copy()
        world[1] = world[1] + (gaussian_filter1d(root, 3, axis=0) - root)[:, None]
    roots = [points[:, 0] for points in world]
    world = [points[:, joints] for points in world]
    camera = [points[:, joints] for points in camera]
    centre = [p[:, 0] if name == "whac" else p[:, 1:3].mean(axis=1) for p in camera]
    ours, theirs = (p - c[:, None] for p, c in zip(camera, centre, strict=True))
    expected = {
        "mpjpe": error(theirs, ours).mean(),
        "t_mpjpe": error(camera[1], camera[0]).mean(),
        "pa_mpjpe": np.mean([error(moved(b, horn(b, a)), a).mean() for a, b in zip(*camera, strict=True)]),
    }
    for key, first in (("w_mpjpe", 2), ("wa_mpjpe", None), ("w_mpjpe_rigid", 2), ("wa_mpjpe_rigid", None)):
        frames = []
        for rows in cuts(name, kept):
            fit = rows[:first]
            found = horn(
                world[1][fit].reshape(-1, 3), world[0][fit].reshape(-1, 3), not key.endswith("rigid")
            )
            frames += [error(moved(world[1][i], found), world[0][i]).mean() for i in rows]
        expected[key] = np.mean(frames)
    near = np.diff(kept) == 1 if name == "whac" else np.ones(len(kept) - 1, bool)  # the others close the gap
    fps = FPS if name == "whac" else 30.0
    second = [np.diff(side, 2, axis=0) * fps**2 for side in (ours, theirs)]
    values = np.linalg.norm(second[1] - second[0], axis=-1).mean(axis=-1)[near[1:] & near[:-1]]
    expected["accel"] = (values[1:-1] if name in ("wham", "tram") else values).mean()
    third = np.linalg.norm(np.diff(world[1], 3, axis=0), axis=-1) * fps**3 / 10
    if name == "emdb":
        third[:, [0, 7, 8, 10, 11, 20, 21, 22, 23]] = 0
    expected["jitter"] = third.mean(axis=-1)[near[2:] & near[1:-1] & near[:-2]].mean()
    steps = [np.diff(r, axis=0) for r in roots]
    turned = np.einsum("tij,tkj,tk->ti", orient[0][:-1], orient[1][:-1], steps[1])
    expected["erve"] = error(turned, steps[0])[near].mean()
    ends = [side.transl[kept] for side in both] if name == "wham" else roots
    length = np.linalg.norm(np.diff(ends[0], axis=0), axis=-1).sum()
    expected["rte"] = error(moved(ends[1], horn(ends[1], ends[0], False)), ends[0]).mean() / length / 10
    found = horn(roots[1], roots[0])
    expected |= {"h_ate": error(moved(roots[1], found), roots[0]).mean(), "h_as": found[0]}
    centres = [side.T[:, :3, 3] for side in both]
    found, rigid = horn(centres[1], centres[0]), horn(centres[1], centres[0], False)
    expected |= {"c_ate": error(moved(centres[1], found), centres[0]).mean(), "c_as": found[0]}
    expected["c_ate_rigid"] = error(moved(centres[1], rigid), centres[0]).mean()
    score = score_recording(truth.recording(), guess.recording(), name, Bodies(vertices=False))
    for key, value in expected.items():
        assert pooled([score], key) == pytest.approx(value, rel=1e-9), key
