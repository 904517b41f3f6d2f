"""Commands for what holds for the whole document: frames, rate, pre-roll, size, color management."""

from __future__ import annotations

from dataclasses import dataclass, replace

from halation.nodes import MAX_REFERENCE_HEIGHT, ColorSettings, Size

from ...errors import GraphError
from ...graph import Settings
from ...resources.picture import MAX_OVERSCAN
from ..state.document_time import MAX_FRAME
from ..state.open_document import OpenDocument
from .command import EditCommand, Edited


@dataclass(frozen=True)
class SetFrameRange(EditCommand[None]):
    """State the first and last frame of the document; None leaves the range to what the graph reads."""

    first: int | None
    last: int | None = None
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        frames = None
        if self.first is not None:
            frames = (int(self.first), int(self.first if self.last is None else self.last))
        if frames and frames[0] > frames[1]:
            raise GraphError(f"the first frame, {frames[0]}, comes after the last one, {frames[1]}")
        if frames and max(map(abs, frames)) > MAX_FRAME:
            raise GraphError(f"frames go from {-MAX_FRAME} to {MAX_FRAME}")
        return _set(document, "Set frames", replace(document.root.settings, frames=frames), self.merge)


@dataclass(frozen=True)
class SetFrameRate(EditCommand[None]):
    """Set the frames per second."""

    rate: float
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        if not 0.01 <= self.rate <= 1000.0:
            raise GraphError(f"{self.rate:g} frames per second: give 0.01 to 1000")
        return _set(document, "Set rate", replace(document.root.settings, rate=float(self.rate)), self.merge)


@dataclass(frozen=True)
class SetPreroll(EditCommand[None]):
    """Set how many earlier frames temporal nodes process; None: from the first frame on."""

    preroll: int | None
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        if self.preroll is not None and not 0 <= self.preroll <= MAX_FRAME:
            raise GraphError(f"a pre-roll of {self.preroll} frames: give 0 or more")
        return _set(document, "Set pre-roll", replace(document.root.settings, preroll=self.preroll), self.merge)


@dataclass(frozen=True, kw_only=True)
class SetColorSettings(EditCommand[None]):
    """Set where color spaces come from, or the one to work in; what is not given stays."""

    config: str | None = None
    working: str | None = None
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        color = document.root.settings.color
        config = color.config if self.config is None else self.config
        working = color.working if self.working is None else self.working
        settings = replace(document.root.settings, color=ColorSettings(config, working))
        return _set(document, "Set color", settings, self.merge)


@dataclass(frozen=True)
class SetReferenceHeight(EditCommand[None]):
    """Set the height at which numbers of lengths are pixels; None for pixels of the picture."""

    height: int | None
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        if self.height is not None and not 1 <= self.height <= MAX_REFERENCE_HEIGHT:
            raise GraphError(f"a reference height of {self.height}: give 1 to {MAX_REFERENCE_HEIGHT}")
        settings = replace(document.graph.settings, reference_height=self.height)
        return Edited("Set reference height", None, replace(document.graph, settings=settings), merge=self.merge)


@dataclass(frozen=True)
class SetOverscan(EditCommand[None]):
    """Set how far beyond their frame pictures are kept, in heights of the frame; 0 for not at all."""

    overscan: float
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        if not 0.0 <= self.overscan <= MAX_OVERSCAN:
            raise GraphError(f"an overscan of {self.overscan:g}: give 0 to {MAX_OVERSCAN:g} heights of the frame")
        return _set(document, "Set overscan", replace(document.root.settings, overscan=self.overscan), self.merge)


@dataclass(frozen=True)
class SetCanvasSize(EditCommand[None]):
    """Set the size of generated pictures, in pixels; None for the size of the first picture."""

    size: Size | None
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        size = self.size
        if size is not None and min(size) < 1:
            raise GraphError(f"the size {size[0]} x {size[1]} has no pixels: give at least 1 x 1")
        settings = replace(document.graph.settings, size=size and (int(size[0]), int(size[1])))
        return Edited("Set size", None, replace(document.graph, settings=settings), merge=self.merge)


def _set(document: OpenDocument, label: str, settings: Settings, merge: str) -> Edited[None]:
    """Replace the settings of the whole document, also where the user is inside a group."""
    return Edited(label, None, root=replace(document.root, settings=settings), merge=merge)
