"""The documentation of motions is true: its code runs, its tables are those of the readers and the clips."""

import re
from pathlib import Path

import numpy as np
import pytest

from whacamole.motion import embedded_motions, find, find_motions, read, read_motion
from whacamole.motion.readers import READERS

DOC = Path(__file__).parents[3] / "docs" / "motions.md"
TEXT = DOC.read_text()
BLOCKS = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)


def test_the_first_example_runs(capsys):
    exec(compile(BLOCKS[0], str(DOC), "exec"), {})
    assert len(capsys.readouterr().out.splitlines()) == len(find_motions(embedded_motions()))


def test_the_reader_of_the_documentation_reads(tmp_path, monkeypatch, truth):
    names: dict[str, object] = {}
    exec(compile(BLOCKS[1], str(DOC), "exec"), names)
    reader = names["READER"]
    monkeypatch.setattr(find, "READERS", (reader, *READERS))
    samples = truth(60.0).in_axes("+y")
    np.savez(
        tmp_path / "body.npz",
        global_orient=samples.pose[:, 0], body_pose=samples.pose[:, 1:22], transl=samples.pelvis, fps=60.0,
    )  # fmt: skip
    motion = read_motion(tmp_path / "body.npz")
    assert motion.source == "smplx-parameters"
    np.testing.assert_array_equal(motion.people[0].body_pose, samples.pose[::2, 1:22])
    assert read.recognise is find.recognise


@pytest.mark.parametrize("reader", READERS, ids=lambda reader: reader.name)
def test_every_reader_is_in_the_table(reader):
    row = next(line for line in TEXT.splitlines() if line.startswith(f"| `{reader.name}` |"))
    cells = [cell.strip() for cell in row.strip("|").split("|")]
    assert cells[1].startswith(reader.title)
    assert cells[4].replace("−", "-") == reader.up.removeprefix("+")
    assert int(cells[5]) == (2 if reader.pair else reader.people)


def test_the_embedded_motions_are_those_of_the_table():
    lengths: dict[str, int] = {}
    for line in TEXT.split("## The embedded motions")[1].splitlines():
        if line.startswith("| `"):
            names, _, frames = (cell.strip() for cell in line.strip("|").split("|"))
            lengths |= zip(re.findall(r"`(\w+)`", names), map(int, frames.split(",")), strict=True)
    assert lengths == {file.id: file.num_frames for file in find_motions(embedded_motions())}
