"""The preview scheduler: pictures for panels, computed pass by pass in the time that a frame of the window leaves.

How it works. Panels say what they want to show (`want`), as often as they like: a `PreviewRequest`. Between two frames
of the window the editor calls `work(seconds)`, which does steps until the time is over. A step is one pass on the
device, or one plan, so that the window never waits for a whole picture. The steps of one request are its `PreviewWork`,
a queue of pictures; the one under way is a `PictureJob`.

What is dropped, and why. A new request replaces the old one: nobody will look at the pictures of an older graph. But
during a drag a new request comes with every frame of the window, and if each one stopped the run before it, no picture
would ever be finished. So a run for the same panels may go on for `PATIENCE` seconds. Results are keyed by what they
were computed from, so passes that two requests share are computed once, and nothing has to be marked as outdated.

What comes first. The part of a picture that can be seen (`VisibleRegion`) is computed before the rest, which follows
when the graph stays the same for a moment. Then comes a frame that playback needs soon (`ahead`), and when nothing is
left, thumbnails, drawn from results that are on the device anyway, and trials of code that no picture needs. A panel
shows its last picture until the new one is ready (`DisplayedImages`); frames that were computed stay within a share of
the memory budget (`FrameCache`), so that playing a range again costs nothing.
"""

from __future__ import annotations

from .preview import DisplayedImage, Preview
from .timing import NodeTiming
from .visible_region import VisibleRegion

__all__ = ["DisplayedImage", "NodeTiming", "Preview", "VisibleRegion"]
