"""Planted faults of the contacts, by the 21 parts and by a region file of the user's own."""

import json
from pathlib import Path

import numpy as np
import pytest

from planted_faults import audit, change, labels, load
from whacamole.body import BodyModel, BodyParams
from whacamole.check import check_dataset
from whacamole.dataset import SequenceLayout
from whacamole.dataset.files import write_arrays
from whacamole.errors import BodyModelError
from whacamole.labels import ContactLabels, LabelledPerson, read_regions
from whacamole.labels.sequence import posed_frames


def test_contact_that_does_not_follow(dataset, sequence):
    contact = load(sequence.contact)
    change(
        sequence.contact,
        ground_contact=~contact["ground_contact"],
        person_distance=contact["person_distance"] - np.float32(0.05),
        vertex_contact=np.zeros_like(contact["vertex_contact"]) + 255,
    )
    found = labels(audit(dataset))
    assert {"contact.ground_contact", "contact.vertex_contact"} <= found


@pytest.fixture(scope="session")
def own_regions(tmp_path_factory) -> Path:
    """A region file: the embedded body in seven slices from foot to head, the last vertices in none."""
    height = BodyModel.embedded().v_template[:13000, 1]
    slice_of = np.digitize(height, np.linspace(height.min(), height.max(), 8)[1:-1])
    file = tmp_path_factory.mktemp("regions") / "slices.json"
    file.write_text(json.dumps({f"slice {k}": np.flatnonzero(slice_of == k).tolist() for k in range(7)}))
    return file


@pytest.fixture
def by_region(dataset: Path, sequence: SequenceLayout, own_regions: Path) -> dict[str, np.ndarray]:
    """The contacts of the dataset, labelled anew by the region file."""
    people, camera, model = load(sequence.people), load(sequence.camera), BodyModel.embedded()
    params = [BodyParams.from_arrays(people, "world", number) for number in range(2)]
    cast = [LabelledPerson(number, "stroll", "neutral", each) for number, each in enumerate(params, 1)]
    bodies = list(posed_frames(cast, model))
    parts = read_regions(own_regions, model.num_vertices)
    made = ContactLabels(model, 2, len(bodies), float(camera["fps"]), parts=parts, self_contact=True)
    for frame, now in enumerate(bodies):
        after = bodies[frame + 1] if frame + 1 < len(bodies) else None
        made.add(frame, bodies[frame - 1] if frame else None, now, after)
    contact = made.arrays()
    write_arrays(sequence.contact, contact)
    return contact


def test_contact_by_regions_of_the_users_own(dataset, sequence, by_region):
    """Without the region file the body as a whole is held against its labels, and the audit says so."""
    found = audit(dataset)
    assert found.ok
    assert "--contact-regions" in found.lines()[0]
    change(sequence.contact, ground_distance=by_region["ground_distance"] + np.float32(0.01))
    assert labels(audit(dataset)) == {"contact.ground_distance"}
    part = by_region["person_contact_part"].copy()
    part[0, 1, 3, 2] = 1 if part[0, 1, 3, 2] < 0 else -1
    write_arrays(sequence.contact, by_region | {"person_contact_part": part})
    assert labels(audit(dataset)) == {"contact.person_contact_part"}


REGION_FAULTS = {
    "ground_distance": lambda gap: gap + np.float32(0.01) * (np.arange(8) == 5),
    "ground_contact": lambda touch: touch ^ (np.arange(8) == 6),
    "self_contact": lambda touch: touch ^ np.outer(np.arange(8) == 6, np.arange(8) == 0),
}


@pytest.mark.parametrize("name", REGION_FAULTS)
def test_faults_of_single_regions(dataset, sequence, by_region, own_regions, name):
    """With the region file each region is audited: here one that is not the body's lowest, or touches."""
    change(sequence.contact, **{name: REGION_FAULTS[name](by_region[name])})
    found = check_dataset(dataset, checksums=False, contact_regions=own_regions)
    assert labels(found) == {f"contact.{name}"}
    assert not found.notes


def test_the_region_file_of_the_recipe(dataset, by_region, own_regions, tmp_path):
    """It is taken where it still is; another that is named in its place does not fit the labels."""
    index = json.loads((dataset / "dataset.json").read_text())
    index["recipe"] = {"contact_regions": str(own_regions)}
    (dataset / "dataset.json").write_text(json.dumps(index))
    assert audit(dataset).lines() == ["1 sequence, 8 frames: nothing wrong"]
    other = tmp_path / "other.json"
    other.write_text(json.dumps({"all": list(range(13886))}))
    (finding,) = check_dataset(dataset, checksums=False, contact_regions=other)
    assert finding.label == "contact.part_names"
    assert "other.json" in finding.message
    other.write_text("[7")
    with pytest.raises(BodyModelError, match=r"other\.json: not a usable region file"):
        check_dataset(dataset, contact_regions=other)


def test_self_contact_that_does_not_follow(dataset, sequence, own_regions):
    people, model = load(sequence.people), BodyModel.embedded()
    frames = len(people["valid"][0])
    made = ContactLabels(model, 2, frames, 30.0, self_contact=True)
    cast = [
        LabelledPerson(number + 1, "stroll", "neutral", BodyParams.from_arrays(people, "world", number))
        for number in range(2)
    ]
    for frame, now in enumerate(posed_frames(cast, model)):
        made.add(frame, None, now, None)
    own = {name: made.arrays()[name] for name in ("self_contact", "self_apart")}
    change(sequence.contact, **own)
    assert not audit(dataset).lines()[:-1]
    assert labels(check_dataset(dataset, checksums=False, contact_regions=own_regions)) == {
        "contact.part_names"  # made without a region file
    }
    own["self_contact"][1, 3, 0, 11] ^= True
    change(sequence.contact, **own)
    assert labels(audit(dataset)) == {"contact.self_contact"}
    change(sequence.contact, self_contact=own["self_contact"][..., :3])
    assert labels(audit(dataset)) == {"contact.self_contact"}
