"""The rendering benchmarks in turn: ``python -m benchmarks.rendering``, about an hour on two cores.

Each can be run alone, with options of its own: ``python -m benchmarks.rendering.overhead --help``.
"""

import subprocess
import sys

RUNS = (
    ("overhead", "--frames", "24"),
    ("quality", "--settings", "presets", "default", "peers"),
    ("denoising",),
    ("side_by_side",),
    ("raster",),
    ("cost", "--size", "960x540"),
)

for name, *options in RUNS:
    print(f"\n== {name} {' '.join(options)}", flush=True)
    subprocess.run([sys.executable, "-m", f"benchmarks.rendering.{name}", *options], check=True)
