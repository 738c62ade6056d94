"""From names typed on the command line to sources."""

from pathlib import Path

from whacamole.baseline.estimators import EstimatorSource
from whacamole.baseline.odometry import OdometrySource
from whacamole.errors import BaselineError

ESTIMATORS = ("mediapipe", "files", "noisy-labels")
ODOMETRIES = ("opencv", "colmap", "files", "noisy-labels")


def estimator_named(name: str, folder: Path | None, noise: float, seed: int) -> EstimatorSource:
    """An estimator.

    Args:
        name: of :data:`ESTIMATORS`.
        folder: of ``files``.
        noise: factor on the noise of ``noisy-labels``; 0 gives the truth.
        seed: of the noise.

    Raises:
        BaselineError: no such name, or a folder is missing.
    """
    if name == "mediapipe":
        from whacamole.baseline.estimators.mediapipe import MediapipeEstimator

        return MediapipeEstimator()
    if name == "files":
        from whacamole.baseline.estimators.files import FilesEstimator

        return FilesEstimator(_there(folder, "--estimator files", "--estimates"))
    if name == "noisy-labels":
        from whacamole.baseline.estimators.noisy_labels import LabelNoise, NoisyLabelsEstimator

        return NoisyLabelsEstimator(LabelNoise().times(noise), seed)
    raise BaselineError(f"no estimator {name!r}, only {', '.join(ESTIMATORS)}")


def odometry_named(name: str, folder: Path | None, noise: float, seed: int) -> OdometrySource:
    """An odometry; arguments as for :func:`estimator_named`.

    Raises:
        BaselineError: no such name, or a folder is missing.
    """
    if name == "opencv":
        from whacamole.baseline.odometry.opencv import OpenCVOdometry

        return OpenCVOdometry()
    if name == "colmap":
        from whacamole.baseline.odometry.colmap import ColmapOdometry

        return ColmapOdometry()
    if name == "files":
        from whacamole.baseline.odometry.files import FilesOdometry

        return FilesOdometry(_there(folder, "--vo files", "--trajectories"))
    if name == "noisy-labels":
        from whacamole.baseline.odometry.noisy_labels import NoisyLabelsOdometry, PathNoise

        return NoisyLabelsOdometry(PathNoise().times(noise), seed)
    raise BaselineError(f"no odometry {name!r}, only {', '.join(ODOMETRIES)}")


def _there(folder: Path | None, choice: str, option: str) -> Path:
    if folder is None:
        raise BaselineError(f"{choice} needs {option} FOLDER")
    if not folder.exists():
        raise BaselineError(f"{folder}: not there; {option} names the folder of the files")
    return folder
