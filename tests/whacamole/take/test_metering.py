"""The light meter against the closed forms of photometry, and what it does to the exposure."""

from pathlib import Path

import numpy as np
import pytest

from camera_rigs import Obstacle, World
from render_jobs import Environment, Lamp, Sun
from whacamole.body import JOINT_INDEX, BodyModel
from whacamole.motion import embedded_motions, read_motion
from whacamole.stage import Places, Stage
from whacamole.take import stage_take
from whacamole.take.metering import CEILING, FLOOR, MOST_STOPS, face_irradiance, face_stops, metered

DARK = Environment(color=(0.0, 0.0, 0.0))
SPREAD = (1.0 + 2.0 * np.cos(np.radians(40.0))) / 3.0
"""Light from straight ahead falls on the front and on two cheeks, 40° aside."""


def stage(*lights, environment=DARK, obstacles=(), exposure=0.0):
    return Stage("test", (), lights, environment, exposure, World(obstacles=obstacles))


def head(facing=0.0):
    """The joints (1, 55, 3) of somebody at the origin whose face, 1.6 m up, looks along the azimuth [rad]."""
    joints = np.zeros((1, 55, 3))
    x, y = -0.03 * np.sin(facing), 0.03 * np.cos(facing)
    joints[:, JOINT_INDEX["neck"]] = [0.0, 0.0, 1.4]
    joints[:, JOINT_INDEX["head"]] = [0.0, 0.0, 1.5]
    joints[:, JOINT_INDEX["left_eye"]] = [x, y, 1.6]
    joints[:, JOINT_INDEX["right_eye"]] = [-x, -y, 1.6]
    return joints


def test_a_sun_ahead_a_sun_behind_and_a_wall_before_it():
    ahead = Sun(direction=(-1.0, 0.0, 0.0), strength=3.0)
    assert face_irradiance(stage(ahead), head())[0] == pytest.approx(3.0 * SPREAD)
    assert face_irradiance(stage(ahead), head(np.pi))[0] == pytest.approx(0.0, abs=1e-9)
    wall = Obstacle((5.0, 0.0, 2.0), (0.2, 4.0, 4.0))
    assert face_irradiance(stage(ahead, obstacles=(wall,)), head())[0] == pytest.approx(0.0, abs=1e-9)


def test_lamps_follow_the_inverse_square():
    """A disc of P watts sends P / π per steradian along its axis, a bulb P / 4π in every direction."""
    face = (0.08, 0.0, 1.6)
    for distance in (2.0, 4.0):
        place = (0.08 + distance, 0.0, 1.6)
        for kind, share in (("area", 1.0 / np.pi), ("point", 0.25 / np.pi), ("spot", 0.25 / np.pi)):
            lamp = Lamp(kind=kind, position=place, target=face, power_w=100.0, size=0.3)
            expected = 100.0 * share / distance**2 * SPREAD
            assert face_irradiance(stage(lamp), head())[0] == pytest.approx(expected), kind
            away = lamp.model_copy(update={"target": (9.08, 0.0, 1.6)})
            expected = expected if kind == "point" else 0.0
            assert face_irradiance(stage(away), head())[0] == pytest.approx(expected, abs=1e-9), kind


def test_half_of_an_even_sky_falls_on_a_face_and_a_turned_map_turns_with_it():
    white = Environment(color=(1.0, 1.0, 1.0), strength=0.5)
    assert face_irradiance(stage(environment=white), head())[0] == pytest.approx(0.25 * np.pi)
    sunrise = Environment(kind="hdri", hdri="sunrise", strength=1.2)
    turned = sunrise.model_copy(update={"rotation": 70.0})
    one = face_irradiance(stage(environment=sunrise), head(0.3))
    other = face_irradiance(stage(environment=turned), head(0.3 + np.radians(70.0)))
    np.testing.assert_allclose(one, other)


def test_the_darkest_face_is_lifted_to_the_floor_and_a_bright_one_left():
    day = stage(Sun(direction=(-1.0, 0.0, 0.0), strength=2.0))
    assert face_stops(day, [head()], [0.3]) == 0.0
    dusk = stage(Sun(direction=(-1.0, 0.0, 0.0), strength=0.5))
    stops = face_stops(dusk, [head()], [0.3])
    assert 0.5 / np.pi * 0.3 * SPREAD * 2.0**stops == pytest.approx(FLOOR)
    assert face_stops(stage(), [head()], [0.3]) == MOST_STOPS
    # With somebody in the full light beside, the darker one is lifted no further than that one bears.
    lit = stage(Sun(direction=(-1.0, 0.0, 0.0), strength=6.0))
    stops = face_stops(lit, [head(), head(np.pi)], [0.3, 0.3])
    assert 6.0 / np.pi * 0.3 * SPREAD * 2.0**stops == pytest.approx(CEILING)


def test_what_a_skin_needs_is_added_to_the_stage_s_own_exposure():
    dim = stage(Sun(direction=(-1.0, 0.0, 0.0), strength=0.9), exposure=0.5)
    light, dark = (metered(dim, [head()], [tone]).exposure for tone in (0.0, 0.9))
    assert light == 0.5
    assert 0.5 < dark <= 1.5


def test_a_take_is_exposed_the_same_whether_it_is_planned_or_filmed(tmp_path: Path):
    motion = read_motion(embedded_motions() / "walk.npz")
    takes = [
        stage_take(motion, BodyModel.embedded(), frames=2, seed=3, shot_index=0, textures=textures,
                   places=Places(names=("plaza",)))
        for textures in (None, tmp_path)
    ]  # fmt: skip
    assert takes[0].stage.exposure == takes[1].stage.exposure
