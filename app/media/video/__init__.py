"""Videos: exact frames by number, with their color, and writing of videos. Needs the extra `video` (PyAV).

Reading goes `index` (which frames exist) -> `reader` (a frame as PyAV decodes it) -> `planes` and `signals` (the frame
as R'G'B', or as light) -> `layers` (the frame as layers of a picture). Writing is `codecs` -> `writer`.
"""

from .facts import describe_video_attributes, find_kept_tags
from .index import VideoInfo
from .layers import describe_video, read_video_info

__all__ = ["VideoInfo", "describe_video", "describe_video_attributes", "find_kept_tags", "read_video_info"]
