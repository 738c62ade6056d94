"""Labels that follow from bodies and cameras: people, visibility, contact. NumPy and SciPy only."""

from whacamole.labels.camera import camera_arrays
from whacamole.labels.contact import ContactLabels, model_parts
from whacamole.labels.ground import ContactThresholds
from whacamole.labels.overlay import OverlayStyle, overlay_frame
from whacamole.labels.parts import PART_NAMES, BodyParts, parts_from_regions, skinning_parts
from whacamole.labels.people import FrameImages, LabelledPerson, PeopleLabels
from whacamole.labels.preview import preview_strip
from whacamole.labels.raster import Raster, RasterMesh, rasterize
from whacamole.labels.regions import read_regions
from whacamole.labels.sequence import SequenceLabels, label_sequence

__all__ = [
    "PART_NAMES",
    "BodyParts",
    "ContactLabels",
    "ContactThresholds",
    "FrameImages",
    "LabelledPerson",
    "OverlayStyle",
    "PeopleLabels",
    "Raster",
    "RasterMesh",
    "SequenceLabels",
    "camera_arrays",
    "label_sequence",
    "model_parts",
    "overlay_frame",
    "parts_from_regions",
    "preview_strip",
    "rasterize",
    "read_regions",
    "skinning_parts",
]
