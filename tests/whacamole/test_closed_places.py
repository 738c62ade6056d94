"""Datasets that may only be read, and datasets that have travelled: one line that says what to do."""

import errno
import json

import pytest

from whacamole.cli import main
from whacamole.dataset.files import write_json
from whacamole.production.status import status_of
from whacamole.recipe import Recipe


@pytest.mark.parametrize("number", [errno.EACCES, errno.EROFS, errno.EPERM])
def test_a_place_that_cannot_be_written_to_is_told_in_one_line(monkeypatch, tmp_path, capsys, number):
    """As root may write everywhere, the system's refusal is played."""
    beside = tmp_path / ".README.md.1.part"

    def refuse(*_args, **_options):
        raise OSError(number, "no", str(beside))

    monkeypatch.setattr("whacamole.cli.app", refuse)
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 1
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert f"error: {tmp_path}: nothing can be written there (no); name another place" in told


def test_the_status_of_a_dataset_whose_motions_are_elsewhere(tmp_path):
    write_json(tmp_path / "recipe.json", Recipe(motions=tmp_path / "gone").save_as_dict())
    (tmp_path / "sequences" / "walk-00").mkdir(parents=True)
    write_json(tmp_path / "sequences" / "walk-00" / "sequence.json", {})
    state = status_of(tmp_path)
    assert (state.asked, state.finished) == (None, 1)
    assert "1 sequences finished (the motions of its recipe are not here" in state.as_text()
    assert json.loads(json.dumps(state.as_dict()))["asked"] is None
