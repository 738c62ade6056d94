"""``DATASET/README.md``: what the dataset holds, where it comes from, what to beware of."""

from collections.abc import Mapping
from typing import Any

from whacamole.body import EMBEDDED_NAME
from whacamole.dataset.files import write_text
from whacamole.dataset.layout import DatasetLayout
from whacamole.dataset.reader import open_dataset
from whacamole.dataset.statistics import Spread, Statistics, collect

__all__ = ["card_text", "statistics_text", "write_card"]

BAR = 32
"""Characters of the longest bar."""

TITLES = {
    "distance_m": "Distance of the pelvis from the camera [m]",
    "focal_mm": "Focal length for a sensor 36 mm wide [mm]",
    "visible_fraction": "Visible fraction (pixels seen ÷ pixels if alone)",
    "truncation": "Truncation (share of the body outside the image)",
    "height_in_image": "Height of the person's box ÷ height of the image",
}


def write_card(layout: DatasetLayout, numbers: Statistics | None = None) -> None:
    """Write ``README.md`` of a dataset from its labels; the same dataset gives the same text.

    Args:
        numbers: what the dataset holds; counted anew where they are not given.

    Raises:
        DatasetError: a file of the dataset is missing or broken.
    """
    dataset = open_dataset(layout.root)
    write_text(layout.card, card_text(collect(dataset) if numbers is None else numbers, dataset.index))


def statistics_text(numbers: Statistics) -> str:
    """Return the numbers as Markdown: tables of counts, text plots of distributions."""
    blocks = [_counts(numbers), _shares(numbers)]
    for title, counts in (
        ("Shots", numbers.shots),
        ("Stages", numbers.stages),
        ("Licences of the motions", numbers.licences),
        ("Forms of the motion files", numbers.sources),
        ("Genders", numbers.genders),
        ("Image sizes", numbers.sizes),
        ("Splits (sequences)", numbers.splits),
    ):
        blocks.append(f"### {title}\n\n{_table(counts)}")
    blocks += [f"### {TITLES[name]}\n\n{_plot(spread)}" for name, spread in numbers.spreads.items()]
    return "\n\n".join(blocks)


def card_text(numbers: Statistics, index: Mapping[str, Any]) -> str:
    """Return the card.

    Args:
        numbers: what the dataset holds.
        index: the content of ``dataset.json``.
    """
    made_by = " ".join(
        [str(index.get("generator", "whacamole")), str(index.get("versions", {}).get("whacamole", ""))]
    ).strip()
    head = (
        "# Dataset card\n\n"
        f"Synthetic video of people and a moving camera, with exact SMPL-X labels. Made by {made_by}, format "
        f"version {index.get('format_version', 'not stated')}, seed {index.get('seed', 'not stated')}."
    )
    return "\n\n".join(
        [head, _caveats(numbers), "## In numbers", statistics_text(numbers), _body(numbers), _reading()]
    )


def _counts(numbers: Statistics) -> str:
    rows = {
        "sequences": f"{numbers.sequences:,}",
        "instances (a person in an image)": f"{numbers.instances:,}",
        "frames": f"{numbers.frames:,}",
        "people (a track in a sequence)": f"{numbers.people:,}",
        "different motions": f"{numbers.motions:,}",
        "sequences of two people recorded together": f"{numbers.interactive:,}",
        "seconds": f"{numbers.seconds:,.1f}",
    }
    return "| | |\n|---|---:|\n" + "\n".join(f"| {name} | {value} |" for name, value in rows.items())


def _shares(numbers: Statistics) -> str:
    joints = ", ".join(f"{share:.1%} {name}" for name, share in numbers.joints.items())
    return (
        f"Of the instances {numbers.ground_contact:.1%} touch the ground and {numbers.person_contact:.1%} "
        f"another person. Of their joints: {joints}."
    )


def _table(counts: Mapping[str, int]) -> str:
    if not counts:
        return "none"
    rows = (f"| {_cell(name)} | {count:,} |" for name, count in counts.items())
    return "| | |\n|---|---:|\n" + "\n".join(rows)


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")


def _plot(spread: Spread) -> str:
    total, most = sum(spread.counts), max(spread.counts)
    if not total:
        return "none"
    lines = []
    for label, count in spread.rows():
        bar = "█" * round(BAR * count / most) or ("▏" if count else "")
        lines.append(f"{label:>14}  {count / total:6.1%}  {bar}".rstrip())
    text = "\n".join(lines)
    numbers = f"least {spread.low:.3g}, mean {spread.mean:.3g}, greatest {spread.high:.3g}"
    return f"```text\n{text}\n{numbers}\n```"


def _caveats(numbers: Statistics) -> str:
    names = ", ".join(f"`{name}` (sha256 `{digest[:12]}`)" for name, digest in numbers.body_models.items())
    lines = [
        f"All parameters refer to the body model {names or 'none'}; a label is true for that model alone."
    ]
    if EMBEDDED_NAME in numbers.body_models:
        lines.append(
            f"`betas` of `{EMBEDDED_NAME}` are coefficients of its own shape space, **not SMPL-X betas**: "
            "do not train a shape head on them together with SMPL-X data. Its joints and angles follow the "
            "SMPL-X skeleton; `whacamole body --export` writes the model."
        )
    else:
        lines.append("`betas` are coefficients of that model's shape space.")
    lines += [
        "Zero is the flat hand (`flat_hand_mean=True`); a change of frame needs the rest pelvis.",
        "Clothes and hair are drawn, but labels are of the body beneath; contact is that of bare bodies.",
        "Poses come from motion capture fitted to other bodies: feet and hands may miss what they touched by "
        "centimetres. Contact is computed from what is shown.",
        "People, places and light are synthetic and drawn from a small stock; they stand for no population.",
        "The images and labels inherit the licences of the motions below.",
    ]
    return "## Before you use it\n\n" + "\n".join(f"* {line}" for line in lines)


def _body(numbers: Statistics) -> str:
    rows = zip(numbers.beta_mean, numbers.beta_deviation, strict=True)
    lines = [f"| {number} | {mean:g} | {spread:g} |" for number, (mean, spread) in enumerate(rows)]
    return "### Shapes (betas over people)\n\n| | mean | deviation |\n|---|---:|---:|\n" + "\n".join(lines)


def _reading() -> str:
    return (
        "## Reading it\n\n"
        "```python\nimport whacamole\n\n"
        'for sequence in whacamole.open(".").split("train"):\n'
        "    print(sequence.id, len(sequence), sequence.people.keys())\n```\n\n"
        "The label files are plain NumPy arrays. `whacamole check .` audits labels against pixels.\n"
    )
