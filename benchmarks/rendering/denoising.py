"""What is left of a denoised picture's error, and what better guides would save.

``python -m benchmarks.rendering.denoising`` takes frames of 16 samples with seeds of their own and prints,
for each scene, the error as ``benchmarks.rendering.quality`` has it; for the first row, where frames share no
sample, also its two parts: that of the mean over seeds, which the denoiser makes, and the spread. Rows:

``as rendered``      the denoiser as ``standard`` uses it
``guides of N``      albedo and normal from N samples
``light apart``      diffuse and glossy light denoised by themselves, times colours of N samples
``light of 3``       the same with the light of three such frames, as if neighbours could be had without loss

The samples of guides and colours are those of other seeds, which is what a view layer without light would
give. What such a layer costs is printed last, as is what a frame costs without persistent data. Pass images
are kept in ``--out``.
"""

from __future__ import annotations

import argparse
import ctypes
import os
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.metadata import distribution
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from benchmarks.rendering.quality import BASE, BLENDER_DEFAULT, REFERENCE_SEEDS, measure, ours
from benchmarks.rendering.scenes import SCENES, WORK
from render_jobs.images import read_exr

Floats = NDArray[np.float32]

SAMPLES = 16
GREY = 0.5
"""An albedo that says nothing."""

LIGHTS = (("Diff", "diffuse"), ("Gloss", "glossy"))
PASSES = [f"{kind}_{part}" for _, kind in LIGHTS for part in ("direct", "indirect", "color")]
RT_FLOAT3, OIDN_CPU = 3, 1


@dataclass(frozen=True)
class Parts:
    """The passes of a frame, linear, each (H, W, 3)."""

    picture: Floats
    albedo: Floats
    normal: Floats
    colours: tuple[Floats, ...]
    lights: tuple[Floats, ...]
    glow: Floats
    """What shines by itself, and the background."""

    @classmethod
    def read(cls, path: Path) -> Parts:
        """Read the layers that :func:`render` wrote."""
        layers = read_exr(path)

        def layer(name: str, axes: str = "RGB") -> Floats:
            return np.stack([layers[f"beauty.{name}.{axis}"] for axis in axes], axis=-1).astype(np.float32)

        colours = tuple(layer(f"{kind}Col") for kind, _ in LIGHTS)
        lights = tuple(layer(f"{kind}Dir") + layer(f"{kind}Ind") for kind, _ in LIGHTS)
        normal = layer("Denoising Normal", "XYZ")
        glow = layer("Emit") + layer("Env")
        return cls(layer("Combined"), layer("Denoising Albedo"), normal, colours, lights, glow)

    @classmethod
    def mean(cls, parts: Sequence[Parts]) -> Parts:
        """The frame of all their samples; light is weighed by the colour that it fell on."""
        colours = tuple(_mean([one.colours[i] for one in parts]) for i in range(len(LIGHTS)))
        lights = tuple(
            _mean([one.colours[i] * one.lights[i] for one in parts]) / np.maximum(colours[i], 1e-6)
            for i in range(len(LIGHTS))
        )
        picture, albedo, normal, glow = (
            _mean([getattr(one, name) for one in parts]) for name in ("picture", "albedo", "normal", "glow")
        )
        return cls(picture, albedo, normal, colours, lights, glow)


def _mean(images: Sequence[Floats]) -> Floats:
    return np.asarray(np.mean(images, axis=0), dtype=np.float32)


class Denoiser:
    """Blender's own copy of Open Image Denoise, at its highest quality."""

    def __init__(self) -> None:
        library = distribution("bpy").locate_file("bpy/lib/libOpenImageDenoise.so.2")
        self._lib: Any = ctypes.CDLL(str(library))
        self._lib.oidnNewDevice.restype = self._lib.oidnNewFilter.restype = ctypes.c_void_p
        self._device = ctypes.c_void_p(self._lib.oidnNewDevice(OIDN_CPU))
        self._lib.oidnCommitDevice(self._device)

    def __call__(self, **images: Floats) -> Floats:
        """Denoise ``color`` by clean ``albedo`` and ``normal``, or one of these by itself."""
        filter_ = ctypes.c_void_p(self._lib.oidnNewFilter(self._device, b"RT"))
        held = {name: np.ascontiguousarray(image, np.float32) for name, image in images.items()}
        held["output"] = np.zeros_like(next(iter(held.values())))
        height, width, _ = held["output"].shape
        for name, image in held.items():
            size = [ctypes.c_size_t(n) for n in (width, height, 0, 0, 0)]
            where = ctypes.c_void_p(image.ctypes.data)
            self._lib.oidnSetSharedFilterImage(filter_, name.encode(), where, RT_FLOAT3, *size)
        if "color" in images:
            self._lib.oidnSetFilterBool(filter_, b"hdr", ctypes.c_bool(True))
            self._lib.oidnSetFilterBool(filter_, b"cleanAux", ctypes.c_bool(True))
        self._lib.oidnCommitFilter(filter_)
        self._lib.oidnExecuteFilter(filter_)
        error = ctypes.c_char_p()
        if self._lib.oidnGetDeviceError(self._device, ctypes.byref(error)):
            raise SystemExit(f"the denoiser failed: {error.value!r}")
        self._lib.oidnReleaseFilter(filter_)
        return held["output"]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("--size", default="160x90", help="WIDTHxHEIGHT of the image")
    parser.add_argument("--seeds", type=int, default=16)
    parser.add_argument("--out", type=Path, default=WORK / "quality", help="that of the quality benchmark")
    options = parser.parse_args()
    _keep_blender_quiet(options.out / "denoising.log")
    print("| scene | picture | error | of the mean | spread |\n|---|---|---|---|---|")
    costs = []
    for stage in options.scenes:
        measure(stage, {}, options)  # the scene and its references
        folder = options.out / f"{stage}-{options.size}"
        frames = render(folder, options.seeds)
        study(stage, folder, frames)
        costs.append(cost(stage, folder))
    print("\n| scene | ms of CPU a sample | without light and bounces | CPU s a frame, one sample | without "
          "persistent data |\n|---|---|---|---|---|")  # fmt: skip
    print("\n".join(costs), flush=True)
    os._exit(0)  # taking Blender down at the interpreter's exit can hang


def _keep_blender_quiet(log: Path) -> None:
    """Send what Blender prints to a file; our own words go where they went."""
    log.parent.mkdir(parents=True, exist_ok=True)
    sys.stdout = os.fdopen(os.dup(1), "w", buffering=1, encoding="utf-8")
    with log.open("ab") as file:
        os.dup2(file.fileno(), 1)


def render(folder: Path, seeds: int) -> list[Parts]:
    """The measured frame with each of the seeds."""
    scene = _open(folder)
    layer = scene.view_layers["beauty"]
    for name in (*PASSES, "emit", "environment"):
        setattr(layer, f"use_pass_{name}", True)
    layer.cycles.denoising_store_passes = True
    paths = [folder / "parts" / f"{seed:02d}.exr" for seed in range(seeds)]
    for seed, path in enumerate(paths):
        if not path.exists():
            _render(scene, path, samples=SAMPLES, seed=seed)
    return [Parts.read(path) for path in paths]


def study(stage: str, folder: Path, frames: Sequence[Parts]) -> None:
    """Print the rows of a scene."""
    scene, denoise = _open(folder), Denoiser()
    halves = [_png(folder / f"reference_{seed}.png") for seed in REFERENCE_SEEDS]
    reference, noise = (halves[0] + halves[1]) / 2, float(np.mean((halves[0] - halves[1]) ** 2)) / 4

    def guided(frame: Parts, guides: Parts) -> Floats:
        albedo, normal = denoise(albedo=guides.albedo), denoise(normal=guides.normal)
        return denoise(color=frame.picture, albedo=albedo, normal=normal)

    def apart(frame: Parts, guides: Parts) -> Floats:
        normal, grey = denoise(normal=guides.normal), np.full_like(guides.normal, GREY)
        pairs = zip(guides.colours, frame.lights, strict=True)
        return guides.glow + np.sum(
            [colour * denoise(color=light, albedo=grey, normal=normal) for colour, light in pairs], axis=0
        )

    def row(name: str, way: Callable[[Parts, Parts], Floats], guides: int, light: int = 1) -> None:
        shown = np.stack(
            [
                _shown(scene, way(Parts.mean(_some(frames, i, light)), Parts.mean(_some(frames, i, guides))))
                for i in range(len(frames))
            ]
        )
        spread = float(np.mean(np.var(shown, axis=0, ddof=1)))
        error = float(np.mean((shown - reference) ** 2)) - noise
        mean = max(error - spread, 0.0) ** 0.5
        parts = f"{mean:.2f} | {spread**0.5:.2f}" if guides == light == 1 else "|"
        print(f"| {stage} | {name} | {error**0.5:.2f} | {parts} |", flush=True)

    row("as rendered", guided, 1)
    for count in (3, 5, len(frames)):
        row(f"guides of {count * SAMPLES}", guided, count)
        row(f"light apart, colours of {count * SAMPLES}", apart, count)
        row(f"light of 3, colours of {count * SAMPLES}", apart, count, 3)


def _some(frames: Sequence[Parts], first: int, count: int) -> list[Parts]:
    return [frames[(first + step) % len(frames)] for step in range(count)]


def cost(stage: str, folder: Path) -> str:
    """The row on what a sample costs with and without light, and a frame with and without persistent data."""
    import bpy

    scene = _open(folder)
    whole = _cpu_of_a_sample(scene, folder)
    dark = bpy.data.worlds.new("dark")
    dark.use_nodes = True
    background: Any = dark.node_tree
    background.nodes["Background"].inputs["Strength"].default_value = 0.0
    scene.world = dark
    for entity in [entity for entity in scene.objects if entity.type == "LIGHT"]:
        bpy.data.objects.remove(entity)
    bare = _cpu_of_a_sample(scene, folder, max_bounces=0)
    kept, anew = (_cpu_of_a_frame(folder, persistent=persistent) for persistent in (True, False))
    return f"| {stage} | {whole * 1000:.1f} | {bare * 1000:.1f} | {kept:.2f} | {anew:.2f} |"


def _cpu_of_a_sample(scene: Any, folder: Path, **changes: Any) -> float:
    few, many = 8, 40
    _render(scene, folder / "parts" / "cost.exr", samples=1, **changes)
    spent = [_render(scene, folder / "parts" / "cost.exr", samples=n, **changes) for n in (few, many)]
    return (spent[1] - spent[0]) / (many - few)


def _cpu_of_a_frame(folder: Path, *, persistent: bool) -> float:
    import bpy

    scene = _open(folder)
    _set(scene, samples=1)
    scene.render.use_persistent_data = persistent
    scene.render.filepath = str((folder / "parts" / "frame_").resolve())
    scene.frame_start = scene.frame_end = 0
    bpy.ops.render.render(animation=True)
    scene.frame_end = 2
    began = time.process_time()
    bpy.ops.render.render(animation=True)
    return (time.process_time() - began) / 3


def _open(folder: Path) -> Any:
    import bpy

    bpy.ops.wm.open_mainfile(filepath=str((folder / "scene.blend").resolve()))
    scene: Any = bpy.context.scene
    for layer in scene.view_layers:
        layer.use = layer.name == "beauty"
    scene.frame_set(1)
    return scene


def _set(scene: Any, **changes: Any) -> None:
    for name, value in {**BLENDER_DEFAULT, **ours(BASE), "use_denoising": False, **changes}.items():
        setattr(scene.cycles, name, value)
    scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    scene.render.image_settings.color_depth = "32"


def _render(scene: Any, path: Path, **changes: Any) -> float:
    """Render to a file of layers without denoising; return the CPU seconds."""
    import bpy

    _set(scene, **changes)
    scene.render.filepath = str(path.resolve())
    scene.update_tag()
    scene.frame_set(scene.frame_current)
    began = time.process_time()
    bpy.ops.render.render(write_still=True)
    return time.process_time() - began


def _shown(scene: Any, linear: Floats) -> NDArray[np.float64]:
    """A linear picture as the scene shows it, in 8-bit levels."""
    import bpy

    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "PNG", "RGB", "8"
    height, width, _ = linear.shape
    image: Any = bpy.data.images.new("shown", width, height, float_buffer=True)
    image.colorspace_settings.name = "Linear Rec.709"
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = linear[::-1]
    image.pixels.foreach_set(pixels.ravel())
    path = WORK.resolve() / f"shown-{os.getpid()}.png"
    path.parent.mkdir(parents=True, exist_ok=True)
    image.save_render(str(path), scene=scene)
    bpy.data.images.remove(image)
    shown = _png(path)
    path.unlink()
    return shown


def _png(path: Path) -> NDArray[np.float64]:
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"), dtype=np.float64)


if __name__ == "__main__":
    main()
