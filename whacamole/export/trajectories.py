"""Camera paths alone: TUM text for visual odometry, nerfstudio's ``transforms.json`` for reconstruction."""

from pathlib import Path

from camera_rigs import CameraPath, to_nerfstudio, to_tum
from whacamole.dataset import Sequence
from whacamole.dataset.files import write_json, write_text
from whacamole.export.source import Source, image_format

__all__ = ["write_nerfstudio", "write_tum"]


def write_tum(source: Source, folder: Path) -> list[str]:
    """Write ``<sequence>.txt``: time, location and orientation of the camera in the world (z up)."""
    for sequence in source:
        write_text(folder / f"{sequence.id}.txt", to_tum(_path(sequence)))
    return []


def write_nerfstudio(source: Source, folder: Path) -> list[str]:
    """Write ``<sequence>/transforms.json`` with the frames where they are, relative to the file."""
    for sequence in source:
        (folder / sequence.id).mkdir()
        images = source.from_out(sequence.layout.folder / "rgb", sequence.id)
        template = f"{images}/{{:06d}}.{image_format(sequence)}"
        write_json(
            folder / sequence.id / "transforms.json",
            to_nerfstudio(_path(sequence), template),
        )
    return []


def _path(sequence: Sequence) -> CameraPath:
    camera = sequence.camera
    width, height = sequence.size
    return CameraPath(camera["K"], camera["T_world_camera"], float(camera["fps"]), width, height)
