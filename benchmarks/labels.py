"""How fast labels are made on one core: ``python -m benchmarks.labels``.

Times are CPU time of the calling thread, the best of several runs: contact between two people far apart,
near, holding hands, in an embrace, back to chest, crawling over one another and deep in each other; every
fifth frame of captured pairs, the embedded ones and those under ``--motions``; the rasteriser; and whole
sequences of two people. ``OPENBLAS_NUM_THREADS=1`` keeps BLAS on that thread, too.
"""

import argparse
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from camera_rigs import CameraPath
from whacamole.body import BodyModel, BodyParams
from whacamole.labels import (
    FrameImages,
    LabelledPerson,
    RasterMesh,
    label_sequence,
    model_parts,
    rasterize,
)
from whacamole.labels.patches import PosedSkin, SkinMap
from whacamole.labels.people import to_camera
from whacamole.labels.sequence import posed_frames
from whacamole.labels.skin import OuterSkin
from whacamole.labels.touch import Touch, touch
from whacamole.motion import embedded_motions, find_motions, read_motion
from whacamole.take.placing import body_params

FRAMES = 300


def person(x: float, y: float, turn: float, num_frames: int = 1) -> BodyParams:
    """Stands at (x, y), turned about the vertical, arms half down, swaying a little."""
    rest = BodyParams.zeros(num_frames)
    fields = {name: np.array(getattr(rest, name)) for name in BodyParams.__dataclass_fields__}
    half = turn / 2
    axis = np.array([np.cos(half), np.sin(half), np.sin(half)])  # upright, then turned
    axis /= np.linalg.norm(axis)
    fields["global_orient"][:] = axis * 2 * np.arccos(np.cos(np.pi / 4) * np.cos(half))
    fields["transl"][:] = [x, y + 0.351, 0.9625]
    fields["transl"][:, 0] += 0.02 * np.sin(np.arange(num_frames) / 5)
    fields["body_pose"][:, 15, 2], fields["body_pose"][:, 16, 2] = -0.8, 0.8
    return BodyParams(**fields)


def embracing(y: float, turn: float) -> BodyParams:
    """Stands at (0, y) with the arms around somebody before the chest."""
    fields = vars(person(0, y, turn)).copy()
    pose = np.zeros_like(fields["body_pose"])
    lift = 0.5 if turn else -0.2  # one's arms pass over the other's
    pose[:, 15], pose[:, 16] = [0, -1.15, lift], [0, 1.15, -lift]
    pose[:, 17], pose[:, 18] = [0, -1.0, 0], [0, 1.0, 0]
    return BodyParams(**{**fields, "body_pose": pose})


def crawling(model: BodyModel, frame: int, offset: tuple[float, float, float]) -> BodyParams:
    """A frame of the embedded crawl, moved [m]."""
    mover = read_motion(embedded_motions() / "crawl.npz").people[0]
    fields = vars(BodyParams.zeros(1)).copy()
    fields["global_orient"] = mover.global_orient[None, frame]
    fields["body_pose"] = mover.body_pose[None, frame]
    fields["transl"] = mover.pelvis[None, frame] - model.rest_joints(np.zeros(10))[0] + offset
    return BodyParams(**fields)


def best(work: Callable[[], object], runs: int = 15) -> float:
    """Least CPU time of several runs [ms]."""
    times = []
    for _ in range(runs):
        start = time.thread_time()
        work()
        times.append(time.thread_time() - start)
    return 1e3 * min(times)


Label = Callable[[np.ndarray, np.ndarray], tuple[Touch, Touch]]


def contact_of(model: BodyModel) -> Label:
    """What labels the contact of two people of a model, both directions, from their vertices."""
    parts = model_parts(model)
    skin = OuterSkin.build(model.v_template, model.faces)
    skin_map = SkinMap.build(skin, parts, model.v_template)

    def label(first: np.ndarray, other: np.ndarray) -> tuple[Touch, Touch]:
        skins = (PosedSkin(skin_map, skin.close(body)) for body in (first, other))
        return touch(*skins, len(parts.names), 0.01)

    return label


def contact(model: BodyModel, label: Label) -> None:
    """Two people, one frame."""
    upright = person(0, 0, 0)
    for name, one, two in (
        ("3 m apart", upright, person(0, 3.0, np.pi)),
        ("0.5 m apart", upright, person(0, 0.72, np.pi)),
        ("hand in hand", upright, person(0.95, 0, 0)),
        ("an embrace", embracing(0, 0), embracing(0.24, np.pi)),
        ("back to chest", upright, person(0, 0.245, 0)),
        ("crawling, a hand on a foot", crawling(model, 10, (0, 0, 0)), crawling(model, 45, (0.6, 0.1, 0))),
        ("crawling, one over the other", crawling(model, 10, (0, 0, 0)), crawling(model, 35, (0, 0, 0.28))),
        ("20 cm into each other", upright, person(0.1, 0.1, 0)),
    ):
        bodies = model.pose(one).vertices[0], model.pose(two).vertices[0]
        ours, theirs = label(*bodies)
        touching = int(ours.points.sum() + theirs.points.sum())
        gap = ours.distance.min()
        spent = best(partial(label, *bodies))
        print(f"contact, {name}: {spent:.1f} ms, {touching} vertices touch, least gap {gap:.3f} m")


def captured(model: BodyModel, label: Label, motions: Path) -> None:
    """Contact in the pairs of a folder, at the mean shape: mean, 95th percentile and worst frame."""
    for file in find_motions(motions):
        motion = read_motion(file)
        if not motion.interactive:
            continue
        hands = np.zeros((2, 15, 3))
        pair = [
            model.pose(body_params(person, model, np.zeros(10), hands, 1.0).slice(0, None, 5))
            for person in motion.people
        ]
        spent, gaps = [], []
        for bodies in zip(*(body.vertices for body in pair), strict=True):
            gaps.append(label(*bodies)[0].distance.min())
            spent.append(best(partial(label, *bodies), 3))
        middle, late, worst = np.mean(spent), np.percentile(spent, 95), np.max(spent)
        touching = np.mean(np.array(gaps) <= 0.01)
        print(
            f"contact, {motion.id}, {len(spent)} frames, {touching:.0%} touching, deepest "
            f"{max(0.0, -min(gaps)):.3f} m: mean {middle:.1f} ms, 95 % {late:.1f} ms, worst {worst:.1f} ms"
        )


def raster(model: BodyModel) -> None:
    """One body filling a 640 x 360 image."""
    body = model.pose(person(0, 0, 0)).vertices[0]
    view = np.array([[1, 0, 0, 0], [0, 0, -1, 0.9], [0, 1, 0, 2.0], [0, 0, 0, 1.0]])
    K = np.array([[360.0, 0, 320], [0, 360, 180], [0, 0, 1]])
    for cull in (False, True):
        mesh = RasterMesh(to_camera(body, view), model.faces, cull_back=cull)
        depth = best(lambda mesh=mesh: rasterize([mesh], K, 640, 360))
        print(f"raster, {len(model.faces)} triangles, {cull=}: {depth:.1f} ms")


def sequence(model: BodyModel) -> None:
    """Two people, labels of every kind, from parameters and images."""
    pose = np.tile(np.eye(4), (FRAMES, 1, 1))
    pose[:, :3, :3] = [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
    pose[:, :3, 3] = [0, -3.5, 1.0]
    K = np.tile([[400.0, 0, 320], [0, 400, 180], [0, 0, 1]], (FRAMES, 1, 1))
    camera = CameraPath(K, pose, 30.0, 640, 360)
    for name, gap in (("apart", 1.5), ("hand in hand", 0.95)):
        people = [
            LabelledPerson(1, "a", "neutral", person(-gap / 2, 0, 0, FRAMES)),
            LabelledPerson(2, "b", "neutral", person(gap / 2, 0, 0, FRAMES)),
        ]
        bodies = next(posed_frames(people, model))
        view = camera.T_camera_world[0]
        meshes = [RasterMesh(to_camera(body, view), model.faces) for body in bodies]
        drawn = rasterize(meshes, K[0], 640, 360)
        image = FrameImages((drawn.mesh + 1).astype(np.uint8), drawn.depth.astype(np.float32))

        def label(people: list[LabelledPerson] = people, image: FrameImages = image) -> object:
            return label_sequence(people, model, camera, lambda _: image)

        spent = best(label, 2)
        print(f"sequence, two people {name}, 640 x 360, {FRAMES} frames: {spent / 1e3:.1f} s")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--motions", type=Path, help="a folder with more captured pairs")
    options = parser.parse_args()
    body_model = BodyModel.embedded()
    labels = contact_of(body_model)
    contact(body_model, labels)
    for folder in (embedded_motions(), *([options.motions] if options.motions else [])):
        captured(body_model, labels, folder)
    raster(body_model)
    sequence(body_model)
