"""Rooms: walls with doors and windows, trim, and the lamps below a ceiling."""

from whacamole.stage.rooms.lamps import FIXTURES, ceiling_lamps
from whacamole.stage.rooms.openings import WindowKind, curtains, door, radiator, window
from whacamole.stage.rooms.room import Room, beams, daylight_lamps, room
from whacamole.stage.rooms.trim import clock, cornice, picture, skirting, wainscot
from whacamole.stage.rooms.wall import Rect, Wall

__all__ = [
    "FIXTURES",
    "Rect",
    "Room",
    "Wall",
    "WindowKind",
    "beams",
    "ceiling_lamps",
    "clock",
    "cornice",
    "curtains",
    "daylight_lamps",
    "door",
    "picture",
    "radiator",
    "room",
    "skirting",
    "wainscot",
    "window",
]
