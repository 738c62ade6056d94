"""Whether the contact labels follow from the bodies."""

from collections.abc import Mapping

import numpy as np

from whacamole.check.findings import Report
from whacamole.check.limits import Limits
from whacamole.dataset import Sequence
from whacamole.labels.arrays import AnyArray, Float64s


def check_contacts(sequence: Sequence, again: dict[str, AnyArray], limits: Limits, report: Report) -> None:
    """Hold ``contact.npz`` against the same arrays made anew from the vertices."""
    stored, ids = sequence.contact, sequence.people["track_id"].tolist()
    same_parts = stored["part_names"].tolist() == again["part_names"].tolist()
    if "self_contact" in again and same_parts:
        wrong = (stored["self_contact"] != again["self_contact"]).any(axis=(-2, -1))
        for number, track in enumerate(ids):
            message = f"track {track}: own parts said to touch that do not, or the other way"
            report.at_most("contact.self_contact", message, wrong[number].astype(np.float64), 0.0)
    if not same_parts:
        # Nobody named the region file. Whatever its parts, the body as a whole has these gaps.
        stored, again = _as_one_part(stored), _as_one_part(again)
    gaps = _difference(stored["ground_distance"], again["ground_distance"], np.inf)
    for number, track in enumerate(ids):
        message = f"track {track}: not the height of the body's parts [m]"
        report.at_most("contact.ground_distance", message, gaps[number], limits.contact)
        wrong = (stored["ground_contact"] != again["ground_contact"])[number].any(axis=-1)
        message = f"track {track}: parts said to touch the ground that do not, or the other way"
        report.at_most("contact.ground_contact", message, wrong.astype(np.float64), 0.0)
        flipped = np.bitwise_xor(stored["vertex_contact"][number], again["vertex_contact"][number])
        share = np.unpackbits(flipped, axis=-1).mean(axis=-1)
        message = f"track {track}: share of vertices with another contact"
        report.at_most("contact.vertex_contact", message, share, limits.bits)
    _check_persons(stored, again, ids, limits, report)


def _as_one_part(contact: Mapping[str, AnyArray]) -> dict[str, AnyArray]:
    """The same labels of a body that is one part; which of its parts touches becomes whether any does."""
    whole = dict(contact)
    for name in ("ground_distance", "person_distance"):
        whole[name] = contact[name].min(axis=-1, keepdims=True)
    for name in ("ground_contact", "person_contact"):
        whole[name] = contact[name].any(axis=-1, keepdims=True)
    misnamed = (contact["person_contact"] != (contact["person_contact_part"] >= 0)).any(
        axis=-1, keepdims=True
    )
    whole["person_contact_part"] = np.where(whole["person_contact"] != misnamed, 0, -1)
    return whole


def _check_persons(
    stored: dict[str, AnyArray], again: dict[str, AnyArray], ids: list[int], limits: Limits, report: Report
) -> None:
    within = float(stored.get("person_exact_within", stored["person_threshold"]))
    gaps = _difference(stored["person_distance"], again["person_distance"], within)
    threshold = float(stored["person_threshold"])
    # Touching or not may turn on the last bit of a gap that is the threshold itself.
    sure = np.abs(again["person_distance"] - threshold) > limits.contact
    touch = sure & (stored["person_contact"] != again["person_contact"])
    named = stored["person_contact"] != (stored["person_contact_part"] >= 0)
    for one, first in enumerate(ids):
        for other, second in enumerate(ids):
            if one == other:
                continue
            pair = f"track {first} against {second}: "
            message = pair + "not the gap between the bodies [m]"
            report.at_most("contact.person_distance", message, gaps[one, other], limits.contact)
            message = pair + "parts said to touch that do not, or the other way"
            wrong = touch[one, other].any(axis=-1).astype(np.float64)
            report.at_most("contact.person_contact", message, wrong, 0.0)
            message = pair + "a touching part without the part it touches, or the other way"
            wrong = named[one, other].any(axis=-1).astype(np.float64)
            report.at_most("contact.person_contact_part", message, wrong, 0.0)


def _difference(stored: AnyArray, again: AnyArray, within: float) -> Float64s:
    """Largest difference over the parts, ``(…, T)``, of gaps up to ``within``; equal infinities agree."""
    counted = (again <= within) & (stored != again)
    with np.errstate(invalid="ignore"):
        apart = np.abs(stored.astype(np.float64) - again.astype(np.float64))
    return np.asarray(np.where(counted, apart, 0.0).max(axis=-1), dtype=np.float64)
