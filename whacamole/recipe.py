"""What to generate, as one validated, frozen value.

A recipe comes from three places, each over the one before: the defaults below, a YAML or JSON file
(``--recipe``), and the options of the command line. It holds nothing about *how* the work is run (jobs,
threads, devices), so the same recipe gives the same labels on any machine.
"""

import difflib
import os
import textwrap
from pathlib import Path
from typing import Annotated, Any, Literal, Self, get_args, get_origin

import yaml
from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationError,
    model_validator,
)

from whacamole.errors import RecipeError

__all__ = ["Recipe", "default_yaml", "load_recipe", "parse_size"]


def parse_size(value: object) -> object:
    """Turn ``"640x360"`` into ``(640, 360)``; leave anything else to the validator."""
    if isinstance(value, str):
        parts = value.lower().replace("×", "x").split("x")
        if len(parts) == 2 and all(part.strip().isdigit() for part in parts):
            return (int(parts[0]), int(parts[1]))
        raise ValueError(f"{value!r} is not WIDTHxHEIGHT, such as 640x360")
    return value


def parse_people(value: object) -> object:
    """Turn ``"3"`` into ``(3, 3)`` and ``"1-6"`` into ``(1, 6)``; leave anything else to the validator."""
    if isinstance(value, int):
        return (value, value)
    if isinstance(value, str):
        parts = value.split("-")
        if len(parts) <= 2 and all(part.strip().isdigit() for part in parts):
            return (int(parts[0]), int(parts[-1]))
        raise ValueError(f"{value!r} is not a number or a range such as 1-6")
    return value


def parse_span(value: object) -> object:
    """Turn ``0.5`` or ``"0.5"`` into ``(0.5, 0.5)``, ``"0.2,0.5"`` into ``(0.2, 0.5)``."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        return (value, value)
    if isinstance(value, str):
        parts = value.split(",")
        try:
            numbers = [float(part) for part in parts]
        except ValueError:
            numbers = []
        if len(numbers) not in (1, 2):
            raise ValueError(f"{value!r} is neither a number nor two with a comma between, such as 0.2,0.5")
        return (numbers[0], numbers[-1])
    return value


def _in_order(span: tuple[float, float]) -> tuple[float, float]:
    if span[0] > span[1]:
        raise ValueError(f"{span[0]:g},{span[1]:g}: the smaller number comes first")
    return span


def _split_commas(value: object) -> object:
    """Turn ``"arc,tracking"`` into ``("arc", "tracking")``."""
    if isinstance(value, str):
        return tuple(part.strip() for part in value.split(",") if part.strip())
    return value


Names = Annotated[tuple[str, ...], BeforeValidator(_split_commas)]
Side = Annotated[int, Field(ge=16, le=16384)]
Count = Annotated[int, Field(ge=1, le=32)]
People = Annotated[tuple[Count, Count], BeforeValidator(parse_people)]
Millimetres = Annotated[float, Field(ge=4, le=1200)]
Shutter = Annotated[float, Field(ge=0, le=1)]
Stops = Annotated[float, Field(ge=-10, le=10)]
FNumber = Annotated[float, Field(ge=0.5, le=128)]
Levels = Annotated[float, Field(ge=0, le=64)]
Shutters = Annotated[tuple[Shutter, Shutter], BeforeValidator(parse_span), AfterValidator(_in_order)]
StopsSpan = Annotated[tuple[Stops, Stops], BeforeValidator(parse_span), AfterValidator(_in_order)]
FNumbers = Annotated[tuple[FNumber, FNumber], BeforeValidator(parse_span), AfterValidator(_in_order)]
LevelsSpan = Annotated[tuple[Levels, Levels], BeforeValidator(parse_span), AfterValidator(_in_order)]
FocalRange = Annotated[
    tuple[Millimetres, Millimetres], BeforeValidator(parse_span), AfterValidator(_in_order)
]
Size = Annotated[tuple[Side, Side], BeforeValidator(parse_size)]


class Recipe(BaseModel):
    """Everything that decides what is in a dataset."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    motions: Path | None = Field(None, description="folder or file of motions; none: the embedded ones")
    shots: Names = Field(("auto",), description="camera moves to choose from; auto: the director decides")
    people: People = Field(
        (1, 1), description="fewest and most people in a scene of single motions; pairs stay as captured"
    )
    stages: Names = Field(
        (),
        description="stages to choose from: names, files of your own (.blend, .glb, .gltf, .usd), folders of "
        "them; none: all that come with whacamole",
    )
    hdris: Path | None = Field(
        None,
        description="folder of .exr and .hdr environment maps to light stages under a sky; none: built-in",
    )
    shots_per_motion: int = Field(1, ge=1, le=10000, description="sequences made of each motion")
    limit: int | None = Field(None, ge=1, description="make at most so many sequences")
    frames: int = Field(
        240, ge=0, description="frames a sequence at most, a seeded part of a longer motion; 0: all of it"
    )
    fps: float = Field(30.0, gt=0, le=240, description="frames a second of the video and its labels")
    size: Size = Field((640, 360), description="width and height of a frame in pixels")
    focal_mm: FocalRange = Field(
        (24.0, 50.0),
        description="shortest and longest lens, as focal length on 36 mm film along the longer side",
    )
    motion_blur: Shutters = Field(
        (0.0, 0.0), description="share of the frame time that the shutter is open, drawn between two numbers"
    )
    f_number: FNumbers | None = Field(
        None, description="f-number of the lens, drawn between two numbers; none: sharp everywhere"
    )
    exposure: StopsSpan = Field(
        (0.0, 0.0), description="stops over the exposure that suits the stage, drawn between two numbers"
    )
    noise: LevelsSpan = Field(
        (0.0, 0.0), description="sensor noise at middle grey in 8-bit levels, drawn between two numbers"
    )
    quality: Literal["draft", "standard", "high"] = Field("standard", description="render settings")
    engine: Literal["auto", "cycles", "raster", "eevee"] = Field(
        "auto",
        description="renderer; auto: Cycles where Blender runs, else the OpenGL raster engine",
    )
    passes: Names = Field(("rgb", "mask", "depth"), description="what is rendered for each frame")
    image_format: Literal["jpg", "png", "mp4"] = Field(
        "jpg", description="file format of the colour frames; mp4: one H.264 file a sequence"
    )
    body_model: Path | None = Field(None, description="SMPL-X-schema .npz; none: the embedded CC0 body")
    textures: Path | None = Field(
        None, description="folder of pictures for the body model's UV map, worn in place of clothes"
    )
    contact_regions: Path | None = Field(
        None,
        description="JSON or .npz of the body model's vertices by region, the parts of the contact labels; "
        "none: 21 parts",
    )
    self_contact: bool = Field(
        False, description="also label which parts of a person touch other parts of the same person"
    )
    seed: int = Field(0, ge=0, lt=2**63, description="the one seed of all choices")
    allow_breaches: bool = Field(
        False, description="render a sequence even where no camera was found that keeps all rules"
    )
    test_fraction: float = Field(0.2, ge=0, le=1, description="share of the motions in the test split")

    @model_validator(mode="after")
    def _people_in_order(self) -> Self:
        if self.people[0] > self.people[1]:
            raise ValueError(f"people {self.people}: the fewest come first")
        return self

    @model_validator(mode="after")
    def _shots_are_known(self) -> Self:
        from camera_rigs.shots.catalogue import resolve_shots  # late: it loads all planners

        resolve_shots(self.shots)  # its PlanError is a ValueError
        return self

    @model_validator(mode="after")
    def _stages_exist(self) -> Self:
        if not self.stages:
            return self
        from whacamole.stage import STAGES  # late: it loads the geometry of all stages

        for entry in self.stages:
            is_path = "/" in entry or os.sep in entry or Path(entry).suffix or Path(entry).exists()
            if entry not in STAGES and not is_path:
                raise ValueError(
                    f"stages: {entry!r} is none of {', '.join(STAGES)}, and no file or folder of that name "
                    "is here"
                )
        return self

    @model_validator(mode="after")
    def _labels_need_their_passes(self) -> Self:
        from render_jobs.passes import PASSES  # late, as above

        unknown = [name for name in self.passes if name not in PASSES]
        if unknown:
            raise ValueError(f"passes: {unknown[0]!r} is none of {', '.join(PASSES)}")
        missing = [name for name in ("rgb", "mask", "depth") if name not in self.passes]
        if missing:
            raise ValueError(
                f"passes lack {', '.join(missing)}: the labels of visibility are read from mask and depth, "
                "so rgb, mask and depth are always made"
            )
        return self

    def save_as_dict(self) -> dict[str, Any]:
        """Return plain values for JSON and YAML."""
        return self.model_dump(mode="json")


def load_recipe(path: Path | None, overrides: dict[str, Any]) -> Recipe:
    """Return the recipe of ``path`` with ``overrides`` (command-line options that were given) on top.

    Raises:
        RecipeError: the file cannot be read, or a value is wrong; one line names it.
    """
    values: dict[str, Any] = {}
    if path is not None:
        try:
            loaded = yaml.safe_load(path.read_text(encoding="utf-8"))
        except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
            reason = (isinstance(error, OSError) and error.strerror) or " ".join(str(error).split())
            raise RecipeError(f"{path}: not a readable recipe ({reason})") from error
        if not isinstance(loaded, dict | None):
            raise RecipeError(f"{path}: a recipe is a list of `name: value` lines; see `whacamole recipe`")
        values.update(loaded or {})
    values.update(overrides)
    try:
        return Recipe.model_validate(values)
    except ValidationError as error:
        where = f"{path}: " if path is not None else ""
        raise RecipeError(where + _one_line(error)) from error


def _one_line(error: ValidationError) -> str:
    """Return what is wrong with a recipe, each fault as ``option = value: reason``."""
    faults = []
    for fault in error.errors():
        name = ".".join(str(part) for part in fault["loc"][:1]).replace("_", "-")
        reason = fault["msg"].removeprefix("Value error, ").replace("Input should be", "must be")
        if fault["type"] == "extra_forbidden":
            near = difflib.get_close_matches(str(fault["loc"][0]), Recipe.model_fields, n=1)
            reason = "a recipe has no such entry; " + (
                f"is {near[0]} meant?" if near else "see `whacamole recipe`"
            )
        elif fault["type"] == "path_type":
            reason = "must be a path"
        shown = "" if fault["type"] in ("value_error", "extra_forbidden") else f" (got {fault['input']!r})"
        faults.append(f"{name}: {reason}{shown}" if name else f"{reason}{shown}")
    return "; ".join(dict.fromkeys(faults))  # both numbers of a pair may have the same fault


def default_yaml() -> str:
    """Return the default recipe as YAML, every value under a comment that explains it."""
    defaults = Recipe.model_validate({}).save_as_dict()
    lines = ["# What `whacamole render --recipe FILE` makes; options on the command line go over it."]
    for name, field in Recipe.model_fields.items():
        shown = yaml.safe_dump(defaults[name], default_flow_style=True).replace("\n...", "").strip()
        choices = _choices(name, field.annotation)
        listed = textwrap.wrap(f"One of: {', '.join(choices)}.", 100) if choices else []
        lines += ["", f"# {field.description}", *(f"# {line}" for line in listed), f"{name}: {shown}"]
    return "\n".join(lines) + "\n"


def _choices(name: str, annotation: object) -> tuple[str, ...]:
    """Return the words that an option of the recipe takes, none where any value of its type will do."""
    if get_origin(annotation) is Literal:
        return tuple(str(word) for word in get_args(annotation))
    if name == "shots":
        from camera_rigs.shots.catalogue import GROUPS, KINDS

        return (*GROUPS, *KINDS)
    if name == "stages":
        from whacamole.stage import STAGES

        return tuple(STAGES)
    if name == "passes":
        from render_jobs import PASSES

        return tuple(PASSES)
    return ()
