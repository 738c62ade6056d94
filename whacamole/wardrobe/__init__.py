"""People to film: a cast drawn from seeds, and their skin, hair and clothes on the body."""

from whacamole.wardrobe.cast import CastMember, Worn, cast
from whacamole.wardrobe.dress import dress, fits
from whacamole.wardrobe.hands import relaxed_hands
from whacamole.wardrobe.palette import skin_tone

__all__ = ["CastMember", "Worn", "cast", "dress", "fits", "relaxed_hands", "skin_tone"]
