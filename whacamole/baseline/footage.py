"""A video to run on: a sequence of a dataset, or any file."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from whacamole.baseline.rigid import FloatArray
from whacamole.errors import BaselineError

if TYPE_CHECKING:
    from whacamole.dataset import Sequence

Image = NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Footage:
    """T frames; decoded again every time they are asked for.

    Attributes:
        id: of the sequence, or the file's stem.
        num_frames, fps, width, height: of the video.
        frame_index: (T,) the dataset's frame numbers, 0 … T − 1 for a file.
        images: gives the frames (H, W, 3) sRGB in order.
        sequence: the labelled sequence, ``None`` for a file.
    """

    id: str
    num_frames: int
    fps: float
    width: int
    height: int
    frame_index: NDArray[np.int64]
    images: Callable[[], Iterator[Image]]
    sequence: "Sequence | None" = None

    @property
    def given_K(self) -> FloatArray | None:  # noqa: N802 - the name of the array in camera.npz
        """The true K (T, 3, 3), where there is one."""
        return None if self.sequence is None else np.asarray(self.sequence.camera["K"], dtype=np.float64)

    def watched(self, watch: Callable[[int], None]) -> "Footage":
        """The same footage that tells how many frames have been looked at."""

        def images() -> Iterator[Image]:
            for number, image in enumerate(self.images(), start=1):
                yield image
                watch(number)

        return replace(self, images=images)


def sequence_footage(sequence: "Sequence") -> Footage:
    """The footage of a sequence of a dataset."""
    camera = sequence.camera
    frame_index = np.asarray(camera["frame_index"], dtype=np.int64)
    return Footage(
        id=sequence.id,
        num_frames=len(frame_index),
        fps=float(camera["fps"]),
        width=int(camera["width"]),
        height=int(camera["height"]),
        frame_index=frame_index,
        images=lambda: (sequence.rgb(frame) for frame in range(len(frame_index))),
        sequence=sequence,
    )


def video_footage(path: Path) -> Footage:
    """The footage of a video file.

    Raises:
        BaselineError: it cannot be read or holds no frame.
    """
    num_frames, (height, width, _) = 0, (0, 0, 0)
    for image in _decoded(path):
        num_frames, (height, width, _) = num_frames + 1, image.shape
    if num_frames < 2:
        raise BaselineError(f"{path}: {num_frames} frames; give a video of at least two")
    return Footage(
        id=path.stem,
        num_frames=num_frames,
        fps=_rate(path),
        width=width,
        height=height,
        frame_index=np.arange(num_frames, dtype=np.int64),
        images=lambda: _decoded(path),
    )


def _rate(path: Path) -> float:
    import av

    with av.open(str(path)) as container:
        rate = container.streams.video[0].average_rate
        if rate is None or rate <= 0:
            raise BaselineError(f"{path}: tells no frame rate; write it again with one")
        return float(rate)


def _decoded(path: Path) -> Iterator[Image]:
    import av

    try:
        with av.open(str(path)) as container:
            if not container.streams.video:
                raise BaselineError(f"{path}: no video in it; give a video file")
            for frame in container.decode(video=0):
                yield frame.to_ndarray(format="rgb24")
    except (av.FFmpegError, OSError) as error:
        raise BaselineError(f"{path}: not readable as a video ({error}); give an MP4, MOV or MKV") from error
