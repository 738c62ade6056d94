"""The cast: one person a seed, believable, evenly spread."""

import dataclasses
from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from whacamole.body import BodyModel, BodyParams
from whacamole.wardrobe import cast, dress
from whacamole.wardrobe.cast import BODY_MASS_INDEX, NO_HAIR, SUIT, TONE_RANGE, YEARS, Worn, body_mass_index
from whacamole.wardrobe.catalogue import AGES, GENDERS, ORIGINS, catalogue


def key(member):
    return (
        member.gender,
        member.age,
        member.origin,
        member.skin,
        member.tone,
        member.worn,
        member.betas.tobytes(),
    )


def test_one_seed_is_one_person():
    assert key(cast(5)) == key(cast(5))
    assert key(cast(5)) != key(cast(6))
    assert key(cast(np.random.default_rng(5))) == key(cast(5))


@pytest.mark.parametrize("gender", GENDERS)
def test_wishes_are_met(gender):
    member = cast(3, gender=gender, age="old", origin="asian")
    assert (member.gender, member.age, member.origin) == (gender, "old", "asian")
    assert member.skin == f"old_asian_{gender}"


def test_genders_ages_and_origins_are_equally_frequent():
    people = [cast(seed) for seed in range(360)]
    for values, name in ((GENDERS, "gender"), (AGES, "age"), (ORIGINS, "origin")):
        counts = Counter(getattr(p, name) for p in people)
        expected = len(people) / len(values)
        # Four standard deviations of a binomial count.
        assert all(abs(counts[v] - expected) < 4 * np.sqrt(expected * (1 - 1 / len(values))) for v in values)


@settings(derandomize=True, max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_everyone_is_dressed_and_consistent(seed):
    wardrobe, member = catalogue(), cast(seed)
    items = [wardrobe.items[worn.item] for worn in member.worn]
    slots = Counter(item.slot for item in items)
    assert all(slots[slot] == 1 for slot in ("top", "bottom", "shoes", "brows", "lashes"))
    assert all(slots[slot] <= 1 for slot in ("hat", "hair"))
    assert all(item.wearer in (member.gender, "any") for item in items)
    worn_suit = [item.name for item in items if item.name in SUIT]
    assert len(worn_suit) in (0, len(SUIT))
    assert YEARS[member.age][0] <= member.years <= YEARS[member.age][1]
    assert TONE_RANGE[member.origin][0] <= member.tone <= TONE_RANGE[member.origin][1]
    if NO_HAIR[member.gender][member.age] == 0 and not slots["hat"]:
        assert slots["hair"] == 1


@pytest.mark.parametrize("gender", GENDERS)
def test_no_top_hides_what_is_worn_below(gender, tmp_path):
    """A hand's breadth of every bottom shows below the hem of the top, at rest."""
    body, person = BodyModel.embedded(), cast(0, gender=gender)
    at_rest = BodyParams.zeros(3, person.betas)
    hem = {}
    for item in (*catalogue().of_slot("top", gender), *catalogue().of_slot("bottom", gender)):
        alone = dataclasses.replace(person, worn=(Worn(item.name),))
        mesh = next(m for m in dress(alone, body, at_rest, textures=tmp_path) if item.name in m.name)
        hem[item.name] = mesh.vertices[1, :, 1].min()
    for seed in range(300):
        bottom, _, top = (worn.item for worn in cast(seed, gender=gender).worn[:3])
        assert hem[top] - hem[bottom] > 0.11, (seed, bottom, top)


def test_statures_and_weights_are_those_of_adults():
    body = BodyModel.embedded()
    for gender, mean in (("female", 1.64), ("male", 1.77)):
        betas = [cast(seed, gender=gender).betas for seed in range(60)]
        statures = np.array([body.stature(b) for b in betas])
        mass_index = np.array([body_mass_index(b) for b in betas])
        assert abs(statures.mean() - mean) < 0.03
        assert 1.40 < statures.min() < statures.max() < 2.05
        assert abs(mass_index.mean() - BODY_MASS_INDEX[gender][0]) < 1.2
        assert 17 < mass_index.min() < mass_index.max() < 31
