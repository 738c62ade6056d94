"""A lone person in full view is seen whole, whatever the hair: labels cut cards of hair as renderers do."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from camera_rigs import CameraPath, look_at
from render_jobs import PASSES, Lamp, Mesh, RenderJob, quality_preset, run_job
from render_jobs.images import read_exr
from whacamole.body import BodyModel, BodyParams
from whacamole.labels import FrameImages, LabelledPerson, label_sequence
from whacamole.labels.people import WorldMesh
from whacamole.production.labelling import worn_over
from whacamole.wardrobe import cast
from whacamole.wardrobe.cast import Worn
from whacamole.wardrobe.dress import dress

T, SIDE = 4, 320
ENGINES = ("raster", pytest.param("cycles", marks=[pytest.mark.blender, pytest.mark.slow]))


def _around_the_head() -> CameraPath:
    """The head from before, from the side and from behind, then the whole body."""
    head = np.array([0.0, -0.35, 1.55])
    turn = np.deg2rad([0.0, 80.0, 190.0, 20.0])
    eyes = head + 2.0 * np.stack([np.sin(turn), -np.cos(turn), np.full(T, 0.05)], axis=1)
    targets = np.array([head, head, head, [0.0, -0.35, 1.0]])
    K = np.tile([[480.0, 0, SIDE / 2], [0, 480.0, SIDE / 2], [0, 0, 1]], (T, 1, 1))
    K[3, :2, :2] *= 0.5
    poses = np.stack([look_at(eye, target) for eye, target in zip(eyes, targets, strict=True)])
    return CameraPath(K, poses, 30.0, SIDE, SIDE)


def _alone(hair: str, textures: Path) -> tuple[BodyParams, list[Mesh]]:
    frames = T + 2
    standing = {"global_orient": [np.pi / 2, 0, 0], "transl": [0, 0, 0.9625]}
    params = replace(
        BodyParams.zeros(frames), **{name: np.tile(value, (frames, 1)) for name, value in standing.items()}
    )
    member = cast(1)
    others = tuple(worn for worn in member.worn if not worn.item.startswith("hair"))
    member = replace(member, worn=(*others, Worn(hair)))
    return params.slice(1, T + 1), dress(member, BodyModel.embedded(), params, textures=textures)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("hair", ["hair_afro", "hair_long"])
def test_alone_and_in_view_is_seen_whole(engine: str, hair: str, tmp_path: Path) -> None:
    path = _around_the_head()
    params, meshes = _alone(hair, tmp_path / "textures")
    RenderJob(
        camera=path,
        meshes=tuple(meshes),
        lights=(Lamp(position=(0.0, -3.0, 3.0), target=(0.0, 0.0, 1.0)),),
        quality=quality_preset("draft"),
        passes=("rgb", "mask", "depth"),
    ).save(tmp_path / "job")
    run_job(tmp_path / "job", engine=engine)

    def images(frame: int) -> FrameImages:
        mask, depth = (tmp_path / "job" / "out" / PASSES[name].file(frame) for name in ("mask", "depth"))
        return FrameImages(np.asarray(Image.open(mask)), read_exr(depth)["Z"])

    worn = worn_over(meshes)
    assert worn is not None
    uncut = lambda frame: [WorldMesh(mesh.vertices, mesh.faces) for mesh in worn(frame)]  # noqa: E731
    with_hair, with_cards = (
        label_sequence([LabelledPerson(1, "a", "neutral", params, each)], BodyModel.embedded(), path, images)
        for each in (worn, uncut)
    )
    seen = with_hair.people["visible_fraction"][0]
    assert seen.min() >= 0.995
    box, pixels = (with_hair.people[name][0, 3] for name in ("bbox_xyxy", "bbox_visible_xyxy"))
    np.testing.assert_allclose(box, pixels, atol=1.1)
    if hair == "hair_afro":  # the cards reach far into the air
        assert (1 - with_cards.people["visible_fraction"][0]).sum() > 2 * (1 - seen).sum()
        assert with_cards.people["bbox_xyxy"][0, 0, 1] <= with_hair.people["bbox_xyxy"][0, 0, 1]
