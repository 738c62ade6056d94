"""Train and test by a rule of one's own: what must not be on both sides, and how much goes to the test.

Sequences that share a motion, anybody's motion, always stay together, and so do those that share whatever
else the rule names. What hangs together through such links is one group; a hash of the group's name decides
its side. The default rule puts a sequence of one motion where :func:`whacamole.dataset.side_of` does,
whatever else is in the dataset. Only a sequence whose people tie two groups together can move an earlier one.
"""

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np

from whacamole.dataset.files import write_json, write_text
from whacamole.dataset.index import read_json, read_summary
from whacamole.dataset.layout import DatasetLayout
from whacamole.dataset.reader import Sequence
from whacamole.dataset.splits import side_of
from whacamole.errors import DatasetError, RecipeError

__all__ = ["SplitRule", "assign", "links_of", "refresh_splits", "split_dataset"]

SIDES = ("train", "test")
KINDS = ("motion", "person", "stage")
_SHAPE_DIGITS = 4
"""Decimals of the betas by which a person is known again."""


@dataclass(frozen=True)
class SplitRule:
    """How a dataset is split.

    Attributes:
        by: what must not be on both sides beside motions.
        test_fraction: share of the groups that goes to the test, from 0 to 1.
        seed: another seed gives another split.
    """

    by: Literal["motion", "person", "stage"] = "motion"
    test_fraction: float = 0.2
    seed: int = 0

    def __post_init__(self) -> None:
        """Refuse a rule that means nothing."""
        if self.by not in KINDS:
            raise RecipeError(f"--by {self.by}: choose from {', '.join(KINDS)}")
        if not 0.0 <= self.test_fraction <= 1.0:
            raise RecipeError(f"--test-fraction {self.test_fraction}: must be from 0 to 1")


def links_of(sequence: Sequence, by: str) -> tuple[str, ...]:
    """Return what a sequence must not share with the other side: its motions, and more as the rule says.

    A person is known by body model, gender and shape.
    """
    people = sequence.people
    motions = sorted({str(sequence.facts["motion_id"]), *map(str, people["motion_id"])})
    if by == "stage":
        return (*motions, f"stage/{sequence.facts['stage']}")
    if by == "person":
        betas = np.round(people["betas"].astype(np.float64), _SHAPE_DIGITS) + 0.0  # no minus zero
        looks = zip(people["gender"], betas.tolist(), strict=True)
        who = {f"person/{people['body_model_sha256']}/{gender}/{shape}" for gender, shape in looks}
        return (*motions, *sorted(who))
    return tuple(motions)


def assign(links: Mapping[str, Iterable[str]], rule: SplitRule) -> dict[str, str]:
    """Return ``"train"`` or ``"test"`` for each sequence.

    Args:
        links: sequence id → what ties it to others; a sequence needs at least one.
        rule: how to split. The name of a group is the first of its links in the order of the alphabet.
    """
    names = {sequence_id: sorted(set(tied)) for sequence_id, tied in sorted(links.items())}
    leader: dict[str, str] = {}
    for tied in names.values():
        first = min(_leader_of(leader, name) for name in tied)
        for name in tied:
            leader[_leader_of(leader, name)] = first
    key = "" if rule.seed == 0 else f"{rule.seed}/"
    return {
        sequence_id: side_of(f"{key}{_leader_of(leader, tied[0])}", rule.test_fraction)
        for sequence_id, tied in names.items()
    }


def _leader_of(leader: dict[str, str], name: str) -> str:
    """Return the name of the group that a link is in, shortening the way to it (union-find)."""
    while leader.setdefault(name, name) != name:
        leader[name] = leader.setdefault(leader[name], leader[name])
        name = leader[name]
    return name


def split_dataset(layout: DatasetLayout, rule: SplitRule) -> dict[str, list[str]]:
    """Write ``splits/`` by a rule, and the rule beside it, for sequences that are added later.

    Returns:
        side → the ids of its sequences, sorted.

    Raises:
        DatasetError: nothing is there, or everything hangs together, so that any split would leak.
    """
    links = _links(layout, rule.by)
    if not links:
        raise DatasetError(f"{layout.root}: no finished sequence to split; run `whacamole render` first")
    if 0.0 < rule.test_fraction < 1.0 and len(links) > 1 and _is_one_group(links):
        shared = "motions" if rule.by == "motion" else f"motions or {rule.by}s"
        raise DatasetError(
            f"{layout.root}: all {len(links)} sequences hang together through shared {shared}, any split by "
            f"{rule.by} would leak; render more motions, or fewer shots and people of each"
        )
    return _write(layout, links, rule)


def refresh_splits(layout: DatasetLayout, test_fraction: float) -> dict[str, list[str]]:
    """Write ``splits/`` anew by the rule that was last used on the dataset, by motion where there is none.

    Raises:
        DatasetError: ``splits/rule.json`` is broken.
    """
    file = layout.splits / "rule.json"
    rule = _rule_from(read_json(file), str(file)) if file.is_file() else SplitRule("motion", test_fraction)
    return _write(layout, _links(layout, rule.by), rule)


def _links(layout: DatasetLayout, by: str) -> dict[str, tuple[str, ...]]:
    found = {}
    for sequence_id in layout.finished():
        place = layout.sequence(sequence_id)
        found[sequence_id] = links_of(Sequence(sequence_id, place, read_summary(place)), by)
    return found


def _is_one_group(links: Mapping[str, Iterable[str]]) -> bool:
    leader: dict[str, str] = {}
    for tied in links.values():
        names = list(tied)
        for name in names:
            leader[_leader_of(leader, name)] = _leader_of(leader, names[0])
    return len({_leader_of(leader, name) for name in leader}) == 1


def _write(
    layout: DatasetLayout, links: Mapping[str, Iterable[str]], rule: SplitRule
) -> dict[str, list[str]]:
    """Write each file beside its place and rename it, the rule last."""
    side = assign(links, rule)
    sides = {name: sorted(key for key, value in side.items() if value == name) for name in SIDES}
    layout.splits.mkdir(parents=True, exist_ok=True)
    for name, ids in sides.items():
        write_text(layout.splits / f"{name}.txt", "".join(f"{sequence_id}\n" for sequence_id in ids))
    write_json(layout.splits / "rule.json", asdict(rule))
    return sides


def _rule_from(value: Any, place: str) -> SplitRule:
    try:
        return SplitRule(value["by"], float(value["test_fraction"]), int(value["seed"]))
    except (KeyError, TypeError, ValueError, RecipeError) as error:
        raise DatasetError(f"{place}: no rule of a split ({error}); run `whacamole split` again") from error
