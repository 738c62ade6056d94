"""People made of formulas, on whom cameras are planned: the truth about them is known."""

from types import SimpleNamespace

import numpy as np
import pytest

from camera_rigs import SCALES, Lens, SubjectTrack, World
from camera_rigs.joins import spans_between
from camera_rigs.path import aimed_path
from camera_rigs.rules import Evidence, Limits
from camera_rigs.scene import Scene, View

FPS = 30.0
HEIGHT = 1.75


def person(way, facing, height=HEIGHT, half_width=0.3, bounce=0.0):
    """Arrays of `SubjectTrack.from_people` for a person whose pelvis goes along `way` (T, 2)."""
    T = len(way)
    bob = bounce * np.sin(2.0 * np.pi * 2.0 * np.arange(T) / FPS)
    pelvis = np.column_stack([way, np.full(T, 0.55 * height) + bob])
    neck = pelvis + np.array([0.0, 0.0, 0.3 * height])
    azimuth = np.broadcast_to(facing, T)
    direction = np.column_stack([np.cos(azimuth), np.sin(azimuth), np.zeros(T)])
    low = np.column_stack([way - half_width, np.zeros(T)])
    high = np.column_stack([way + half_width, np.full(T, height)])
    return pelvis, neck, direction, low, high


def subject_of(*people):
    return SubjectTrack.from_people(*(np.stack(arrays) for arrays in zip(*people, strict=True)), FPS)


def stander(frames=90, **options):
    return subject_of(person(np.zeros((frames, 2)), 0.0, **options))


def walker(frames=90, speed=1.4, **options):
    way = np.column_stack([speed * np.arange(frames) / FPS, np.zeros(frames)])
    return subject_of(person(way, 0.0, **options))


def turner(frames=150, speed=1.4, radius=2.0):
    """Walks in a circle."""
    angle = speed / radius * np.arange(frames) / FPS
    way = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    return subject_of(person(way, angle + np.pi / 2.0))


def dancer(frames=150, sway=0.3, spin=0.0):
    time = np.arange(frames) / FPS
    way = sway * np.column_stack([np.sin(2.0 * np.pi * 0.4 * time), np.sin(2.0 * np.pi * 0.3 * time + 1.0)])
    return subject_of(person(way, spin * time, bounce=0.03))


def pair(frames=90, apart=1.4):
    left = np.tile([-apart / 2.0, 0.0], (frames, 1))
    return subject_of(person(left, 0.0), person(-left, np.pi))


def lens(width=640, height=360, millimetres=35.0):
    return Lens.from_millimetres(millimetres, width, height)


def view(scene, scale="full", frac=0.6, theta=85.0, phi=30.0):
    """A view that fills `frac` at the first frame; angles in degrees."""
    polar = float(np.radians(theta))
    r, _ = scene.framing(0, frac, polar, SCALES[scale], scene.lens.focal)
    return View(SCALES[scale], r, polar, float(np.radians(phi)), scene.lens.focal)


def whole(scene):
    """One span over all frames."""
    return spans_between([0, scene.last], scene.fps)[0]


def path_of(draft, scene):
    """The path of a draft that spans the whole clip."""
    move = draft.move
    return aimed_path(move.eye, move.target, move.focal, move.roll, scene.lens, scene.fps)


def evidence_of(draft, scene, **options):
    """What the rules see of a draft that spans the whole clip."""
    options = {"limits": Limits(), "world": scene.world, **options}
    path = options.pop("path", None) or path_of(draft, scene)
    shots = options.pop("shots", (draft.shot,))
    return Evidence(path, options.pop("subject", scene.subject), options.pop("world"), shots, **options)


@pytest.fixture(scope="session")
def rig():
    """The functions above."""
    return SimpleNamespace(
        person=person, subject_of=subject_of, stander=stander, walker=walker, turner=turner, dancer=dancer,
        pair=pair, lens=lens, view=view, whole=whole, path_of=path_of, evidence_of=evidence_of,
        scene=lambda subject, **options: Scene(subject, options.pop("lens", lens()), World(**options)),
        fps=FPS, height=HEIGHT,
    )  # fmt: skip
