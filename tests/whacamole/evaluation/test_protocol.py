"""Protocols: named values that print, parse and stand in the documentation."""

import json
from dataclasses import fields, replace
from pathlib import Path

import pytest

from whacamole.evaluation import METRICS, PROTOCOLS, EvaluationError, Protocol
from whacamole.evaluation.protocol import ABOUT, protocol_named, spell

DOC = Path(__file__).parents[3] / "docs" / "metrics.md"


def test_what_the_field_says_about_each():
    """The choices on which public evaluators differ, as their code has them."""
    p = PROTOCOLS
    assert {name: p[name].segment_frames for name in p} == {
        "whac": 100, "wham": 100, "tram": 100, "gvhmr": 100, "emdb": 100, "bedlam2": None
    }  # fmt: skip
    assert {name: p[name].tail for name in ("wham", "tram", "gvhmr")} == {
        "wham": "own",
        "tram": "tram",
        "gvhmr": "own",
    }
    assert [p[name].accel_trim for name in ("wham", "tram", "gvhmr", "bedlam2")] == [1, 1, 0, 0]
    assert [p[name].rte_root for name in ("wham", "tram", "gvhmr")] == ["transl", "joint", "joint"]
    assert (p["tram"].smooth_root, p["tram"].betas) == (3.0, "mean")
    assert {p[name].root for name in ("wham", "tram", "gvhmr", "emdb", "bedlam2")} == {"hips"}
    assert (p["emdb"].jitter_joints, p["emdb"].pa_vertices) == ("emdb", "joints")
    assert all(p[name].fit_frames == 2 and p[name].with_scale for name in p)
    assert all(p[name].still_speed == pytest.approx(0.30) for name in p)


def test_every_choice_is_explained_and_every_headline_metric_exists():
    names = {field.name for field in fields(Protocol)} - {"name", "headline"}
    assert names == set(ABOUT)
    for protocol in PROTOCOLS.values():
        assert set(protocol.headline) <= set(METRICS)


@pytest.mark.parametrize("protocol", PROTOCOLS.values(), ids=PROTOCOLS)
def test_it_comes_back_from_json_and_from_its_own_words(protocol):
    assert Protocol.from_dict(json.loads(json.dumps(protocol.as_dict()))) == protocol
    spelled = {name: value for name, value, _ in protocol.choices()}
    assert replace(PROTOCOLS["whac"].with_choices(spelled), name="", headline=()) == replace(
        protocol, name="", headline=()
    )


def test_names():
    assert protocol_named("wham") is PROTOCOLS["wham"]
    assert protocol_named(PROTOCOLS["wham"]) is PROTOCOLS["wham"]
    with pytest.raises(EvaluationError, match="only whac"):
        protocol_named("mine")


@pytest.mark.parametrize(
    "change", [{"segment_frames": -1}, {"fit_frames": 0}, {"fps": -30.0}, {"still_speed": 0.0}]
)
def test_impossible_numbers_are_refused(change):
    with pytest.raises(EvaluationError, match="more than 0"):
        replace(PROTOCOLS["whac"], **change)


def test_the_documentation_sets_them_side_by_side():
    text = DOC.read_text(encoding="utf-8")
    head = "| choice | " + " | ".join(PROTOCOLS) + " |"
    assert head in text
    for name in ABOUT:
        values = (spell(getattr(p, name)) for p in PROTOCOLS.values())
        assert f"| `{name}` | {' | '.join(values)} |" in text, name


def test_the_documentation_defines_every_metric():
    text = DOC.read_text(encoding="utf-8")
    for metric in METRICS.values():
        assert f"`{metric.key}`" in text, metric.key
