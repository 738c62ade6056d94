"""The noise of an image sensor, put on a finished picture.

Light arrives in quanta, so its variance grows with the light; reading it out adds a little more, which shows
in the dark. Both are normal here: at the light levels of video, Poisson and normal noise look alike
(Foi et al. 2008, "Practical Poissonian-Gaussian noise modeling").
"""

from __future__ import annotations

import numpy as np
from PIL import Image

from render_jobs.colour import encoded, linear_image

MIDDLE_GREY = 0.18
"""Linear light at which the strength is stated."""

READOUT = 0.01
"""The noise of reading out is that of this much light."""


def with_noise(picture: Image.Image, strength: float, seed: int, frame: int) -> Image.Image:
    """The picture as a noisy sensor would have taken it; equal arguments give equal bytes.

    Args:
        picture: display-ready sRGB.
        strength: standard deviation at middle grey (18 % of white), in 8-bit levels.
        seed: of the sequence; every frame and every channel has noise of its own.
        frame: its number.
    """
    if strength == 0.0:
        return picture
    light = linear_image(np.asarray(picture.convert("RGB")))
    rng = np.random.default_rng(np.random.SeedSequence([seed, frame]))
    deviation = strength / 255.0 * _linear_per_level() * np.sqrt((light + READOUT) / (MIDDLE_GREY + READOUT))
    noisy = light + deviation.astype(np.float32) * rng.standard_normal(light.shape, dtype=np.float32)
    return Image.fromarray(encoded(noisy))


def _linear_per_level() -> float:
    """How much linear light a step of the sRGB value (0 … 1) is at middle grey."""
    value = 1.055 * MIDDLE_GREY ** (1 / 2.4) - 0.055
    return float(2.4 / 1.055 * ((value + 0.055) / 1.055) ** 1.4)
