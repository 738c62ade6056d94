"""``whacamole evaluate`` as it is typed: tables, files, one line for every fault, exit codes."""

import json
import shutil

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from whacamole.cli.evaluate import evaluate as command
from whacamole.errors import EvaluationError
from whacamole.evaluation import PROTOCOLS, Result


@pytest.fixture(scope="module")
def run():
    app = typer.Typer(pretty_exceptions_enable=False)
    app.command()(command)
    runner = CliRunner()

    def call(*words):
        return runner.invoke(app, [str(word) for word in words])

    return call


@pytest.fixture(scope="module")
def predictions(scenes, make, tmp_path_factory):
    root = tmp_path_factory.mktemp("pred") / "noisy"
    return make["predictions"](root, {s.id: make["prediction"](s, noise=0.02) for s in scenes})


def test_the_headline_and_exit_code_0(run, dataset, predictions):
    done = run("--data", dataset, "--pred", predictions, "--vertices", "none")
    assert done.exit_code == 0, done.output
    assert "PA-MPJPE" in done.stdout
    assert "noisy" in done.stdout
    assert "Coverage" in done.stdout


def test_faults_are_one_line_each_the_rest_is_scored_and_the_exit_code_is_1(
    run, dataset, predictions, scenes, tmp_path
):
    folder = shutil.copytree(predictions, tmp_path / "faulty")
    (folder / "made-0.npz").write_bytes(b"PK\x03\x04 cut off")
    (folder / "made-2.npz").unlink()
    done = run("--data", dataset, "--pred", folder, "--vertices", "none", "--json", tmp_path / "r.json")
    assert done.exit_code == 1
    lines = [line for line in done.stderr.splitlines() if line.startswith("faulty · ")]
    assert len(lines) == 2
    assert "made-0.npz: damaged" in lines[0]
    assert "no prediction for made-2" in lines[1]
    assert "Traceback" not in done.output
    data = json.loads((tmp_path / "r.json").read_text())
    assert list(data["methods"][0]["sequences"]) == ["made-1"]
    assert list(data["methods"][0]["failures"]) == ["made-0", "made-2"]
    shapes = dict(np.load(predictions / "made-1.npz"))
    shapes["body_pose"] = shapes["body_pose"][:, :3]
    np.savez(folder / "made-1.npz", **shapes)
    nothing = run("--data", dataset, "--pred", folder, "--vertices", "none")
    assert nothing.exit_code == 1
    assert "'body_pose' is 2×3×21×3" in nothing.stderr


def test_two_methods_every_output_and_a_saved_result(run, dataset, predictions, scenes, make, tmp_path):
    exact = make["predictions"](tmp_path / "exact", {s.id: make["prediction"](s) for s in scenes})
    done = run(
        "--data", dataset, "--pred", predictions, "--pred", f"oracle={exact}", "--vertices", "200",
        "--tables", "all", "--style", "markdown", "--html", tmp_path / "r.html",
        "--plots", tmp_path / "plots", "--json", tmp_path / "r.json", "--save", tmp_path / "r.npz",
        "--jobs", "2",
    )  # fmt: skip
    assert done.exit_code == 0, done.output
    assert "**oracle minus noisy**" in done.stdout
    assert "<svg" in (tmp_path / "r.html").read_text()
    assert len(list((tmp_path / "plots").glob("*.svg"))) == 6
    assert len(Result.load(tmp_path / "r.npz").methods) == 2
    again = run("--with", tmp_path / "r.npz", "--style", "latex", "--tables", "paper")
    assert again.exit_code == 0
    assert r"\begin{tabular}" in again.stdout
    third = make["predictions"](tmp_path / "third", {s.id: make["prediction"](s, noise=0.01) for s in scenes})
    beside = run("--data", dataset, "--pred", third, "--with", tmp_path / "r.npz", "--vertices", "none")
    assert beside.exit_code == 0
    assert "oracle minus third" in beside.stdout


def test_json_on_the_screen_is_json_alone(run, dataset, predictions):
    done = run("--data", dataset, "--pred", predictions, "--vertices", "none", "--json", "-", "--limit", "1")
    assert json.loads(done.stdout)["methods"][0]["name"] == "noisy"


def test_quiet_prints_nothing(run, dataset, predictions):
    done = run("--data", dataset, "--pred", predictions, "--vertices", "none", "--quiet", "--limit", "1")
    assert (done.exit_code, done.stdout) == (0, "")


@pytest.mark.parametrize("name", PROTOCOLS)
def test_the_choices_of_every_protocol_are_printed(run, name):
    done = run("--protocol", name, "--show-protocol")
    assert done.exit_code == 0
    for choice, value, _ in PROTOCOLS[name].choices():
        assert any(line.split()[:2] == [choice, value] for line in done.stdout.splitlines()), choice


def test_a_choice_can_be_set(run, dataset, predictions):
    shown = run("--set", "segment_frames=none", "--set", "with_scale=false", "--show-protocol")
    assert ["segment_frames", "none"] in [line.split()[:2] for line in shown.stdout.splitlines()]
    done = run(
        "--data",
        dataset,
        "--pred",
        predictions,
        "--vertices",
        "none",
        "--set",
        "segment_frames=20",
        "--limit",
        "1",
    )
    assert "W-MPJPE 20" in done.stdout
    assert "protocol whac*" in done.stdout


FAULTS = {
    "no such protocol": (["--protocol", "best"], "only whac, wham"),
    "no such choice": (["--set", "joint=1"], "no choice 'joint'"),
    "no value": (["--set", "joints"], "CHOICE=VALUE"),
    "a wrong value": (["--set", "segment_frames=many"], "expected a value like 100"),
    "a wrong word": (["--set", "joints=body99"], "expected one of body22"),
    "a wrong truth": (["--set", "with_scale=maybe"], "expected a value like true"),
    "nothing": ([], "nothing to score"),
    "no predictions": (["--data", "DATA"], "add --pred"),
    "no data": (["--data", "nowhere", "--pred", "PRED"], "not a folder"),
    "no folder": (["--data", "DATA", "--pred", "nowhere"], "not a folder"),
    "the same name twice": (["--data", "DATA", "--pred", "PRED", "--pred", "PRED"], "a second method"),
    "vertices": (["--data", "DATA", "--pred", "PRED", "--vertices", "most"], "all, none or a number"),
    "style": (["--data", "DATA", "--pred", "PRED", "--style", "word"], "only text"),
    "split": (["--data", "DATA", "--pred", "PRED", "--split", "train"], "train.txt"),
    "format": (["--data", "DATA", "--pred", "PRED", "--pred-format", "x"], "no prediction format"),
    "body model": (["--data", "DATA", "--pred", "PRED", "--body-model", "no.npz"], "not there"),
    "saved": (["--with", "no.npz"], "no saved result"),
    "regressor": (["--data", "DATA", "--pred", "PRED", "--joint-regressor", "no.npy"], "not a plain array"),
    "map": (["--data", "DATA", "--pred", "PRED", "--vertex-map", "no.npz"], "not there"),
}


@pytest.mark.parametrize("what", FAULTS)
def test_a_wrong_option_is_one_line(run, dataset, predictions, what, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    words, said = FAULTS[what]
    done = run(*({"DATA": dataset, "PRED": predictions}.get(word, word) for word in words))
    assert isinstance(done.exception, EvaluationError)
    assert said in str(done.exception)
    assert "\n" not in str(done.exception)
