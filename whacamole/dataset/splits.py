"""Which side of a split a motion falls on.

It depends on the motion's id alone, so a motion that is added later moves no other.
"""

from whacamole.seeds import stable_hash

__all__ = ["side_of"]


def side_of(motion_id: str, test_fraction: float) -> str:
    """Return ``"train"`` or ``"test"`` for a motion.

    The hash of the id is uniform on [0, 1); below ``test_fraction`` the motion is in the test split.
    """
    return "test" if stable_hash(f"split/{motion_id}") / 2**64 < test_fraction else "train"
