"""A plan as plain data, judged later from its document and the arrays of its camera."""

import json
from dataclasses import replace

import numpy as np
import pytest

from camera_rigs import Limits, Obstacle, PlanError, Shake, World, direct, judge_document

WORLD = World(
    obstacles=(Obstacle((3.0, 1.0, 0.5), (0.5, 0.5, 1.0), 0.3, "box"),), bounds=((-9, -9, 0), (9, 9, 5))
)


@pytest.fixture(scope="module")
def plan(rig):
    return direct(rig.dancer(150), rig.lens(), WORLD, "all", np.random.default_rng(3), shake=Shake())


@pytest.fixture
def document(plan):
    return json.loads(json.dumps(plan.to_json(), allow_nan=False))


def judged(plan, document, **options):
    path = plan.path
    return judge_document(document, path.K, path.T_world_camera, path.width, path.height, **options)


def test_the_document_is_what_it_says(plan, document):
    assert document["format"] == 1
    assert [shot["kind"] for shot in document["shots"]] == [shot.kind for shot in plan.shots]
    first = document["shots"][0]
    assert {"kind", "scale", "start", "end", "parameters", "keyframes"} == set(first)
    assert {"frame", "r", "theta", "phi", "heading", "location", "target", "focal", "frac"} == set(
        first["keyframes"][0]
    )
    assert len(plan.keyframes) == sum(len(shot["keyframes"]) for shot in document["shots"])


def test_a_stored_plan_is_judged_like_the_plan(plan, document):
    assert judged(plan, document) == plan.findings == ()


def test_limits_of_one_s_own(plan, document):
    strict = replace(Limits(), ground=1.9, person=5.0)
    assert {"ground", "person"} == {finding.rule for finding in judged(plan, document, limits=strict)}


def test_a_camera_that_was_tampered_with_is_found(plan, document):
    pose = plan.path.T_world_camera.copy()
    pose[70:, :3, 3] += [0.0, 0.0, 0.4]
    findings = judge_document(document, plan.path.K, pose, plan.path.width, plan.path.height)
    assert {"acceleration", "jerk", "speed"} & {finding.rule for finding in findings}


@pytest.mark.parametrize("entry", ["format", "shots", "subject", "world", "limits", "shake"])
def test_a_document_that_lacks_an_entry_is_refused(plan, document, entry):
    del document[entry]
    with pytest.raises(PlanError) as caught:
        judged(plan, document)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"format": 99}, "reads format 1"),
        ({"shots": []}, "no shots"),
        ({"shots": [{"kind": "arc-horizontal"}]}, "missing"),
        ({"limits": {"sloth": 1.0}}, "sloth"),
        ({"shake": {"millimetres": -1.0}}, "band"),
        ({"world": {"ground_z": 0.0, "obstacles": [{}], "bounds": None}}, "center"),
    ],
)
def test_a_document_with_a_wrong_entry_is_refused(plan, document, change, message):
    with pytest.raises(PlanError, match=message):
        judged(plan, {**document, **change})


def test_an_unknown_kind_or_scale_is_refused(plan, document):
    for name in ("kind", "scale"):
        shots = [{**document["shots"][0], name: "wobble"}]
        with pytest.raises(PlanError, match="wobble"):
            judged(plan, {**document, "shots": shots})


def test_a_shot_without_its_parameters_is_refused(plan, document):
    shots = [{**shot, "kind": "tracking", "parameters": {}} for shot in document["shots"]]
    with pytest.raises(PlanError, match="is missing"):
        judged(plan, {**document, "shots": shots})


def test_a_camera_of_another_length_is_refused(plan, document):
    path = plan.path
    with pytest.raises(PlanError, match="do not belong"):
        judge_document(document, path.K[1:], path.T_world_camera[1:], path.width, path.height)
