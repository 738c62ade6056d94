"""MP4: a sequence as a video whose frame times are exactly those of the labels."""

from pathlib import Path

from whacamole.dataset.video import write_video
from whacamole.export.source import Source

__all__ = ["write_mp4"]

QUALITY = 16
"""Constant rate factor of H.264."""


def write_mp4(source: Source, folder: Path) -> list[str]:
    """Write ``<sequence>.mp4`` (H.264, 4:2:0); an odd width or height gains a repeated column or row."""
    for sequence in source:
        frames = (sequence.rgb(number) for number in range(len(sequence)))
        write_video(folder / f"{sequence.id}.mp4", frames, float(sequence.facts["fps"]), quality=QUALITY)
    return []
