"""Locks over a shell of hair, on a dome whose picture has known strands."""

import numpy as np
import pytest
from open_people.strands import EDGE, OVERHANG, Style, grow

RADIUS, RINGS, SPOKES = 0.1, 16, 48
STYLE = Style(200, lift=0.002, tangle=0.0)


def dome(strands):
    """A half ball: u goes round it, v from the crown (1) to the rim (0); strands are light and dark lines
    along ``strands``, "v" or "u"."""
    v, u = np.meshgrid(np.linspace(1, 0, RINGS), np.linspace(0, 1, SPOKES), indexing="ij")
    down, round_ = (1 - v) * np.pi / 2 * 0.95 + 0.07, 2 * np.pi * u
    vertices = RADIUS * np.stack(
        [np.sin(down) * np.cos(round_), np.cos(down), np.sin(down) * np.sin(round_)], axis=-1
    )
    a = (np.arange(RINGS - 1)[:, None] * SPOKES + np.arange(SPOKES - 1)).ravel()
    faces = np.stack([a, a + 1, a + SPOKES + 1, a + SPOKES], axis=1)
    uv = np.stack([u, v], axis=-1).reshape(-1, 2)
    wave = 128 + 100 * np.sin(np.arange(256) * 2 * np.pi / 8)
    light = (
        np.broadcast_to(wave, (256, 256)) if strands == "v" else np.broadcast_to(wave[:, None], (256, 256))
    )
    pixels = np.dstack([light, light, light, np.full((256, 256), 255.0)])
    return vertices.reshape(-1, 3), faces, uv, faces, pixels


def lines(locks):
    """(locks, sections) middle line of each."""
    rails = locks.vertices.reshape(STYLE.count, -1, 3)
    return np.concatenate([(rails[:, 0:-1:2] + rails[:, 1:-1:2]) / 2, rails[:, -1:]], axis=1)


@pytest.mark.parametrize("strands", ["v", "u"])
def test_locks_run_along_the_painted_strands(strands):
    line = lines(grow(STYLE, *dome(strands)))
    way = line[:, 1] - line[:, 0]
    at = line[:, 0]
    round_ = np.stack([-at[:, 2], 0 * at[:, 0], at[:, 0]], axis=1)
    round_ /= np.linalg.norm(round_, axis=1, keepdims=True)
    across = np.abs((way * round_).sum(axis=1)) / np.linalg.norm(way, axis=1)
    # Tufts bend them by up to a quarter of a radian.
    assert (np.median(across) < 0.3) if strands == "v" else (np.median(across) > 0.9)
    if strands == "v":  # from the crown, not to it
        assert (way[:, 1] < 0.002).mean() > 0.95


def test_locks_start_in_the_shell_and_lift_off_it_but_not_far():
    line = lines(grow(STYLE, *dome("v")))
    height = np.linalg.norm(line, axis=-1) - RADIUS
    assert (height[:, 0] < 0).all()
    over = line[:, -1, 1] > 0.01  # has not left over the rim
    assert over.mean() > 0.4
    assert (height[over, -1] > 0).mean() > 0.95
    assert height.max() < 4 * STYLE.lift + 0.003
    assert line[..., 1].min() > RADIUS * np.cos(np.pi / 2 * 0.95 + 0.07) - OVERHANG - EDGE - 4 * STYLE.lift


def test_every_lock_wears_the_picture_of_its_root_and_hangs_on_a_vertex_beside_it():
    vertices, faces, uv, uv_faces, pixels = dome("v")
    pixels[:128, :, 3] = 0.0  # v above one half is cut away
    locks = grow(STYLE, vertices, faces, uv, uv_faces, pixels)
    assert locks.uv[:, 1].max() < 0.5
    assert locks.faces.max() == len(locks.vertices) - 1
    spacing = RADIUS * np.pi / 2 / RINGS
    apart = np.linalg.norm(locks.vertices - vertices[locks.carrier], axis=1)
    assert apart.max() < spacing + OVERHANG + 4 * STYLE.lift + STYLE.width
    again = grow(STYLE, vertices, faces, uv, uv_faces, pixels)
    np.testing.assert_array_equal(again.vertices, locks.vertices)
