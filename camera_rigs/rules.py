"""What a good plan satisfies; each rule returns findings that name rule, frame, value and limit."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Finding:
    """One breach of one rule: the worst frame, the value there and the limit it breaks."""

    rule: str
    frame: int
    value: float
    limit: float
    message: str
