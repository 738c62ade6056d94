"""The motions that the package carries: real motion capture under a free licence."""

from __future__ import annotations

from importlib import resources
from pathlib import Path


def embedded_motions() -> Path:
    """The folder of the embedded motions; to :func:`whacamole.motion.find_motions` a folder like any other.

    Walks, a run, dances, acrobatics and pairs from the PyPI package ``pybullet`` (zlib licence);
    ``PROVENANCE.md`` in the folder tells what each is made from.
    """
    return Path(str(resources.files("whacamole") / "assets" / "motions"))
