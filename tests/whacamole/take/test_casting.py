"""Who plays a part on a body that the wardrobe was not cut for: the path of a licensed SMPL-X file."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from scipy.spatial import cKDTree

from whacamole.body import BodyModel
from whacamole.errors import TakeError
from whacamole.motion import embedded_motions, read_motion
from whacamole.stage import Places
from whacamole.take import Take, stage_take
from whacamole.wardrobe import fits
from whacamole.wardrobe.shells import checked_textures


@pytest.fixture(scope="module")
def foreign(tmp_path_factory: pytest.TempPathFactory) -> BodyModel:
    """An SMPL-X file like the licensed one: other vertex numbers, other coordinates, none of our own keys."""
    folder = tmp_path_factory.mktemp("model")
    with np.load(BodyModel.embedded().export_full(folder / "own.npz")) as file:
        own = {key: file[key] for key in file.files}
    rng = np.random.default_rng(0)
    order = rng.permutation(len(own["v_template"]))
    number = np.argsort(order)
    arrays = {key: own[key] for key in ("kintree_table", "vt", "ft", "hands_meanl", "hands_meanr")}
    arrays |= {key: own[key][order] for key in ("v_template", "shapedirs", "posedirs", "weights")}
    arrays |= {"f": number[own["f"]].astype(np.uint32), "J_regressor": own["J_regressor"][:, order]}
    arrays["v_template"] += rng.normal(0, 1e-4, arrays["v_template"].shape).astype(np.float32)
    np.savez(folder / "SMPLX_FEMALE.npz", **arrays)
    return BodyModel.load(folder / "SMPLX_FEMALE.npz")


def take(body: BodyModel, folder: Path, uv_textures: Path | None = None) -> Take:
    motion = read_motion(embedded_motions() / "walk.npz")
    return stage_take(
        motion,
        body,
        frames=2,
        seed=3,
        shot_index=0,
        textures=folder,
        places=Places(("plaza",)),
        uv_textures=uv_textures,
    )


def test_another_body_is_dressed_from_its_own_surface(foreign: BodyModel, tmp_path: Path) -> None:
    assert not fits(foreign)
    assert foreign.sha256 != BodyModel.embedded().sha256
    (performer,) = take(foreign, tmp_path).performers
    parts = {mesh.name.removeprefix("person-1-"): mesh for mesh in performer.meshes}
    assert {"skin", "top", "bottom", "shoes"} <= set(parts)
    assert performer.role.gender == "female"  # as the file's name says
    body = performer.posed.vertices[1]
    for name in ("top", "bottom", "shoes"):
        gap = cKDTree(body).query(parts[name].vertices[1])[0]
        assert 0.002 < np.median(gap) < 0.03, name  # lifted off the skin, and near it
    # What is bare is the body of the labels.
    assert cKDTree(body).query(parts["skin"].vertices[1])[0].max() < 0.02
    assert parts["top"].material.base_color != parts["skin"].material.base_color


def test_pictures_of_a_folder_are_worn_on_the_models_own_uv_map(foreign: BodyModel, tmp_path: Path) -> None:
    pictures = tmp_path / "pictures"
    pictures.mkdir()
    Image.new("RGB", (8, 8), (200, 10, 10)).save(pictures / "suit.png")
    (performer,) = take(foreign, tmp_path / "made", pictures).performers
    (mesh,) = performer.meshes
    assert mesh.material.base_color_texture == pictures / "suit.png"
    np.testing.assert_allclose(mesh.vertices, performer.posed.vertices, atol=1e-6)
    assert mesh.uv is not None
    np.testing.assert_array_equal(mesh.uv, foreign.uv[foreign.uv_faces])


def test_a_folder_without_pictures_is_told_before_anything_is_made(
    foreign: BodyModel, tmp_path: Path
) -> None:
    with pytest.raises(TakeError, match="--textures"):
        checked_textures(foreign, tmp_path)
