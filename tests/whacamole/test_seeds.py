"""Random choices depend on what a sequence is, and on nothing else."""

import subprocess
import sys

from whacamole.seeds import generator, stable_hash


def test_the_hash_is_the_same_in_another_process() -> None:
    # Python's own string hash is salted per process; this one must not be.
    code = "from whacamole.seeds import stable_hash; print(stable_hash('walk'))"
    other = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert int(other.stdout) == stable_hash("walk")


def test_the_same_key_draws_the_same_numbers() -> None:
    first, second = (generator(7, "walk", 2, "camera").random(8) for _ in range(2))
    assert first.tolist() == second.tolist()


def test_every_part_of_the_key_matters() -> None:
    keys = [
        (7, "walk", 2, "camera"),
        (8, "walk", 2, "camera"),
        (7, "run", 2, "camera"),
        (7, "walk", 3, "camera"),
    ]
    draws = {generator(*key).random() for key in [*keys, (7, "walk", 2, "stage")]}
    assert len(draws) == 5
