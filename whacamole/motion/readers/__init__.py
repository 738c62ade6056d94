"""The readers, in the order in which they are asked: the more particular schema first."""

from __future__ import annotations

from whacamole.motion.reader import Reader
from whacamole.motion.readers import (
    aist,
    amass_smplh,
    amass_smplx,
    bedlam,
    dd100,
    inter_human,
    inter_x,
    motion_x,
)

READERS: tuple[Reader, ...] = (
    inter_human.READER,
    aist.READER,
    motion_x.READER,
    dd100.READER,
    bedlam.READER,
    amass_smplx.READER,
    inter_x.READER,
    amass_smplh.READER,
)
"""AMASS SMPL+H is last: it also takes its own damaged files, to say what is wrong with them."""
