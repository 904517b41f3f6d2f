"""Commands for what holds for the whole document: frames, rate, pre-roll, size, color management."""

from __future__ import annotations

from dataclasses import replace

from halation.nodes import MAX_REFERENCE_HEIGHT, ColorSettings, Size

from ...errors import GraphError
from ...graph import Settings
from ...language.translation import translate
from ...resources.picture import MAX_OVERSCAN
from ..state.document_time import MAX_FRAME
from ..state.open_document import OpenDocument
from .command import EditCommand, Edited

_LEAST_RATE, _LARGEST_RATE = 0.01, 1000.0
"""Frames per second: from one in 100 seconds to those of cameras for slow motion. Chosen by judgement."""


class SetFrameRange(EditCommand[None], frozen=True):
    """State the first and last frame of the document; None leaves the range to what the graph reads."""

    first: int | None
    last: int | None = None
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        frames = None
        if self.first is not None:
            frames = (int(self.first), int(self.first if self.last is None else self.last))
        if frames and frames[0] > frames[1]:
            raise GraphError(
                translate("the first frame, {first}, comes after the last one, {last}", first=frames[0], last=frames[1])
            )
        if frames and max(map(abs, frames)) > MAX_FRAME:
            raise GraphError(translate("frames go from {lowest} to {highest}", lowest=-MAX_FRAME, highest=MAX_FRAME))
        return _set(document, translate("Set frames"), replace(document.root.settings, frames=frames), self.merge)


class SetFrameRate(EditCommand[None], frozen=True):
    """Set the frames per second."""

    rate: float
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        if not _LEAST_RATE <= self.rate <= _LARGEST_RATE:
            sentence = translate(
                "{rate:g} frames per second: give {least:g} to {largest:g}",
                rate=self.rate,
                least=_LEAST_RATE,
                largest=_LARGEST_RATE,
            )
            raise GraphError(sentence)
        return _set(document, translate("Set rate"), replace(document.root.settings, rate=float(self.rate)), self.merge)


class SetPreroll(EditCommand[None], frozen=True):
    """Set how many earlier frames temporal nodes process; None: from the first frame on."""

    preroll: int | None
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        if self.preroll is not None and not 0 <= self.preroll <= MAX_FRAME:
            raise GraphError(translate("a pre-roll of {preroll} frames: give 0 or more", preroll=self.preroll))
        return _set(
            document, translate("Set pre-roll"), replace(document.root.settings, preroll=self.preroll), self.merge
        )


class SetColorSettings(EditCommand[None], frozen=True, kw_only=True):
    """Set where color spaces come from, or the one to work in; what is not given stays."""

    config: str | None = None
    working: str | None = None
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        color = document.root.settings.color
        config = color.config if self.config is None else self.config
        working = color.working if self.working is None else self.working
        settings = replace(document.root.settings, color=ColorSettings(config, working))
        return _set(document, translate("Set color"), settings, self.merge)


class SetReferenceHeight(EditCommand[None], frozen=True):
    """Set the height at which numbers of lengths are pixels; None for pixels of the picture."""

    height: int | None
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        if self.height is not None and not 1 <= self.height <= MAX_REFERENCE_HEIGHT:
            raise GraphError(
                translate(
                    "a reference height of {height}: give 1 to {most}", height=self.height, most=MAX_REFERENCE_HEIGHT
                )
            )
        settings = replace(document.graph.settings, reference_height=self.height)
        return Edited(
            translate("Set reference height"), None, replace(document.graph, settings=settings), merge=self.merge
        )


class SetOverscan(EditCommand[None], frozen=True):
    """Set how far beyond their frame pictures are kept, in heights of the frame; 0 for not at all."""

    overscan: float
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        if not 0.0 <= self.overscan <= MAX_OVERSCAN:
            raise GraphError(
                translate(
                    "an overscan of {overscan:g}: give 0 to {most:g} heights of the frame",
                    overscan=self.overscan,
                    most=MAX_OVERSCAN,
                )
            )
        return _set(
            document, translate("Set overscan"), replace(document.root.settings, overscan=self.overscan), self.merge
        )


class SetCanvasSize(EditCommand[None], frozen=True):
    """Set the size of generated pictures, in pixels; None for the size of the first picture."""

    size: Size | None
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        size = self.size
        if size is not None and min(size) < 1:
            raise GraphError(
                translate(
                    "the size {width} x {height} has no pixels: give at least 1 x 1", width=size[0], height=size[1]
                )
            )
        settings = replace(document.graph.settings, size=size and (int(size[0]), int(size[1])))
        return Edited(translate("Set size"), None, replace(document.graph, settings=settings), merge=self.merge)


def _set(document: OpenDocument, label: str, settings: Settings, merge: str) -> Edited[None]:
    """Replace the settings of the whole document, also where the user is inside a group."""
    return Edited(label, None, root=replace(document.root, settings=settings), merge=merge)
