"""Recipes: what is typed goes over what is in the file, which goes over the defaults."""

from pathlib import Path

import pytest
import yaml

from whacamole.errors import RecipeError
from whacamole.recipe import Recipe, default_yaml, load_recipe


def test_the_printed_default_is_the_default() -> None:
    assert Recipe.model_validate(yaml.safe_load(default_yaml())) == Recipe.model_validate({})


def test_the_printed_default_says_what_may_be_chosen() -> None:
    comments = " ".join(line[2:] for line in default_yaml().splitlines() if line.startswith("# "))
    for words in ("draft, standard, high", "auto, all, arc, arc-horizontal", "plaza, park", "rgb, mask"):
        assert f"One of: {words}" in comments
    for name in Recipe.model_fields:
        assert Recipe.model_fields[name].description, name


def test_options_go_over_the_file_and_the_file_over_the_defaults(tmp_path: Path) -> None:
    file = tmp_path / "recipe.yaml"
    file.write_text("size: 320x180\nframes: 24\nshots: arc,tracking\n", encoding="utf-8")
    recipe = load_recipe(file, {"frames": 12})
    assert (recipe.size, recipe.frames, recipe.seed) == ((320, 180), 12, 0)
    assert recipe.shots == ("arc", "tracking")


def test_a_recipe_survives_its_own_json() -> None:
    recipe = load_recipe(
        None, {"motions": Path("a/b"), "focal_mm": (20.0, 30.0), "passes": "rgb,mask,depth,flow"}
    )
    assert Recipe.model_validate(recipe.save_as_dict()) == recipe


@pytest.mark.parametrize(
    ("values", "named"),
    [
        ({"size": "64"}, "size"),
        ({"size": "8x8"}, "size"),
        ({"frames": -1}, "frames"),
        ({"fps": 0}, "fps"),
        ({"quality": "best"}, "quality"),
        ({"seed": -1}, "seed"),
        ({"colour": "red"}, "colour: a recipe has no such entry; see `whacamole recipe`"),
        ({"sizes": "64x64"}, "sizes: a recipe has no such entry; is size meant?"),
        ({"motions": True}, "motions: must be a path (got True)"),
        ({"passes": "rgb,mask"}, "depth"),
        ({"focal_mm": (50.0, 24.0)}, "focal-mm"),
    ],
)
def test_a_wrong_value_is_named_on_one_line(values: dict[str, object], named: str) -> None:
    with pytest.raises(RecipeError) as caught:
        load_recipe(None, values)
    assert named in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("text", ["- a\n- b\n", "size: [\n", "!!python/object/apply:os.system ['true']"])
def test_a_file_that_is_no_recipe_is_named(tmp_path: Path, text: str) -> None:
    file = tmp_path / "recipe.yaml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(RecipeError, match=r"recipe\.yaml"):
        load_recipe(file, {})
