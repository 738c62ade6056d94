"""The audit of one sequence, frame by frame: labels made anew and held against the pixels."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from whacamole.check.bodies import Posed
from whacamole.check.contacts import check_contacts
from whacamole.check.findings import Report
from whacamole.check.limits import Limits
from whacamole.check.normals import NormalAudit
from whacamole.check.order import REACH, colour_edges, correlation, label_edges, report_order
from whacamole.check.pixels import (
    Drawn,
    Hands,
    PersonPixels,
    Shown,
    draw,
    flow_error,
    likeness,
    mask_box,
    person_pixels,
    whole_box,
)
from whacamole.dataset import Sequence
from whacamole.errors import DatasetError
from whacamole.labels import ContactLabels, ContactThresholds
from whacamole.labels.arrays import AnyArray, Float64s, Floats
from whacamole.labels.parts import BodyParts
from whacamole.labels.visibility import flesh_thickness, joint_visibility

_BLOCK = 16


@dataclass(frozen=True, eq=False)
class _Frame:
    """One frame of the audit; images are None where they could not be read."""

    number: int
    drawn: Drawn
    shown: Shown | None
    colours: Float64s | None
    edges: Float64s | None


class SequenceAudit:
    """Goes through a sequence once, with a few frames in memory.

    Args:
        sequence: its label files can be read and keep to the contract.
        posed: its people.
        parts: those its contacts are named by; None if they are not known.
        limits: what is sound.
        report: takes the findings.
    """

    def __init__(
        self, sequence: Sequence, posed: Posed, parts: BodyParts | None, limits: Limits, report: Report
    ) -> None:
        self._parts = parts
        self._sequence, self._posed, self._limits, self._report = sequence, posed, limits, report
        self._ids = [int(track) for track in sequence.people["track_id"]]
        model = posed.model
        hand = model.weights[:, [20, 21, *range(25, 55)]].sum(axis=1) > 0.9
        self._hands = Hands(hand, hand[model.faces].all(axis=1))
        self._thickness = [
            flesh_thickness(model.rest_vertices(person.betas), model.rest_joints(person.betas))
            for person in posed.params
        ]
        shape = (len(self._ids), len(sequence))
        self._values = {
            name: np.zeros(shape)
            for name in (
                "stray", "sunk", "hands", "hands_off", "box", "seen_box", "visible", "joints", "valid",
                "flow_x", "flow_y",
            )
        }  # fmt: skip
        self._unknown = np.zeros(len(sequence))
        self._low = np.inf
        width = 2 * REACH + 1
        self._normals = NormalAudit(sequence, limits)
        self._label_band = np.full((len(sequence), width), np.nan)
        self._colour_band = np.full((len(sequence), width), np.nan)

    def run(self) -> None:
        """Audit all frames and report."""
        contact = self._sequence.contact
        limits = ContactThresholds(
            float(contact["ground_threshold"]),
            float(contact["velocity_threshold"]),
            float(contact["person_threshold"]),
        )
        anew = ContactLabels(
            self._posed.model,
            len(self._ids),
            len(self._sequence),
            float(self._sequence.camera["fps"]),
            limits=limits,
            parts=self._parts,
            self_contact="self_contact" in contact and self._parts is not None,
        )
        window: deque[_Frame] = deque(maxlen=REACH + 1)
        bodies: deque[list[Floats]] = deque(maxlen=3)
        for number, people in enumerate([*self._vertices(), None]):
            if people is not None:
                window.append(self._frame(number, people))
                self._compare(window)
            bodies.append(people or [])
            if number:
                before = bodies[0] if number > 1 else None
                anew.add(number - 1, before, bodies[-2], people)
        self._tell()
        check_contacts(self._sequence, anew.arrays(), self._limits, self._report)

    def _vertices(self) -> Iterator[list[Floats]]:
        for start in range(0, len(self._sequence), _BLOCK):
            params = [person.slice(start, start + _BLOCK) for person in self._posed.params]
            blocks = [self._posed.model.pose(person).vertices for person in params]
            for offset in range(len(blocks[0])):
                yield [block[offset] for block in blocks]

    def _frame(self, number: int, people: list[Floats]) -> _Frame:
        sequence, camera = self._sequence, self._sequence.camera
        drawn = draw(
            people, self._posed.model.faces, np.array(self._ids), camera["K"][number],
            camera["T_camera_world"][number], sequence.size,
        )  # fmt: skip
        self._low = min(self._low, *(float(body[:, 2].min()) for body in people))
        shown = self._shown(number)
        colours = edges = None
        if shown is not None:
            edges = label_edges(shown.mask, shown.depth)
            rgb = self._read("rgb", number)
            colours = None if rgb is None else colour_edges(rgb)
            self._measure(number, drawn, shown)
            if "normal" in sequence.facts["passes"]:
                normal = self._read("normal", number)
                if normal is not None:
                    self._normals.add(number, shown.mask, shown.depth, normal)
        return _Frame(number, drawn, shown, colours, edges)

    def _shown(self, number: int) -> Shown | None:
        mask, depth = self._read("mask", number), self._read("depth", number)
        return None if mask is None or depth is None else Shown(mask, depth)

    def _read(self, name: str, number: int) -> AnyArray | None:
        """An image, or None and a finding if it cannot be read or has another size."""
        try:
            image: AnyArray = getattr(self._sequence, name)(number)
        except DatasetError as error:
            if not str(error).startswith(self._sequence.id):  # a pass that was never asked for is no fault
                reason = str(error).split(": ", 1)[-1].split(";")[0]
                self._report.add(name, "not readable", reason, "a whole file", number)
            return None
        if image.shape[1::-1] != self._sequence.size:
            found = f"{image.shape[1]}x{image.shape[0]}"
            wanted = "{}x{}".format(*self._sequence.size)
            self._report.add(name, "another size than the camera's", found, wanted, number)
            return None
        return image

    def _measure(self, number: int, drawn: Drawn, shown: Shown) -> None:
        """Everything about one frame alone."""
        self._unknown[number] = np.count_nonzero(~np.isin(shown.mask, [0, *self._ids]))
        K = self._sequence.camera["K"][number]
        for person in range(len(self._ids)):
            seen = person_pixels(drawn, shown, person, self._ids, K, self._hands, self._limits)
            slack = self._limits.slack
            at = (person, number)
            self._values["stray"][at] = max(seen.stray - slack, 0) / max(seen.area, 1)
            self._values["sunk"][at] = max(seen.sunk - slack, 0) / max(seen.own, 1)
            self._values["hands"][at] = seen.hands
            self._values["hands_off"][at] = seen.hands_off
            self._measure_stored(person, number, drawn, shown, seen)

    def _measure_stored(
        self, person: int, number: int, drawn: Drawn, shown: Shown, seen: PersonPixels
    ) -> None:
        """Boxes, fraction and visibility as stored against those the images give."""
        people, at = self._sequence.people, (person, number)
        track = self._ids[person]
        count = int(np.count_nonzero(shown.mask == track))
        box = mask_box(shown.mask, track)
        self._values["seen_box"][at] = np.abs(people["bbox_visible_xyxy"][at] - box).max()
        body = whole_box(drawn, person, self._sequence.camera["K"][number])
        if body is not None:
            # Clothes and hair widen the box, nothing narrows it.
            inside = people["bbox_xyxy"][at] - body
            self._values["box"][at] = max(inside[:2].max(), -inside[2:].min(), 0.0)
        fraction = float(people["visible_fraction"][at])
        allowed = count / max(seen.area, 1) + self._limits.visible
        self._values["visible"][at] = max(fraction - allowed, 0.0) + float((fraction > 0) != (count > 0))
        self._values["valid"][at] = float(not people["valid"][at] and (count > 0 or seen.area > 0))
        state = joint_visibility(
            people["joints_camera"][at].astype(np.float64), people["joints_image"][at].astype(np.float64),
            self._thickness[person], shown.mask == track, shown.depth,
        )  # fmt: skip
        self._values["joints"][at] = np.count_nonzero(state != people["joint_visibility"][at])

    def _compare(self, window: deque[_Frame]) -> None:
        """The newest frame against itself and those before it: order, and flow from the one before."""
        newest = window[-1]
        for older in window:
            shift = newest.number - older.number
            for labels, pictures, place in (
                (older, newest, REACH + shift),
                (newest, older, REACH - shift),
            ):
                row = labels.number
                if pictures.shown is not None:
                    self._label_band[row, place] = likeness(labels.drawn, pictures.shown)
                if labels.edges is not None and labels.shown is not None and pictures.colours is not None:
                    self._colour_band[row, place] = correlation(
                        labels.edges, pictures.colours, labels.shown.mask
                    )
        if len(window) > 1 and "flow" in self._sequence.facts["passes"]:
            self._measure_flow(window[-2], newest)

    def _measure_flow(self, frame: _Frame, after: _Frame) -> None:
        flow = self._read("flow", frame.number)
        if flow is None or frame.shown is None:
            return
        K = self._sequence.camera["K"]
        for person, track in enumerate(self._ids):
            x, y = flow_error(
                frame.drawn, after.drawn, frame.shown, flow, person, track, (K[frame.number], K[after.number])
            )
            self._values["flow_x"][person, frame.number] = x
            self._values["flow_y"][person, frame.number] = y

    def _tell(self) -> None:
        limits, report = self._limits, self._report
        report.at_most("mask", "pixels of no track", self._unknown, 0.0)
        for person, track in enumerate(self._ids):
            for name, label, message, limit in (
                (
                    "stray",
                    "mask",
                    "share of the body's pixels that show neither it nor anything before it",
                    limits.stray,
                ),
                ("sunk", "depth", "share of the body's pixels where the picture is deeper", limits.sunk),
                ("seen_box", "people.bbox_visible_xyxy", "not the box of its mask [px]", limits.box),
                ("box", "people.bbox_xyxy", "cuts into the projected body [px]", limits.box),
                ("visible", "people.visible_fraction", "more than the pixels allow", 0.0),
                ("valid", "people.valid", "false for somebody in view", 0.0),
                ("joints", "people.joint_visibility", "joints with another visibility", 0.0),
                ("flow_x", "flow", "median off the projected motion in x [px]", limits.flow),
                ("flow_y", "flow", "median off the projected motion in y [px]", limits.flow),
            ):
                report.at_most(label, f"track {track}: {message}", self._values[name][person], limit)
            hands = self._values["hands"][person].sum()
            share = float(self._values["hands_off"][person].sum() / max(hands, 1))
            if hands >= 100 and share > limits.hands:
                report.add(
                    "people.left_hand_pose", f"track {track}: share of hand pixels off", share, limits.hands
                )
        self._normals.tell(report)
        report_order("mask", self._label_band, limits.order_labels, report)
        report_order("rgb", self._colour_band, limits.order_rgb, report)
        if abs(self._low) > limits.ground:
            report.add(
                "people.transl_world",
                "lowest point of all people over the ground [m]",
                self._low,
                limits.ground,
            )
