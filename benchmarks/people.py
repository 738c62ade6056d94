"""What people cost: ``python benchmarks/people.py``.

* Building a take in a fresh process, body, wardrobe and textures read from disk: wall and CPU time, imports
  left out.
* Rendering: CPU time of a frame with a dressed person against the same with the bare body, side by side.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from render_jobs import Material, Mesh, RenderJob, run_job
from render_jobs.quality import quality_preset
from whacamole.body import BodyModel
from whacamole.motion import embedded_motions, read_motion
from whacamole.production.filming import plan_camera
from whacamole.recipe import Recipe
from whacamole.stage import Places
from whacamole.take import Take, stage_take
from whacamole.wardrobe.palette import skin_tone

FRAMES: Final = 4
BUILD: Final = """
import sys, time
from pathlib import Path
from benchmarks.people import take_of
wall, cpu = time.perf_counter(), time.process_time()
take = take_of(sys.argv[1], sys.argv[2], int(sys.argv[3]), Path(sys.argv[4]))
print(time.perf_counter() - wall, time.process_time() - cpu, sum(len(p.meshes) for p in take.performers))
"""


def take_of(motion: str, stage: str, frames: int, textures: Path) -> Take:
    """A take as ``whacamole render`` builds it."""
    return stage_take(
        read_motion(embedded_motions() / f"{motion}.npz"), BodyModel.embedded(), frames=frames, seed=3,
        shot_index=0, textures=textures, places=Places((stage,)),
    )  # fmt: skip


def building(motion: str, stage: str, frames: int, runs: int) -> None:
    """Prints the best of some runs in processes of their own, each with an empty folder for textures."""
    best = None
    for _ in range(runs):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                [sys.executable, "-c", BUILD, motion, stage, str(frames), folder],
                cwd=Path(__file__).parents[1], capture_output=True, text=True, check=True,
            )  # fmt: skip
        wall, cpu, meshes = (float(x) for x in done.stdout.split())
        best = min(best or (wall, cpu, meshes), (wall, cpu, meshes))
    assert best is not None
    print(f"take of {frames} frames, {motion}, {stage}: {best[0]:.2f} s, {best[1]:.2f} s of CPU", flush=True)


def bare(take: Take) -> tuple[Mesh, ...]:
    """The people of a take without clothes and hair: one mesh each."""
    body, out = BodyModel.embedded(), []
    for person in take.performers:
        red, green, blue = skin_tone(person.role.member.tone) / 255
        material = Material(
            name="skin", base_color=(float(red), float(green), float(blue)), roughness=0.55, subsurface=0.08
        )
        faces = body.quads if body.quads is not None else body.faces
        name = f"bare-{person.track_id}"
        out.append(Mesh(name, person.posed.vertices, faces, material, track_id=person.track_id))
    return tuple(out)


def rendering(motion: str, stage: str, size: tuple[int, int], quality: str, folder: Path) -> None:
    """Prints the CPU time of a frame, dressed and bare, the first frame (which builds the scene) left out."""
    take = take_of(motion, stage, FRAMES, folder / "textures")
    plan = plan_camera(take, Recipe(size=size, frames=FRAMES, stages=(stage,)), 0)
    dressed = RenderJob(
        camera=plan.path,
        meshes=take.stage.meshes + tuple(mesh for person in take.performers for mesh in person.meshes),
        lights=take.stage.lights,
        environment=take.stage.environment,
        exposure=take.stage.exposure,
        quality=quality_preset(quality),
    )
    seconds = {}
    for name, job in (
        ("dressed", dressed),
        ("bare", replace(dressed, meshes=take.stage.meshes + bare(take))),
    ):
        job.save(folder / name)
        result = run_job(folder / name, device="cpu", timeout=None)
        seconds[name] = float(np.median([s for f, s in result.frame_cpu_seconds.items() if f > 0]))
    print(
        f"frame of {size[0]}x{size[1]}, {quality}, {motion}, {stage}: "
        f"dressed {seconds['dressed']:.2f} s of CPU, bare {seconds['bare']:.2f} s, "
        f"ratio {seconds['dressed'] / seconds['bare']:.2f}",
        flush=True,
    )


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--motion", default="walk")
    parser.add_argument("--stages", nargs="+", default=["plaza", "living-room"])
    parser.add_argument("--frames", type=int, default=240, help="of the take that is built")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--quality", default="standard")
    parser.add_argument("--size", type=int, nargs=2, default=(640, 360))
    options = parser.parse_args()
    for stage in options.stages:
        building(options.motion, stage, options.frames, options.runs)
    for stage in options.stages:
        with tempfile.TemporaryDirectory() as folder:
            rendering(options.motion, stage, tuple(options.size), options.quality, Path(folder))


if __name__ == "__main__":
    main()
