"""Image error over seconds: what each render setting buys, on three scenes of the product's own.

``python -m benchmarks.rendering.quality --settings presets peers default`` prints a table in Markdown. The
reference has 1024 samples (two halves with seeds of their own), Blender's default light transport with twelve
bounces of each kind, no denoiser. Error is the root mean square over pixels and channels of the difference in
8-bit levels, as the eye sees the picture (sRGB), with the reference's own noise, known from its halves,
taken off; PSNR in decibels says the same. Cost is CPU seconds of all threads for the picture alone, in a
scene that stands. References, measurements and pictures are kept in ``--out`` and used again.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from benchmarks.rendering.scenes import SCENES, WORK, blender, make_job, saved_scene
from render_jobs import QUALITIES, Quality
from render_jobs.blender.settings import denoiser_settings, sampling_settings

Cycles = dict[str, Any]

BLENDER_DEFAULT: Cycles = {
    "samples": 4096, "use_adaptive_sampling": True, "adaptive_threshold": 0.01, "adaptive_min_samples": 0,
    "use_denoising": True, "denoiser": "OPENIMAGEDENOISE", "denoising_quality": "HIGH",
    "denoising_prefilter": "ACCURATE", "denoising_input_passes": "RGB_ALBEDO_NORMAL",
    "use_light_tree": True, "max_bounces": 12, "diffuse_bounces": 4, "glossy_bounces": 4,
    "transmission_bounces": 12, "volume_bounces": 0, "transparent_max_bounces": 8,
    "sample_clamp_indirect": 10.0, "caustics_reflective": True, "caustics_refractive": True,
    "debug_use_spatial_splits": False, "sampling_pattern": "AUTOMATIC", "use_guiding": False,
    "use_fast_gi": False, "light_sampling_threshold": 0.01, "seed": 0,
}  # fmt: skip
"""Factory settings of Blender 4.5; every entry starts from them, so that none is left from the one before."""

REFERENCE: Cycles = {
    "samples": 512, "use_adaptive_sampling": False, "use_denoising": False,
    "max_bounces": 12, "diffuse_bounces": 12, "glossy_bounces": 12,
}  # fmt: skip
REFERENCE_SEEDS = (101, 202)


def ours(quality: Quality, **changes: Any) -> Cycles:
    """What a quality of ours sets."""
    quality = quality.model_copy(update=changes)
    return {**sampling_settings(quality), **denoiser_settings(quality, "CPU")}


BASE = Quality(name="base", samples=16)
"""What the groups that vary one thing start from."""

SETTINGS: dict[str, dict[str, Cycles]] = {
    "presets": {f"preset {name}": ours(quality) for name, quality in QUALITIES.items()},
    "denoiser": {
        f"{denoise}, prefilter {prefilter}": ours(BASE, denoise=denoise, prefilter=prefilter)
        for denoise, prefilter in (
            ("off", "none"), ("fast", "none"), ("balanced", "none"), ("high", "none"),
            ("balanced", "fast"), ("balanced", "accurate"), ("high", "fast"), ("high", "accurate"),
        )
    },
    "samples": {f"{samples} samples": ours(BASE, samples=samples) for samples in (2, 4, 8, 16, 32, 64, 128)},
    "adaptive": {
        f"at most {samples}, threshold {threshold}": ours(BASE, samples=samples, noise_threshold=threshold)
        for samples, threshold in ((32, 0.05), (32, 0.1), (64, 0.05), (64, 0.1), (64, 0.2), (128, 0.1))
    },
    "bounces": {
        f"diffuse {diffuse}, glossy {glossy}": ours(BASE, diffuse_bounces=diffuse, glossy_bounces=glossy)
        for diffuse, glossy in ((0, 0), (1, 1), (2, 1), (2, 2), (3, 2), (4, 2), (4, 4), (8, 4))
    },
    "sampling": {
        "no light tree": ours(BASE, light_tree=False),
        "no clamping": ours(BASE, clamp_indirect=0.0),
        "clamping at 3": ours(BASE, clamp_indirect=3.0),
        "blue noise": {**ours(BASE), "sampling_pattern": "BLUE_NOISE"},
        "Sobol": {**ours(BASE), "sampling_pattern": "TABULATED_SOBOL"},
        "weak lights at 0.05": {**ours(BASE), "light_sampling_threshold": 0.05},
        "spatial splits": {**ours(BASE), "debug_use_spatial_splits": True},
        "no caustics": {**ours(BASE), "caustics_reflective": False},
        "path guiding": {**ours(BASE), "use_guiding": True},
    },
    "peers": {
        "XRFeitoria: 128": {"samples": 128},
        "Kubric: 64": {"samples": 64},
        "Kubric: 128": {"samples": 128},
    },
    "default": {
        f"Blender's default, {samples} samples": {"samples": samples}
        for samples in (4, 8, 16, 32, 64, 128, 256)
    },
    "long": {
        "BlenderProc: 1024, bounces 3/0": {
            "samples": 1024, "max_bounces": 3, "diffuse_bounces": 3, "glossy_bounces": 0,
            "transmission_bounces": 0, "use_light_tree": False, "debug_use_spatial_splits": True,
        },
        "Blender's default as it is": {},
    },
}  # fmt: skip
"""By group: what is set over :data:`BLENDER_DEFAULT`."""


@dataclass(frozen=True)
class Measurement:
    """Error in 8-bit levels, and what the picture took."""

    error: float
    cpu_seconds: float
    seconds: float

    @property
    def psnr(self) -> float:
        """Peak signal to noise ratio in dB."""
        return 20.0 * float(np.log10(255.0 / self.error)) if self.error > 0 else float("inf")


def main() -> None:
    """Measure and print."""
    options = _parse()
    wanted = {name: values for group in options.settings for name, values in SETTINGS[group].items()}
    found = {stage: measure(stage, wanted, options) for stage in options.scenes}
    print("| setting | " + " | ".join(f"{stage}: error | PSNR | CPU s" for stage in found) + " |")
    print("|---" * (3 * len(found) + 1) + "|")
    for name in wanted:
        rows = [found[stage].get(name) for stage in found]
        cells = [f"{m.error:.2f} | {m.psnr:.1f} | {m.cpu_seconds:.2f}" if m else " | | " for m in rows]
        print(f"| {name} | " + " | ".join(cells) + " |")


def _parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--settings", nargs="*", choices=SETTINGS, default=["presets"], help="what to measure"
    )
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("--size", default="160x90", help="WIDTHxHEIGHT of the image")
    parser.add_argument("--out", type=Path, default=WORK / "quality")
    return parser.parse_args()


def measure(stage: str, wanted: dict[str, Cycles], options: argparse.Namespace) -> dict[str, Measurement]:
    """Measure the settings on a scene, as far as that has not been done before."""
    width, height = (int(side) for side in options.size.split("x"))
    folder = options.out / f"{stage}-{width}x{height}"
    blend = folder / "scene.blend"
    if not blend.exists():
        saved_scene(make_job(stage, (width, height), 3, out=options.out), folder)
    halves = {f"reference {seed}": {**REFERENCE, "seed": seed} for seed in REFERENCE_SEEDS}
    took = _render(blend, {**halves, **wanted}, folder)
    first, second = (_picture(folder, name) for name in halves)
    reference = (first + second) / 2
    noise = float(np.mean((first - second) ** 2)) / 4
    found = {}
    for name in wanted:
        squares = float(np.mean((_picture(folder, name) - reference) ** 2))
        error = max(squares - noise, 0.0) ** 0.5
        found[name] = Measurement(
            error, took[_file_name(name)]["cpu_seconds"], took[_file_name(name)]["seconds"]
        )
    return found


def _render(blend: Path, wanted: dict[str, Cycles], folder: Path) -> dict[str, dict[str, float]]:
    """Render what is wanted and not there yet, in one Blender; return what each took."""
    kept, measured = folder / "kept.json", folder / "measured.json"
    took: dict[str, dict[str, float]] = {}
    for file in (kept, measured):  # the second is what an interrupted run left
        took |= json.loads(file.read_text()) if file.exists() else {}
    kept.write_text(json.dumps(took, indent=1), encoding="utf-8")
    missing = {name: values for name, values in wanted.items() if _file_name(name) not in took}
    if missing:
        spec = folder / "settings.json"
        entries = [
            {"key": _file_name(name), "cycles": {**BLENDER_DEFAULT, **values}}
            for name, values in missing.items()
        ]
        spec.write_text(json.dumps(entries), encoding="utf-8")
        measured.unlink(missing_ok=True)
        blender("stills", blend, spec, folder, log=folder / "blender.log")
        took |= json.loads(measured.read_text())
        kept.write_text(json.dumps(took, indent=1), encoding="utf-8")
    return took


def _file_name(name: str) -> str:
    return "".join(c if c.isalnum() or c in "-." else "_" for c in name)


def _picture(folder: Path, name: str) -> np.ndarray:
    with Image.open(folder / f"{_file_name(name)}.png") as image:
        return np.asarray(image.convert("RGB"), dtype=np.float64)


if __name__ == "__main__":
    main()
