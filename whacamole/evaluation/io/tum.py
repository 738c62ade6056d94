"""Camera paths as text: ``time tx ty tz qx qy qz qw`` a line, camera to world (TUM RGB-D)."""

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from whacamole.errors import EvaluationError
from whacamole.evaluation.io.arrays import poses
from whacamole.evaluation.records import CameraTrack, Recording


def read_tum(path: Path, sequence_id: str, fps: float) -> Recording:
    """Read a camera path; a prediction without people.

    Times that are all whole numbers are frame numbers, others are seconds, taken to the nearest frame; the
    note of the recording says which.

    Raises:
        EvaluationError: the file cannot be used; one line.
    """
    rows = []
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise EvaluationError(f"{path}: not readable ({error})") from error
    for number, line in enumerate(lines, start=1):
        words = line.replace(",", " ").split()
        if not words or words[0].startswith("#"):
            continue
        try:
            row = [float(word) for word in words]
        except ValueError:
            row = []
        if len(row) != 8 or not np.isfinite(row).all() or not any(row[4:]):
            raise EvaluationError(f"{path}: line {number} is not 'time tx ty tz qx qy qz qw'")
        rows.append(row)
    if not rows:
        raise EvaluationError(f"{path}: no poses")
    table = np.array(rows)
    whole = bool((table[:, 0] == np.round(table[:, 0])).all())
    frames = np.round(table[:, 0] if whole else table[:, 0] * fps).astype(np.intp)
    frames, first = np.unique(frames, return_index=True)
    pose = poses(Rotation.from_quat(table[first, 4:]).as_matrix(), table[first, 1:4])
    return Recording(
        id=sequence_id,
        frame_index=frames,
        fps=fps,
        people=(),
        camera=CameraTrack(pose, np.ones(len(frames), dtype=bool)),
        method="TUM",
        by_position=True,
        notes=(f"camera times read as {'frame numbers' if whole else 'seconds'}",),
    )
