"""Reading one found motion."""

from __future__ import annotations

from pathlib import Path

from whacamole.errors import MotionError
from whacamole.motion.container import open_record
from whacamole.motion.data import FPS, Motion, MotionFile
from whacamole.motion.find import find_motions, recognise
from whacamole.motion.scene import RestPelvis, build_motion, nominal_rest_pelvis
from whacamole.motion.up_axis import AXES


def read_motion(
    file: MotionFile | Path | str,
    *,
    up: str | None = None,
    fps: float = FPS,
    rest_pelvis: RestPelvis = nominal_rest_pelvis,
) -> Motion:
    """Reads ``file``, an entry of :func:`find_motions` or the path of one motion.

    ``fps`` is the frame rate of the result. ``up`` (``"+z"``, ``"-y"`` …) overrides the detected up axis.
    ``rest_pelvis`` gives the exact rest pelvis of the model the file was made with where that model is at
    hand; else the mean shape's is taken.

    Raises :class:`MotionError`, one line that names the file, what is wrong and what to do.
    """
    if up is not None and up not in AXES:
        raise MotionError(f"up axis '{up}' is none of {', '.join(AXES)}; choose one of them")
    if not isinstance(file, MotionFile):
        if Path(file).is_dir():
            raise MotionError(f"{file}: a folder; name one motion file, or use find_motions for a folder")
        [file] = find_motions(file)
    if file.problem is not None:
        raise MotionError(file.problem)
    records = [open_record(path) for path in file.paths]
    reader = recognise(records[0])
    raw = tuple(person for record in records for person in reader.read(record))
    return build_motion(
        raw,
        id=file.id,
        source=reader.name,
        path=file.path,
        licence=records[0].text("licence", reader.licence),
        convention=reader.up,
        stated=reader.up_stated,
        up=up,
        rest_pelvis=rest_pelvis,
        fps=fps,
    )
