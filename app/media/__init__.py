"""Files and arrays: every picture format that OpenImageIO reads, color through OpenColorIO."""

from .color import displays, looks, to_display, views
from .encoding import Encoding
from .info import ImageInfo, content_hash, find_layer, fingerprint, info
from .layers import Layer
from .managed import color_digest, color_mark
from .metadata import Attribute, read_metadata
from .naming import Role
from .primaries import working_of
from .read import Pixels, Want, read, read_many
from .recolor import gpu_view
from .sequences import Sequence, find_sequence, frame_file, suggest_pattern
from .store import sweep
from .survey import Survey, survey
from .video_file import VideoFile, check_video
from .write import check_destination, write

__all__ = [
    "Attribute", "Encoding", "ImageInfo", "Layer", "Pixels", "Role", "Sequence", "Survey", "VideoFile", "Want",
    "check_destination", "check_video", "color_digest", "color_mark", "content_hash", "displays", "find_layer",
    "find_sequence", "fingerprint", "frame_file", "gpu_view", "info", "looks", "read", "read_many", "read_metadata",
    "suggest_pattern", "survey", "sweep", "to_display", "views", "working_of", "write",
]
