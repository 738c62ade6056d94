"""Least-squares similarity between point sets (Umeyama, PAMI 1991), for many pairs at once."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.floating[Any]]
"""float64, or float32 for vertices."""


@dataclass(frozen=True, eq=False)
class Similarity:
    """``x ↦ scale · rotation · x + translation``, for any leading axes.

    Attributes:
        scale: (…).
        rotation: (…, 3, 3), determinant +1.
        translation: (…, 3) [m].
    """

    scale: FloatArray
    rotation: FloatArray
    translation: FloatArray

    def apply(self, points: FloatArray) -> FloatArray:
        """Move points (…, N, 3); the result has the precision of the points."""
        turned = (self.scale[..., None, None] * np.swapaxes(self.rotation, -1, -2)).astype(points.dtype)
        moved: FloatArray = points @ turned
        moved += self.translation[..., None, :].astype(points.dtype)
        return moved


def umeyama(
    source: FloatArray,
    target: FloatArray,
    *,
    with_scale: bool = True,
    weights: FloatArray | None = None,
) -> Similarity:
    """The similarity that takes ``source`` nearest to ``target``: least Σ w ‖target − (s R source + t)‖².

    Of the covariance U D Vᵀ = Σ w (target − mean)(source − mean)ᵀ: R = U S Vᵀ with S = diag(1, 1, ±1) so that
    det R = +1, and s = tr(D S) / Σ w ‖source − mean‖² (Umeyama 1991, eqs. 40 to 43).

    Args:
        source: (…, N, 3) [m].
        target: (…, N, 3) [m].
        with_scale: fit the scale; otherwise it is 1 (a rigid alignment).
        weights: (…, N), not negative; ``None`` counts every point once.

    Returns:
        The similarity. Where all source points coincide no scale exists: ``scale`` is NaN there.

    Raises:
        ValueError: the shapes differ or there is no point.
    """
    if source.shape != target.shape or source.shape[-1:] != (3,) or source.shape[-2] == 0:
        raise ValueError(f"umeyama: {source.shape} and {target.shape}, expected two arrays (…, N ≥ 1, 3)")
    # Products, not sums over an axis: on the short axes of points they are several times faster in NumPy.
    share = _shares(source, weights).astype(source.dtype)
    mean_source, mean_target = share @ source, share @ target
    from_mean, to_mean = source - mean_source, target - mean_target
    weighted = from_mean if weights is None else from_mean * np.swapaxes(share, -1, -2)
    each = 1.0 / source.shape[-2] if weights is None else 1.0
    covariance = each * (np.swapaxes(to_mean, -1, -2) @ weighted).astype(np.float64)
    variance = None
    if with_scale:
        products = np.swapaxes(weighted, -1, -2) @ from_mean
        variance = each * np.trace(products, axis1=-2, axis2=-1, dtype=np.float64)
    return similarity_of_moments(mean_source[..., 0, :], mean_target[..., 0, :], covariance, variance)


def similarity_of_moments(
    mean_source: FloatArray, mean_target: FloatArray, covariance: FloatArray, variance: FloatArray | None
) -> Similarity:
    """:func:`umeyama` from what it needs of the points.

    Args:
        mean_source, mean_target: (…, 3) [m].
        covariance: (…, 3, 3), mean of (target − mean)(source − mean)ᵀ [m²].
        variance: (…), mean of ‖source − mean‖² [m²]; ``None`` for a rigid motion.
    """
    U, D, Vt = np.linalg.svd(covariance)
    S = np.ones_like(D)
    S[..., 2] = np.where(np.linalg.det(U) * np.linalg.det(Vt) < 0.0, -1.0, 1.0)
    rotation = (U * S[..., None, :]) @ Vt
    scale = np.ones(D.shape[:-1])
    if variance is not None:
        with np.errstate(invalid="ignore", divide="ignore"):
            scale = np.where(variance > 0.0, (D * S).sum(axis=-1) / variance, np.nan)
    turned = (rotation @ mean_source[..., None])[..., 0]
    return Similarity(scale, rotation, mean_target - scale[..., None] * turned)


def _shares(points: FloatArray, weights: FloatArray | None) -> FloatArray:
    """Each point's share of the whole, adding up to 1: (…, 1, N), or (1, N) if all are equal."""
    if weights is None:
        return np.full((1, points.shape[-2]), 1.0 / points.shape[-2])
    if weights.shape != points.shape[:-1]:
        raise ValueError(f"umeyama: weights {weights.shape} for points {points.shape}")
    total = weights.sum(axis=-1, keepdims=True)
    if not (total > 0.0).all():
        raise ValueError("umeyama: the weights of a point set add up to nothing")
    return np.asarray(weights / total)[..., None, :]


def align(
    source: FloatArray, target: FloatArray, *, with_scale: bool = True, weights: FloatArray | None = None
) -> FloatArray:
    """``source`` after its best similarity to ``target`` (…, N, 3) [m]."""
    return umeyama(source, target, with_scale=with_scale, weights=weights).apply(source)


def spread(points: FloatArray) -> float:
    """Root mean square distance of points (N, 3) from their mean [m]; 0 for one point that never moves."""
    return float(np.sqrt(np.mean(np.sum((points - points.mean(axis=0)) ** 2, axis=-1))))
