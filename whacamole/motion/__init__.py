"""Motions: files of many formats in, one :class:`Motion` out (30 fps, z up, metres, near the ground).

::

    from whacamole.motion import find_motions, read_motion

    for file in find_motions("AMASS/"):
        motion = read_motion(file)
"""

from whacamole.motion.data import FPS, Motion, MotionFile, MotionPerson
from whacamole.motion.embedded import embedded_motions
from whacamole.motion.find import find_motions
from whacamole.motion.read import read_motion

__all__ = ["FPS", "Motion", "MotionFile", "MotionPerson", "embedded_motions", "find_motions", "read_motion"]
