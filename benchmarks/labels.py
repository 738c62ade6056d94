"""How fast labels are made on one core: ``python benchmarks/labels.py``.

Times are CPU time, the best of several runs: contact between two people far apart, near, holding hands, back
to chest and deep in each other; the rasteriser; and whole sequences of two people.
"""

import time
from collections.abc import Callable

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
    silhouette,
)
from whacamole.labels.patches import PosedSkin, SkinMap
from whacamole.labels.people import to_camera
from whacamole.labels.sequence import posed_frames
from whacamole.labels.skin import OuterSkin
from whacamole.labels.touch import touch

FRAMES = 30


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


def best(work: Callable[[], object], runs: int = 15) -> float:
    """Least CPU time of several runs [ms]."""
    times = []
    for _ in range(runs):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return 1e3 * min(times)


def contact(model: BodyModel) -> None:
    """Two people, one frame, both directions, from vertices to labels."""
    parts = model_parts(model)
    skin = OuterSkin.build(model.v_template, model.faces)
    skin_map = SkinMap.build(skin, parts, model.v_template)
    first = model.pose(person(0, 0, 0)).vertices[0]
    for name, second in (
        ("3 m apart", person(0, 3.0, np.pi)),
        ("0.5 m apart", person(0, 0.72, np.pi)),
        ("hand in hand", person(0.95, 0, 0)),
        ("back to chest", person(0, 0.245, 0)),
        ("20 cm into each other", person(0.1, 0.1, 0)),
    ):
        other = model.pose(second).vertices[0]

        def label(other: np.ndarray = other) -> object:
            skins = (PosedSkin(skin_map, skin.close(body)) for body in (first, other))
            return touch(*skins, len(parts.names), 0.01)

        one, two = label()
        touching = int(one.points.sum() + two.points.sum())
        gap = one.distance.min()
        print(f"contact, {name}: {best(label):.1f} ms, {touching} vertices touch, least gap {gap:.3f} m")


def raster(model: BodyModel) -> None:
    """One body filling a 640 x 360 image."""
    body = model.pose(person(0, 0, 0)).vertices[0]
    view = np.array([[1, 0, 0, 0], [0, 0, -1, 0.9], [0, 1, 0, 2.0], [0, 0, 0, 1.0]])
    K = np.array([[360.0, 0, 320], [0, 360, 180], [0, 0, 1]])
    for cull in (False, True):
        mesh = RasterMesh(to_camera(body, view), model.faces, cull_back=cull)
        depth = best(lambda mesh=mesh: rasterize([mesh], K, 640, 360))
        outline = best(lambda mesh=mesh: silhouette([mesh], K, 640, 360))
        print(f"raster, {len(model.faces)} triangles, {cull=}: {depth:.1f} ms, silhouette {outline:.1f} ms")


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

        spent = best(label, 3) / FRAMES
        print(f"sequence, two people {name}, 640 x 360: {spent:.1f} ms a frame, {0.3 * spent:.1f} s for 300")


if __name__ == "__main__":
    body_model = BodyModel.embedded()
    contact(body_model)
    raster(body_model)
    sequence(body_model)
