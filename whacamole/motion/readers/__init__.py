"""The readers, in the order in which they are asked: the more particular schema first."""

from __future__ import annotations

from whacamole.motion.reader import Reader
from whacamole.motion.readers import amass_smplh, amass_smplx, dd100

READERS: tuple[Reader, ...] = (
    dd100.READER,
    amass_smplx.READER,
    amass_smplh.READER,
)

BY_NAME = {reader.name: reader for reader in READERS}
