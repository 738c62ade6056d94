"""The picture of a sequence to look at first."""

from PIL import Image

from whacamole.dataset import SequenceLayout

__all__ = ["write_preview"]


def write_preview(sequence: SequenceLayout) -> None:
    """Write ``preview.jpg``."""
    frames = sorted((sequence.folder / "rgb").iterdir())
    Image.open(frames[0]).convert("RGB").save(sequence.preview)
