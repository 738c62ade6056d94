"""Makes a dataset with the stand-in worker: ``python farm_driver.py OUT SEQUENCES [CLUSTER] [PART]``.

In a process of its own, so that a test can kill it. ``CLUSTER`` may be ``undisturbed``: then this very
process makes one sequence after the other, and leaves to the product what is done at the end.
"""

import os
import sys
from pathlib import Path

from farm_stand_in import make
from whacamole.dataset.files import write_json
from whacamole.production.means import Limits, Means, Shard
from whacamole.production.run import produce
from whacamole.production.worklist import work_of
from whacamole.recipe import Recipe

SEED = 7


def recipe(sequences: int) -> Recipe:
    """Embedded motions, as many sequences as asked for."""
    return Recipe(frames=4, engine="raster", seed=SEED, shots_per_motion=sequences, limit=sequences)


def main(out: Path, sequences: int, cluster: str | None = None, part: str | None = None) -> int:
    """Make the dataset; 0 where it is complete."""
    limits = Limits(
        threads=1,
        silence_s=10.0,
        time_s=60.0,
        memory_mb=600.0,
        disk_patience_s=float(os.environ.get("PATIENCE", "60")),
        worker=(sys.executable, str(Path(__file__).with_name("farm_stand_in.py"))),
    )
    if cluster == "undisturbed":
        for order in work_of(recipe(sequences), out.resolve()).orders:
            make(order, lambda event, **facts: None)
        write_json(out / "recipe.json", recipe(sequences).save_as_dict())
        cluster = None
    means = Means(
        jobs=4,
        cluster=cluster or None,
        shard=Shard.parse(part) if part else None,
        attempts=6,  # a starved machine may take a slow start for a hang
        limits=limits,
        pause_s=0.5,
    )
    result = produce(recipe(sequences), out, means)
    result.report()
    return 0 if result.complete else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), int(sys.argv[2]), *sys.argv[3:]))
