"""MediaPipe's pose models for many people: one graph that finds people, one that reads a person off a region.

The wheel's own Python wrapper follows a single person. The graphs below are its parts, from the models that
the wheel carries; nothing is downloaded.
"""

import math
import os
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from whacamole.baseline.rigid import FloatArray
from whacamole.errors import BaselineError

NUM_LANDMARKS = 33

_GROWTH = 1.25
"""Side of a region over twice the distance from the hips to the edge of the person, as MediaPipe has it."""

_DETECT = """
input_stream: "image"
output_stream: "found"
node {
  calculator: "PoseDetectionCpu" input_stream: "IMAGE:image" output_stream: "DETECTIONS:found"
}
"""

_READ = """
input_stream: "image"
input_stream: "region"
output_stream: "landmarks"
output_stream: "world"
output_stream: "next"
node {
  calculator: "ConstantSidePacketCalculator" output_side_packet: "PACKET:complexity"
  options: { [mediapipe.ConstantSidePacketCalculatorOptions.ext]: { packet { int_value: 1 } } }
}
node {
  calculator: "PoseLandmarkByRoiCpu" input_side_packet: "MODEL_COMPLEXITY:complexity"
  input_stream: "IMAGE:image" input_stream: "ROI:region"
  output_stream: "LANDMARKS:landmarks" output_stream: "WORLD_LANDMARKS:world"
  output_stream: "AUXILIARY_LANDMARKS:next"
}
"""


@dataclass(frozen=True)
class Region:
    """A turned square around a person: centre and side [px], and the angle [rad] by which the person leans
    right."""

    x: float
    y: float
    side: float
    angle: float

    def overlaps(self, other: "Region") -> bool:
        """Whether both are about one person: the centres closer than a quarter of the smaller side."""
        return math.hypot(self.x - other.x, self.y - other.y) < 0.25 * min(self.side, other.side)

    def apart(self, other: "Region") -> float:
        """Between the centres, in sides of the larger region."""
        return math.hypot(self.x - other.x, self.y - other.y) / max(self.side, other.side)

    @classmethod
    def around(cls, middle: FloatArray, edge: FloatArray) -> Self:
        """From the middle of the hips to a point at the person's edge, above the head [px]."""
        dx, dy = edge - middle
        side = 2.0 * _GROWTH * math.hypot(dx, dy)
        return cls(float(middle[0]), float(middle[1]), side, math.atan2(dx, -dy))


@dataclass(frozen=True, eq=False)
class Reading:
    """A person in one frame.

    Attributes:
        pixels: (33, 2) landmarks [px].
        seen: (33,) how surely each is in view, 0 to 1.
        metric: (33, 3) landmarks about the middle of the hips [m], axes of a camera that looks at the person.
        next: where to look in the next frame.
    """

    pixels: FloatArray
    seen: FloatArray
    metric: FloatArray
    next: Region


class BlazePose:
    """The two graphs, running; close it, or use it as a context."""

    def __init__(self) -> None:
        mp = _mediapipe()
        self._mp = mp
        self._time = 0
        self._out: dict[str, Any] = {}
        with held_back_stderr():
            self._detect = self._start(_DETECT, ("found",), lists=True)
            self._read = self._start(_READ, ("landmarks", "world", "next"), lists=False)
            # Most of what the graphs have to say comes with the first image.
            nothing = np.zeros((64, 64, 3), dtype=np.uint8)
            self.find(nothing)
            self.read(nothing, Region(32.0, 32.0, 64.0, 0.0))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Stop the graphs."""
        for graph in (self._detect, self._read):
            graph.close()

    def find(self, image: NDArray[np.uint8]) -> list[Region]:
        """Regions of the people in an image (H, W, 3), the surest first."""
        found = self._run(self._detect, image=self._image(image)).get("found", [])
        size = np.array(image.shape[1::-1], dtype=np.float64)
        regions = []
        for one in sorted(found, key=lambda detection: -detection.score[0]):
            points = one.location_data.relative_keypoints
            middle, edge = (np.array([point.x, point.y]) * size for point in points[:2])
            regions.append(Region.around(middle, edge))
        return regions

    def read(self, image: NDArray[np.uint8], region: Region) -> Reading | None:
        """The person in a region, ``None`` if there is none."""
        from mediapipe.framework.formats import rect_pb2

        height, width = image.shape[:2]
        rect = rect_pb2.NormalizedRect(
            x_center=region.x / width,
            y_center=region.y / height,
            width=region.side / width,
            height=region.side / height,
            rotation=region.angle,
        )
        region_packet = self._mp.packet_creator.create_proto(rect)
        out = self._run(self._read, image=self._image(image), region=region_packet)
        if len(out) < 3:
            return None
        size = np.array([width, height], dtype=np.float64)
        middle, edge = _points(out["next"].landmark)[:2, :2] * size
        landmarks = out["landmarks"].landmark
        return Reading(
            pixels=_points(landmarks)[:NUM_LANDMARKS, :2] * size,
            seen=np.array([point.visibility for point in landmarks][:NUM_LANDMARKS]),
            metric=_points(out["world"].landmark)[:NUM_LANDMARKS],
            next=Region.around(middle, edge),
        )

    def _start(self, text: str, streams: Sequence[str], *, lists: bool) -> Any:
        get = self._mp.packet_getter.get_proto_list if lists else self._mp.packet_getter.get_proto
        graph = self._mp.CalculatorGraph(graph_config=text)
        for stream in streams:
            graph.observe_output_stream(
                stream, lambda name, packet: self._out.__setitem__(name, get(packet)), False
            )
        graph.start_run()
        return graph

    def _image(self, image: NDArray[np.uint8]) -> Any:
        data = np.ascontiguousarray(image)
        return self._mp.packet_creator.create_image_frame(image_format=self._mp.ImageFormat.SRGB, data=data)

    def _run(self, graph: Any, **packets: Any) -> dict[str, Any]:
        self._out.clear()
        self._time += 1
        for name, packet in packets.items():
            graph.add_packet_to_input_stream(name, packet.at(self._time))
        graph.wait_until_idle()
        return dict(self._out)


def _points(landmarks: Sequence[Any]) -> FloatArray:
    return np.array([[point.x, point.y, point.z] for point in landmarks])


@contextmanager
def held_back_stderr() -> Iterator[None]:
    """Hold back what native code writes to standard error, unless it fails.

    MediaPipe warns of its own graphs at every start, past Python and past every setting of its loggers.
    """
    sys.stderr.flush()
    with tempfile.TemporaryFile() as held:
        stderr = os.dup(2)
        os.dup2(held.fileno(), 2)
        try:
            yield
        except BaseException:
            held.seek(0)
            os.write(stderr, held.read())
            raise
        finally:
            os.dup2(stderr, 2)
            os.close(stderr)


def _mediapipe() -> Any:
    """MediaPipe, told where its models are.

    Raises:
        BaselineError: it is not installed.
    """
    try:
        import mediapipe
        from mediapipe.python._framework_bindings import resource_util
    except ImportError as error:
        raise BaselineError(
            f"--estimator mediapipe needs the package mediapipe ({error}); pip install 'whacamole[video]'"
        ) from error
    resource_util.set_resource_dir(str(Path(mediapipe.__file__).parents[1]))
    return mediapipe
