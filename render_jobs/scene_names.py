"""Names in a user's scene: which mean something, and what its meshes are called here."""

from __future__ import annotations

FLOOR = "floor"


def is_floor(name: str) -> bool:
    """Whether something of this name is the floor: ``floor``, ``Floor.001``, ``floor_wood``."""
    lowered = name.lower()
    return lowered == FLOOR or (lowered.startswith(FLOOR) and not lowered[len(FLOOR)].isalpha())


def mesh_name(index: int) -> str:
    """The name of a mesh in the plain scene; people's meshes are called otherwise."""
    return f"set-{index:04d}"
