"""One sequence as a scene in the browser: what never moves, and what every frame changes."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy.spatial.transform import Rotation

from whacamole.dataset import Sequence
from whacamole.labels.shading import track_colour
from whacamole.viewing.bodies import Actor, ContactPoints, Float32s, Floats, contact_points
from whacamole.viewing.prediction import Prediction
from whacamole.viewing.thinning import Surface
from whacamole.viewing.viewpoint import FOV, Viewpoint

__all__ = ["LAYERS", "Look", "Scene3D"]

Rgb = tuple[int, int, int]

TRUE_CAMERA: Rgb = (40, 40, 48)
PREDICTED: Rgb = (85, 95, 125)  # of no track, so that it is never taken for the truth
GROUND_TOUCH: Rgb = (225, 30, 40)
PERSON_TOUCH: Rgb = (215, 40, 200)
SHOT_COLOURS: tuple[Rgb, ...] = ((209, 73, 91), (0, 121, 140), (237, 174, 73), (106, 76, 147), (48, 99, 142))

LAYERS: Mapping[str, str] = {
    "people": "/people",
    "contacts": "/contacts",
    "camera": "/camera",
    "camera path and keyframes": "/path",
    "stage": "/stage",
    "prediction": "/prediction",
}
"""What can be shown and hidden: its name, and the node of the scene above it."""

GRID = 1.0 / 2048
"""Saved vertices are rounded to this [m], so that the file packs to about half."""

NO_POINTS = np.array([[0.0, 0.0, -1000.0]], dtype=np.float32)
"""A point far below, as the viewer cannot draw none."""


@dataclass(frozen=True)
class Look:
    """How the scene is drawn.

    Attributes:
        image_width: pixels of the frame inside the camera.
        rounded: round vertices to :data:`GRID`, for a file.
        images: show frames inside the camera.
    """

    image_width: int = 480
    rounded: bool = False
    images: bool = True


@dataclass(eq=False)
class Scene3D:
    """Draws a sequence into viser's scene.

    Args:
        server: a ``viser.ViserServer``.
        sequence: what to show.
        actors: its people.
        surface: the mesh to draw them with.
        prediction: to draw beside the truth.
        look: how.
    """

    server: Any
    sequence: Sequence
    actors: list[Actor]
    surface: Surface
    prediction: Prediction | None = None
    look: Look = field(default_factory=Look)

    def __post_init__(self) -> None:
        scene = self.server.scene
        scene.set_up_direction("+z")
        self._bodies: list[tuple[Actor, Any]] = []
        self._stand()
        self._add_path()
        camera = self.sequence.camera
        self._frustum = self._add_frustum("/camera/frustum", TRUE_CAMERA, camera["T_world_camera"][0])
        for actor in self.actors:
            self._add_body(actor, f"/people/{actor.track_id}", track_colour(actor.track_id), None)
        self._touch = {
            name: scene.add_point_cloud(
                f"/contacts/{name}", NO_POINTS, colour, point_size=0.014, point_shape="circle",
                precision="float32",
            )
            for name, colour in (("ground", GROUND_TOUCH), ("person", PERSON_TOUCH))
        }  # fmt: skip
        self._predicted_camera: Any = None
        if self.prediction is not None:
            self._add_prediction(self.prediction)
        self.show(0)

    def show(self, frame: int) -> None:
        """Change the scene to a frame."""
        with self.server.atomic():
            posed = [self._show_body(actor, handle, frame) for actor, handle in self._bodies]
            touching = contact_points(self.sequence.contact, posed[: len(self.actors)], frame)
            self._show_contacts(touching)
            camera = self.sequence.camera
            place(self._frustum, camera["T_world_camera"][frame])
            self._frustum.fov = _fov(camera["K"][frame], self.sequence.size[1])
            if self.look.images:
                self._frustum.image = self._image(frame)
            if self._predicted_camera is not None and self.prediction is not None:
                pose = self.prediction.T_world_camera[frame]
                self._predicted_camera.visible = bool(np.isfinite(pose).all())
                if self._predicted_camera.visible:
                    place(self._predicted_camera, pose)

    def _show_body(self, actor: Actor, handle: Any, frame: int) -> Float32s:
        vertices = actor.vertices(frame)
        drawn = vertices[self.surface.vertices]
        handle.vertices = _rounded(drawn) if self.look.rounded else drawn
        if handle.visible != bool(actor.valid[frame]):
            handle.visible = bool(actor.valid[frame])
        return vertices

    def _show_contacts(self, touching: ContactPoints) -> None:
        for name, points in (("ground", touching.ground), ("person", touching.person)):
            shown = points if len(points) else NO_POINTS
            self._touch[name].points = _rounded(shown) if self.look.rounded else shown

    def _image(self, frame: int) -> NDArray[np.uint8]:
        picture = Image.fromarray(self.sequence.rgb(frame))
        picture.thumbnail((self.look.image_width, self.look.image_width), Image.Resampling.LANCZOS)
        return np.asarray(picture)

    def _add_body(self, actor: Actor, name: str, colour: Rgb, opacity: float | None) -> None:
        vertices = actor.vertices(0)[self.surface.vertices]
        handle = self.server.scene.add_mesh_simple(
            name, vertices, self.surface.faces, color=colour, opacity=opacity
        )
        self._bodies.append((actor, handle))

    def _add_frustum(self, name: str, colour: Rgb, pose: Floats) -> Any:
        width, height = self.sequence.size
        handle = self.server.scene.add_camera_frustum(
            name, _fov(self.sequence.camera["K"][0], height), width / height, scale=0.55, color=colour
        )
        place(handle, pose)
        return handle

    def _add_prediction(self, prediction: Prediction) -> None:
        for actor in prediction.actors:
            self._add_body(actor, f"/prediction/people/{actor.track_id}", PREDICTED, 0.6)
            self._line(f"/prediction/trail/{actor.track_id}", actor.pelvis(), PREDICTED, 2.0)
        known = np.isfinite(prediction.T_world_camera).all(axis=(1, 2))
        if known.any():
            first = prediction.T_world_camera[int(np.flatnonzero(known)[0])]
            self._predicted_camera = self._add_frustum("/prediction/camera", PREDICTED, first)
            self._line("/prediction/path", prediction.T_world_camera[:, :3, 3], PREDICTED, 2.0)

    def _add_path(self) -> None:
        """The camera's way in the colours of its shots, its keyframes, and the ways of the people."""
        eyes = self.sequence.camera["T_world_camera"][:, :3, 3]
        for index, shot in enumerate(_shots(self.sequence)):
            colour = SHOT_COLOURS[index % len(SHOT_COLOURS)]
            self._line(f"/path/shots/{index}", eyes[shot["start"] : shot["end"] + 1], colour, 3.0)
            for number, keyframe in enumerate(shot.get("keyframes", ())):
                self._add_keyframe(f"/path/keyframes/{index}-{number}", keyframe["location"], colour)
            below = eyes[int(shot["start"])] - [0.0, 0.0, 0.25]
            self.server.scene.add_label(f"/path/names/{index}", str(shot["kind"]), position=tuple(below))
        for actor in self.actors:
            self._line(f"/path/people/{actor.track_id}", actor.pelvis(), track_colour(actor.track_id), 2.0)

    def _add_keyframe(self, name: str, location: Any, colour: Rgb) -> None:
        self.server.scene.add_icosphere(name, radius=0.035, color=colour, position=tuple(location))

    def _line(self, name: str, points: Floats, colour: Rgb, width: float) -> None:
        """A broken line through points (T, 3), with gaps where they are not known."""
        pairs = np.stack([points[:-1], points[1:]], axis=1)
        pairs = pairs[np.isfinite(pairs).all(axis=(1, 2))].astype(np.float32)
        if len(pairs):
            self.server.scene.add_line_segments(
                name, pairs, colour, thickness=width, thickness_units="screen"
            )

    def _stand(self) -> None:
        """The ground, what stands around, and where to look from first."""
        scene, eyes = self.server.scene, self.sequence.camera["T_world_camera"][:, :3, 3]
        people = np.concatenate([actor.pelvis() for actor in self.actors]) if self.actors else eyes
        view = Viewpoint.of(eyes, people)
        middle, reach = view.middle, view.reach
        scene.add_grid(
            "/stage/ground", width=3 * reach, height=3 * reach, plane="xy", cell_size=1.0, section_size=5.0,
            position=(float(middle[0]), float(middle[1]), 0.0),
        )  # fmt: skip
        for number, box in enumerate(_boxes(self.sequence)):
            near = np.linalg.norm(np.asarray(box["center"])[:2] - middle[:2]) < 2 * reach
            if near and box["center"][2] - box["size"][2] / 2 < 2.5:  # no ceilings
                half = float(box["yaw"]) / 2
                scene.add_box(
                    f"/stage/{number}", dimensions=tuple(box["size"]), color=(190, 184, 174), opacity=0.35,
                    position=tuple(box["center"]), wxyz=(float(np.cos(half)), 0.0, 0.0, float(np.sin(half))),
                )  # fmt: skip
        self.server.initial_camera.fov = float(2 * np.arctan(np.tan(FOV / 2) * 9 / 16))
        self.server.initial_camera.position = tuple(view.eye.tolist())
        self.server.initial_camera.look_at = tuple(view.target.tolist())


def place(handle: Any, pose: Floats) -> None:
    """Put a node where a rigid transform (4, 4) to the world says."""
    x, y, z, w = Rotation.from_matrix(pose[:3, :3]).as_quat()
    handle.wxyz, handle.position = (w, x, y, z), pose[:3, 3]


def _fov(K: Floats, height: int) -> float:
    """The vertical field of view [rad] of a centred lens."""
    return float(2 * np.arctan(height / 2 / K[1, 1]))


def _rounded(points: Float32s) -> Float32s:
    rounded: Float32s = (np.round(points / GRID) * GRID).astype(np.float32)
    return rounded


def _shots(sequence: Sequence) -> list[dict[str, Any]]:
    return [dict(shot) for shot in sequence.shot.get("shots", ())]


def _boxes(sequence: Sequence) -> list[dict[str, Any]]:
    return [dict(box) for box in (sequence.shot.get("world") or {}).get("obstacles", ())]
