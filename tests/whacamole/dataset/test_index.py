"""dataset.json follows from the finished sequences alone, and the side of a motion from its id."""

from pathlib import Path

import pytest

from whacamole.dataset import DatasetLayout, read_json, read_summary, side_of, write_index, write_summary
from whacamole.dataset.files import sha256_of
from whacamole.errors import DatasetError


def _finish(layout: DatasetLayout, sequence_id: str, motion_id: str) -> None:
    sequence = layout.sequence(sequence_id)
    (sequence.folder / "rgb").mkdir(parents=True)
    (sequence.folder / "rgb" / "000000.jpg").write_bytes(sequence_id.encode())
    sequence.camera.write_bytes(b"camera")
    write_summary(sequence, {"id": sequence_id, "motion_id": motion_id})


def test_the_share_of_the_test_split_is_what_was_asked() -> None:
    sides = [side_of(f"motion {index}", 0.2) for index in range(20000)]
    assert abs(sides.count("test") / len(sides) - 0.2) < 0.01  # 3.5 standard deviations


def test_checksums_lead_from_the_index_to_every_file(tmp_path: Path) -> None:
    layout = DatasetLayout(tmp_path)
    _finish(layout, "walk-00", "walk")
    write_index(layout, {"seed": 3})
    index = read_json(layout.index)
    assert index["seed"] == 3
    sequence = layout.sequence("walk-00")
    assert index["sequences"][0]["checksums"]["sequence.json"] == sha256_of(sequence.summary)
    for name, digest in read_summary(sequence)["checksums"].items():
        assert sha256_of(sequence.folder / name) == digest


def test_the_index_is_the_same_whatever_the_order_of_making(tmp_path: Path) -> None:
    written = []
    for order in (("a", "b", "c"), ("c", "a", "b")):
        layout = DatasetLayout(tmp_path / "".join(order))
        for name in order:
            _finish(layout, f"{name}-00", name)
        write_index(layout, {})
        written.append(layout.index.read_bytes())
    assert written[0] == written[1]


@pytest.mark.parametrize("sequence_id", ["..", "a/b", "", "a b", "../etc"])
def test_no_sequence_id_leaves_the_dataset(tmp_path: Path, sequence_id: str) -> None:
    with pytest.raises(DatasetError, match="sequence id"):
        DatasetLayout(tmp_path).sequence(sequence_id)


def test_a_broken_summary_is_named(tmp_path: Path) -> None:
    layout = DatasetLayout(tmp_path)
    layout.sequence("walk-00").folder.mkdir(parents=True)
    layout.sequence("walk-00").summary.write_text("{", encoding="utf-8")
    with pytest.raises(DatasetError, match=r"sequence\.json"):
        read_summary(layout.sequence("walk-00"))
