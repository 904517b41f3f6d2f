"""Files and arrays: every picture format that OpenImageIO reads, color through OpenColorIO."""

from .color import GpuView, displays, gpu_view, to_display, views
from .info import ImageInfo, content_hash, find_layer, fingerprint, info
from .layers import Layer
from .metadata import Attribute, read_metadata
from .read import Pixels, Want, read, read_many
from .write import check_destination, write

__all__ = [
    "Attribute", "GpuView", "ImageInfo", "Layer", "Pixels", "Want", "check_destination", "content_hash", "displays",
    "find_layer", "fingerprint", "gpu_view", "info", "read", "read_many", "read_metadata", "to_display", "views",
    "write",
]
