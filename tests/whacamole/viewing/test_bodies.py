"""What the viewer draws is what the labels say."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from whacamole.body import BodyModel
from whacamole.dataset import Dataset
from whacamole.errors import DatasetError, EvaluationError
from whacamole.viewing.bodies import actors_of, contact_points, model_for
from whacamole.viewing.prediction import read_prediction
from whacamole.viewing.thinning import CELL, thinned_surface


def test_an_actor_stands_where_the_joints_are_labelled(dataset: Dataset) -> None:
    sequence = dataset["duet-00"]
    actors = actors_of(sequence, model_for(sequence, None))
    assert [actor.track_id for actor in actors] == sequence.people["track_id"].tolist()
    for number, actor in enumerate(actors):
        np.testing.assert_allclose(actor.pelvis(), sequence.people["joints_world"][number, :, 0], atol=1e-5)
        whole = actor.model.pose(actor.params).vertices
        np.testing.assert_array_equal(actor.vertices(2), whole[2])


def test_the_thinned_surface_keeps_vertices_and_shape() -> None:
    model = BodyModel.embedded()
    thin = thinned_surface(model)
    assert 0.15 < len(thin.vertices) / model.num_vertices < 0.45
    assert thin.faces.max() == len(thin.vertices) - 1
    rest = model.v_template
    far, _ = cKDTree(rest[thin.vertices]).query(rest)
    assert far.max() < 2 * CELL
    a, b, c = rest[thin.vertices][thin.faces].transpose(1, 0, 2)
    thin_area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    a, b, c = rest[model.faces].transpose(1, 0, 2)
    outer = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    assert 0.8 < thin_area / outer < 1.02
    longest = np.linalg.norm(
        rest[thin.vertices][thin.faces] - rest[thin.vertices][np.roll(thin.faces, 1, 1)], axis=2
    )
    assert longest.max() < 5 * CELL  # no triangle bridges two limbs


def test_contact_points_are_the_marked_vertices(dataset: Dataset) -> None:
    sequence = dataset["duet-00"]
    model = model_for(sequence, None)
    posed = [actor.vertices(1) for actor in actors_of(sequence, model)]
    found = contact_points(sequence.contact, posed, 1)
    marked = sum(
        int(np.unpackbits(sequence.contact["vertex_contact"][number, 1])[: model.num_vertices].sum())
        for number in range(2)
    )
    assert len(found.ground) + len(found.person) == marked
    assert (found.ground[:, 2] <= sequence.contact["ground_threshold"]).all()


def test_labels_of_another_body_are_refused(dataset: Dataset, tmp_path: Path) -> None:
    sequence = dataset["walk-00"]
    other = dict(sequence.people) | {"body_model_sha256": np.array("0" * 64), "body_model": np.array("SMPLX")}
    object.__setattr__(sequence, "people", other)
    with pytest.raises(DatasetError, match=r"SMPLX.*--body-model"):
        model_for(sequence, None)


def _moved(dataset: Dataset, folder: Path, *, camera: bool) -> np.ndarray:
    """Write the truth of walk-00, all of it moved rigidly, as a prediction; return the move."""
    sequence = dataset["walk-00"]
    move = np.eye(4)
    move[:3, :3] = Rotation.from_rotvec([0.3, -1.2, 0.5]).as_matrix()
    move[:3, 3] = [5.0, -2.0, 7.0]
    actor = actors_of(sequence, model_for(sequence, None))[0]
    pelvis = actor.model.rest_joints(actor.params.betas)[0]
    arrays = {key: value[None] for key, value in actor.params.transformed(move, pelvis).to_arrays().items()}
    arrays |= {"frame_index": sequence.camera["frame_index"], "method": np.array("<b>moved</b>")}
    if camera:
        arrays["T_world_camera"] = move @ sequence.camera["T_world_camera"]
    folder.mkdir()
    np.savez(folder / "walk-00.npz", **arrays)
    return move


def test_a_moved_truth_comes_back(dataset: Dataset, tmp_path: Path) -> None:
    sequence = dataset["walk-00"]
    model = model_for(sequence, None)
    move = _moved(dataset, tmp_path / "pred", camera=True)
    true = actors_of(sequence, model)[0].vertices(2)
    back = read_prediction(tmp_path / "pred", sequence, model, "camera")
    np.testing.assert_allclose(back.actors[0].vertices(2), true, atol=1e-5)
    np.testing.assert_allclose(back.T_world_camera, sequence.camera["T_world_camera"], atol=1e-9)
    assert "unscaled" in back.notes[0]
    stored = read_prediction(tmp_path / "pred", sequence, model, "stored")
    np.testing.assert_allclose(stored.actors[0].vertices(2), true @ move[:3, :3].T + move[:3, 3], atol=1e-5)


def test_without_a_camera_it_stands_as_stored_and_says_so(dataset: Dataset, tmp_path: Path) -> None:
    sequence = dataset["walk-00"]
    _moved(dataset, tmp_path / "pred", camera=False)
    found = read_prediction(tmp_path / "pred", sequence, model_for(sequence, None), "camera")
    assert "no camera to align by" in found.notes[0]


def test_a_missing_prediction_is_one_line(dataset: Dataset, tmp_path: Path) -> None:
    sequence = dataset["walk-00"]
    with pytest.raises(EvaluationError, match="no prediction for walk-00"):
        read_prediction(tmp_path, sequence, model_for(sequence, None), "camera")
