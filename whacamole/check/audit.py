"""The audit of a dataset: labels against labels, labels against pixels, files against what was written."""

from collections.abc import Callable
from pathlib import Path

from whacamole.body import BodyModel
from whacamole.check.bodies import check_bodies, pose_people
from whacamole.check.cameras import check_cameras
from whacamole.check.contract import check_contract
from whacamole.check.files import check_files, check_index, check_splits, read_index
from whacamole.check.findings import Finding, Findings, Report
from whacamole.check.limits import Limits
from whacamole.check.regions import ContactParts
from whacamole.check.sequence import SequenceAudit
from whacamole.dataset import Dataset, Sequence
from whacamole.errors import DatasetError


def check_dataset(
    path: Path | str,
    *,
    checksums: bool = True,
    body_model: BodyModel | None = None,
    contact_regions: Path | None = None,
    limits: Limits | None = None,
    on_sequence: Callable[[str], None] | None = None,
) -> Findings:
    """Audit a dataset. What it finds it reports; it changes nothing.

    Args:
        path: the dataset's folder.
        checksums: compare every file with the sha256 noted when it was written.
        body_model: the model the labels refer to; by default the embedded one.
        contact_regions: the region file that names the parts of ``contact.npz``, if the dataset was made with
            one; by default the file that its recipe names, where that is still there.
        limits: what is sound.
        on_sequence: told the id of each sequence before its turn.

    Raises:
        DatasetError: there is no dataset at ``path``.
        BodyModelError: ``contact_regions`` is no region file of this body.
    """
    data = read_index(Path(path))
    model = body_model or BodyModel.embedded()
    parts = ContactParts(data, model, contact_regions)
    whole = Report("")
    check_index(data, whole)
    found: list[Finding] = []
    motions: dict[str, str] = {}
    frames = 0
    for sequence_id in data.ids:
        if on_sequence is not None:
            on_sequence(sequence_id)
        report = Report(sequence_id)
        sequence = _open(data, sequence_id, report)
        if sequence is not None:
            motions[sequence_id] = str(sequence.facts["motion_id"])
            frames += len(sequence)
            _check_sequence(sequence, model, parts, limits or Limits(), report, checksums)
        found += report.found
    check_splits(data, motions, whole)
    return Findings((*whole.found, *found), len(data.ids), frames, parts.notes())


def _open(data: Dataset, sequence_id: str, report: Report) -> Sequence | None:
    """A sequence, or None and a finding if its summary says too little."""
    try:
        sequence = data[sequence_id]
        len(sequence), sequence.size, sequence.facts["passes"], sequence.facts["image_format"]
    except (DatasetError, KeyError, TypeError, ValueError) as error:
        report.add("sequence.json", "not readable", str(error).split(";")[0], "a whole file")
        return None
    return sequence


def _check_sequence(
    sequence: Sequence,
    model: BodyModel,
    parts: ContactParts,
    limits: Limits,
    report: Report,
    checksums: bool,
) -> None:
    """All checks of one sequence, as far as its files allow."""
    readable = check_files(sequence, report, checksums=checksums)
    if not readable or not check_contract(sequence, report):
        return
    sound_cameras = check_cameras(sequence.camera, limits, report)
    motions = {str(motion) for motion in sequence.people["motion_id"]}
    stated = str(sequence.facts["motion_id"])
    sha256 = str(sequence.people["body_model_sha256"])
    if motions and stated not in motions:
        report.add(
            "people.motion_id", "another motion than sequence.json says", ", ".join(sorted(motions)), stated
        )
    if not model.matches(sha256):
        name = str(sequence.people["body_model"])
        report.add(
            "people.body_model_sha256", f"labels are about {name}; give its file to check bodies",
            sha256[:12], model.sha256[:12],
        )  # fmt: skip
        return
    if not sound_cameras:
        return
    if not len(sequence.people["track_id"]):
        report.add("people.track_id", "nobody is labelled", 0, "at least 1")
        return
    posed = pose_people(sequence, model)
    check_bodies(sequence, posed, limits, report)
    SequenceAudit(sequence, posed, parts.of(sequence, report), limits, report).run()
