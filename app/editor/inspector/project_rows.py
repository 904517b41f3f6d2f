"""The inspector's rows of a graph's settings: size, lengths, overscan, time and color."""

from __future__ import annotations

from halation.nodes import REFERENCE_HEIGHT, Value
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...authoring.commands import (
    SetCanvasSize,
    SetFrameRange,
    SetFrameRate,
    SetOverscan,
    SetPreroll,
    SetReferenceHeight,
)
from ...language.translation import translate
from ...resources.picture import MAX_OVERSCAN
from ..fields.fields import Fields
from ..fields.number_field import number_field, row_of_numbers
from ..fields.numbers import RATE, near
from ..theme.style import ui_scale
from ..toolkit.labels import translate_label
from ..toolkit.words import tip
from .applying import find_height
from .color_rows import color_rows
from .rows import Rows

_SIDE = Value("size", "int", 1920, low=1.0, high=4096.0, minimum=1.0, maximum=16384.0, unit="px")
_PREROLL = Value("preroll", "int", 12, low=0.0, high=100.0, minimum=0.0)
_OVERSCAN = Value("overscan", "float", 0.0, low=0.0, high=0.5, minimum=0.0, maximum=MAX_OVERSCAN, unit="height")
_FULL_HD = (1920, 1080)
_NAMES = ("canvas", "lengths at", "overscan", "frames", "rate", "pre-roll", "color config", "working space")


class ProjectRows:
    """Shows and edits the settings of a graph."""

    def __init__(self, fields: Fields) -> None:
        self._fields = fields

    def draw(self, rows: Rows) -> None:
        """Draw all of them."""
        rows.fit(translate(name, "value") for name in _NAMES)
        self._size(rows)
        self._reference_height(rows)
        self._overscan(rows)
        self._time(rows)
        color_rows(rows, self._fields)

    # --- parts -------------------------------------------------------------------------------------------------------

    def _size(self, rows: Rows) -> None:
        session = rows.context.session
        size = session.graph.settings.size
        rows.name(
            "size",
            translate("canvas", "value"),
            doc=translate("The size of generated pictures. Automatic: that of the first picture"),
        )
        width, side = rows.field(), imgui.get_frame_height()
        if size is None:
            if imgui.button(translate_label("Automatic"), (width, 0.0)):
                rows.act(lambda: session.apply(SetCanvasSize(_FULL_HD)))
            rows.record("size")
            tip(translate("The size of the first picture that is read; click to set one"))
            return
        imgui.begin_group()
        edit = row_of_numbers(
            self._fields,
            "size",
            size,
            _SIDE,
            width - side,
            ("w", "h") if width > 170 * ui_scale() else ("", ""),
            keep_type=True,
        )
        imgui.end_group()
        rows.record("size")
        imgui.same_line(0.0, 0.0)
        if rows.icon(icons.ICON_FA_XMARK, "automatic size", translate("Automatic: the size of the first picture")):
            rows.act(lambda: session.apply(SetCanvasSize(None)))
        if edit and isinstance(edit.value, tuple):
            wide, high = edit.value
            rows.act(lambda: session.apply(SetCanvasSize((int(wide), int(high)), merge=edit.merge)))

    def _reference_height(self, rows: Rows) -> None:
        """Draw the height at which numbers of lengths are pixels. Switching it on keeps the picture as it is."""
        session = rows.context.session
        reference = session.graph.settings.reference_height
        doc = translate("Lengths are pixels of a picture of this height, so that the look is the same at every size.")
        is_changed = reference not in (None, REFERENCE_HEIGHT)  # old graphs have none, new ones this
        rows.name("reference height", translate("lengths at", "value"), doc=doc, changed=is_changed)
        width = rows.field()
        if reference is None:
            if imgui.button(translate_label("Pixels of the picture"), (width, 0.0)):
                height = find_height(session.graph, rows.context.viewer.picture[1])
                rows.act(lambda: session.apply(SetReferenceHeight(height)))
            rows.record("reference height")
            tip(
                translate(
                    "A larger picture has finer grain and thinner lines; click to make the look the same at every size"
                )
            )
            return
        width -= imgui.get_frame_height()
        edit = number_field(
            self._fields, "reference height", reference, _SIDE, width, suffix=translate("px high", "unit"), plain=True
        )
        rows.record("reference height")
        imgui.same_line(0.0, 0.0)
        if rows.icon(icons.ICON_FA_XMARK, "no reference height", translate("Pixels of the picture")):
            rows.act(lambda: session.apply(SetReferenceHeight(None)))
        if edit and isinstance(edit.value, int | float):
            height, token = int(edit.value), edit.merge
            rows.act(lambda: session.apply(SetReferenceHeight(height, merge=token)))

    def _overscan(self, rows: Rows) -> None:
        session = rows.context.session
        overscan = session.root.settings.overscan
        doc = translate(
            "How far beyond its frame a picture is kept, so that what left it can come back; 0: it ends there."
        )
        rows.name("overscan", translate("overscan", "value"), doc=doc, changed=overscan > 0.0)
        edit = number_field(
            self._fields, "overscan", overscan, _OVERSCAN, rows.field(), suffix=translate("height", "unit"), plain=True
        )
        rows.record("overscan")
        if edit and isinstance(edit.value, int | float):
            part, token = float(edit.value), edit.merge
            rows.act(lambda: session.apply(SetOverscan(part, merge=token)))

    def _time(self, rows: Rows) -> None:
        """Draw the frame range, the frame rate and the pre-roll."""
        session = rows.context.session
        settings, (first, last) = session.root.settings, session.time.frames
        rows.name(
            "frames",
            translate("frames", "value"),
            doc=translate("The first and the last frame"),
            changed=settings.frames is not None,
        )
        stated = settings.frames is not None
        width = rows.field() - (imgui.get_frame_height() if stated else 0.0)
        imgui.begin_group()
        edit = row_of_numbers(
            self._fields, "frames", (first, last), near(first), width, ("", ""), keep_type=True, plain=True
        )
        imgui.end_group()
        rows.record("frames")
        if not stated:
            tip(
                translate(
                    "Automatic: from the sequences that the graph reads, or from its keys. Type a number to set it"
                )
            )
        else:
            imgui.same_line(0.0, 0.0)
            if rows.icon(
                icons.ICON_FA_XMARK,
                "automatic frames",
                translate("Automatic: from sequences or keys"),
            ):
                rows.act(lambda: session.apply(SetFrameRange(None)))
        if edit and isinstance(edit.value, tuple):
            low, high = (int(part) for part in edit.value)
            # The end that moves pushes the other one, so that the range never runs backwards.
            low, high = (low, max(low, high)) if low != first else (min(low, high), high)
            rows.act(lambda: session.apply(SetFrameRange(low, high, merge=edit.merge)))
        rows.name("rate", translate("rate", "value"), doc=translate("Frames per second"), changed=settings.rate != 24.0)
        rate = number_field(
            self._fields, "rate", settings.rate, RATE, rows.field(), suffix=translate("fps", "unit"), plain=True
        )
        rows.record("rate")
        if rate and isinstance(rate.value, int | float):
            fps, token = float(rate.value), rate.merge
            rows.act(lambda: session.apply(SetFrameRate(fps, merge=token)))
        self._preroll(rows)

    def _preroll(self, rows: Rows) -> None:
        session = rows.context.session
        preroll = session.root.settings.preroll
        doc = translate(
            "How many frames before the requested one nodes with a memory start. Without a number they start "
            "at the first frame, so that a frame is the same wherever a render begins."
        )
        rows.name("preroll", translate("pre-roll", "value"), doc=doc, changed=preroll is not None)
        width = rows.field()
        if preroll is None:
            if imgui.button(translate_label("First frame"), (width, 0.0)):
                rows.act(lambda: session.apply(SetPreroll(12)))
            rows.record("preroll")
            tip(doc)
            return
        width -= imgui.get_frame_height()
        edit = number_field(
            self._fields, "preroll", preroll, _PREROLL, width, suffix=translate("frames", "unit"), plain=True
        )
        rows.record("preroll")
        imgui.same_line(0.0, 0.0)
        if rows.icon(icons.ICON_FA_XMARK, "automatic preroll", translate("From the first frame")):
            rows.act(lambda: session.apply(SetPreroll(None)))
        if edit and isinstance(edit.value, int | float):
            count, token = int(edit.value), edit.merge
            rows.act(lambda: session.apply(SetPreroll(count, merge=token)))
