"""Whether the arrays of a sequence are those of the contract: keys, shapes, kinds, finite values."""

from collections.abc import Mapping

import numpy as np

from whacamole.check.findings import Report
from whacamole.dataset import Sequence
from whacamole.labels.arrays import AnyArray

# Key -> shape and kind (float, int, bool, text); P people, T frames, C parts, B bytes of contact bits.
_CAMERA = {
    "K": ("T 3 3", "f"),
    "T_world_camera": ("T 4 4", "f"),
    "T_camera_world": ("T 4 4", "f"),
    "fps": ("", "f"),
    "width": ("", "i"),
    "height": ("", "i"),
    "frame_index": ("T", "i"),
    "shutter": ("", "f"),
    "f_number": ("", "f"),
    "focus_distance": ("T", "f"),
    "exposure": ("", "f"),
    "noise": ("", "f"),
    "noise_seed": ("", "i"),
}
_PEOPLE = {
    "track_id": ("P", "i"),
    "motion_id": ("P", "U"),
    "gender": ("P", "U"),
    "body_model": ("", "U"),
    "body_model_sha256": ("", "U"),
    "betas": ("P 10", "f"),
    "expression": ("P T 10", "f"),
    "global_orient_world": ("P T 3", "f"),
    "transl_world": ("P T 3", "f"),
    "global_orient_camera": ("P T 3", "f"),
    "transl_camera": ("P T 3", "f"),
    "body_pose": ("P T 21 3", "f"),
    "left_hand_pose": ("P T 15 3", "f"),
    "right_hand_pose": ("P T 15 3", "f"),
    "jaw_pose": ("P T 3", "f"),
    "leye_pose": ("P T 3", "f"),
    "reye_pose": ("P T 3", "f"),
    "joints_world": ("P T 55 3", "f"),
    "joints_camera": ("P T 55 3", "f"),
    "joints_image": ("P T 55 2", "f"),
    "joint_visibility": ("P T 55", "i"),
    "bbox_xyxy": ("P T 4", "f"),
    "bbox_visible_xyxy": ("P T 4", "f"),
    "visible_fraction": ("P T", "f"),
    "valid": ("P T", "b"),
}
_CONTACT = {
    "part_names": ("C", "U"),
    "ground_contact": ("P T C", "b"),
    "ground_distance": ("P T C", "f"),
    "person_contact": ("P P T C", "b"),
    "person_distance": ("P P T C", "f"),
    "person_contact_part": ("P P T C", "i"),
    "vertex_contact": ("P T B", "i"),
    "ground_threshold": ("", "f"),
    "person_threshold": ("", "f"),
    "velocity_threshold": ("", "f"),
}
_KINDS = {"f": "f", "i": "iu", "b": "b", "U": "U"}
_MAY_BE_INFINITE = (
    "contact.person_distance",
    "contact.ground_distance",
    "camera.f_number",
    "camera.focus_distance",
)


# Made only where asked for, all together.
_SELF_CONTACT = {"self_contact": ("P T C C", "b"), "self_apart": ("", "f")}


def check_contract(sequence: Sequence, report: Report) -> bool:
    """Note every breach; return whether the other checks can go on."""
    before = len(report.found)
    sizes = {"T": len(sequence), "P": len(sequence.people.get("track_id", ()))}
    sizes["C"] = len(sequence.contact.get("part_names", ()))
    contact = _CONTACT | (_SELF_CONTACT if "self_contact" in sequence.contact else {})
    for file, table in (("camera", _CAMERA), ("people", _PEOPLE), ("contact", contact)):
        _check_file(file, table, getattr(sequence, file), sizes, report)
    if len(report.found) > before:
        return False
    _check_values(sequence, report)
    return True


def _check_file(
    file: str,
    table: Mapping[str, tuple[str, str]],
    arrays: Mapping[str, AnyArray],
    sizes: Mapping[str, int],
    report: Report,
) -> None:
    for key, (shape, kind) in table.items():
        label = f"{file}.{key}"
        if key not in arrays:
            report.add(label, "the array is missing", "absent", "present")
            continue
        array = arrays[key]
        wanted = tuple(sizes.get(name, -1) if name.isalpha() else int(name) for name in shape.split())
        fits = array.ndim == len(wanted) and all(
            want in (-1, have) for want, have in zip(wanted, array.shape, strict=True)
        )
        if not fits:
            report.add(label, "wrong shape", str(array.shape), f"({shape.replace(' ', ', ')})")
        elif array.dtype.kind not in _KINDS[kind]:
            report.add(label, "wrong type", str(array.dtype), kind)
        elif kind == "f" and label not in _MAY_BE_INFINITE and not np.isfinite(array).all():
            bad = np.argwhere(~np.isfinite(array))[0]
            frame = int(bad[shape.split().index("T")]) if "T" in shape.split() else None
            report.add(label, "not a number", str(array[tuple(bad)]), "finite", frame)


def _check_values(sequence: Sequence, report: Report) -> None:
    """What single numbers must be."""
    people, camera = sequence.people, sequence.camera
    ids = people["track_id"]
    if len(np.unique(ids)) < len(ids) or (ids < 1).any():
        report.add("people.track_id", "ids must be distinct and at least 1", str(ids.tolist()), "1, 2, …")
    if not np.array_equal(camera["frame_index"], np.arange(len(sequence))):
        report.add(
            "camera.frame_index", "does not count from 0", str(camera["frame_index"].tolist()[:8]), "0, 1, …"
        )
    size = (int(camera["width"]), int(camera["height"]))
    if size != sequence.size:
        report.add("camera.width", "another size than sequence.json says", str(size), str(sequence.size))
    if abs(float(camera["fps"]) - float(sequence.facts["fps"])) > 1e-9:
        report.add(
            "camera.fps", "another rate than sequence.json says", float(camera["fps"]), sequence.facts["fps"]
        )
    if not set(np.unique(people["joint_visibility"])) <= {0, 1, 2}:
        report.add(
            "people.joint_visibility", "values other than 0, 1, 2", int(people["joint_visibility"].max()), 2
        )
    fraction = people["visible_fraction"]
    if fraction.size and (fraction.min() < 0 or fraction.max() > 1):
        report.add("people.visible_fraction", "not a fraction", float(fraction.max()), 1.0)
