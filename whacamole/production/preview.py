"""The picture of a sequence to look at first."""

from whacamole.body import BodyModel
from whacamole.dataset import Sequence
from whacamole.labels.preview import preview_strip

__all__ = ["write_preview"]


def write_preview(sequence: Sequence, body: BodyModel) -> None:
    """Write ``preview.jpg``: frames as rendered, and below them the stored labels drawn over the pixels."""
    strip = preview_strip(sequence.rgb, sequence.people, sequence.camera, body, mask=sequence.mask)
    strip.save(sequence.layout.preview, quality=88)
