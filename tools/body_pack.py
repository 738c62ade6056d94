"""Pack a full SMPL-X-schema model into the lean form that ships in the package.

Usage: python tools/body_pack.py FULL.npz LEAN.npz
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from whacamole.body.lean import pack, unpack
from whacamole.body.model import BodyModel
from whacamole.body.schema import write_npz
from whacamole.errors import BodyModelError


def pack_file(full: Path, lean: Path) -> str:
    """Write ``lean`` from ``full`` and return a line with the sizes and the largest loss of each kind.

    Raises:
        BodyModelError: ``full`` cannot be read.
    """
    model = BodyModel.load(full)
    packed = pack(model.arrays)
    write_npz(lean, packed)
    before, after = model.arrays, unpack(packed, lean.name)
    shape = np.abs(before.shapedirs - after.shapedirs).max()
    pose = np.abs((before.posedirs - after.posedirs).data).max(initial=0.0)
    weight = np.abs(before.weights - after.weights).max()
    return (
        f"{lean}: {lean.stat().st_size:,} bytes (was {full.stat().st_size:,}); largest change: "
        f"shape {shape * 1e6:.1f} µm a unit, pose {pose * 1e6:.1f} µm a unit, weight {weight:.1e}"
    )


def main() -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("full", type=Path)
    parser.add_argument("lean", type=Path)
    args = parser.parse_args()
    try:
        print(pack_file(args.full, args.lean))
    except BodyModelError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
