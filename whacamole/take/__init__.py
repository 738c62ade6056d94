"""A take: who plays which part of which motion, where, from one seed; ready to be filmed."""

from whacamole.take.take import Performer, Take, stage_take

__all__ = ["Performer", "Take", "stage_take"]
