"""One seed in, every random choice out.

A sequence draws from generators keyed by what it is, never by when it is made:
``SeedSequence([dataset seed, hash of the motion id, shot index, hash of the purpose])``.
Adding a motion, a shot or a purpose therefore changes no other choice.
"""

import hashlib

import numpy as np

__all__ = ["generator", "stable_hash"]


def stable_hash(text: str) -> int:
    """Return a 64-bit integer from ``text``, the same in every process and version.

    (Python's own ``hash`` of a string differs from process to process.)
    """
    return int.from_bytes(hashlib.sha256(text.encode("utf-8")).digest()[:8], "big")


def generator(dataset_seed: int, motion_id: str, shot_index: int, purpose: str) -> np.random.Generator:
    """Return the generator for one ``purpose`` ("cast", "stage", "camera" …) of one sequence."""
    entropy = [dataset_seed, stable_hash(motion_id), shot_index, stable_hash(purpose)]
    return np.random.default_rng(np.random.SeedSequence(entropy))
