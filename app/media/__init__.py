"""Files and arrays: every picture format that OpenImageIO reads, color through OpenColorIO."""

from .color import displays, to_display, views
from .info import ImageInfo, content_hash, find_layer, fingerprint, info
from .layers import Layer
from .metadata import Attribute, read_metadata
from .naming import Role
from .read import Pixels, Want, read, read_many
from .recolor import gpu_view
from .sequences import Sequence, find_sequence, frame_file, suggest_pattern
from .store import sweep
from .survey import Survey, survey
from .write import check_destination, write

__all__ = [
    "Attribute", "ImageInfo", "Layer", "Pixels", "Role", "Sequence", "Survey", "Want", "check_destination",
    "content_hash", "displays", "find_layer", "find_sequence", "fingerprint", "frame_file", "gpu_view", "info", "read",
    "read_many", "read_metadata", "suggest_pattern", "survey", "sweep", "to_display", "views", "write",
]
