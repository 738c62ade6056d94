"""Numbers in sentences."""

__all__ = ["counted"]


def counted(number: int, what: str) -> str:
    """Return ``1 frame``, ``2 frames``, ``2,000 frames``."""
    return f"{number:,} {what}" if number == 1 else f"{number:,} {what}s"
