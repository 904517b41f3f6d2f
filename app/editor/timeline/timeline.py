"""The timeline: transport buttons, ruler, range and rate in one row."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...authoring.commands import SetFrameRange, SetFrameRate
from ...language.translation import translate
from ..fields.fields import Edit, Fields
from ..fields.number_field import number_field
from ..fields.numbers import RATE, near
from ..theme.palette import DARK
from ..theme.style import ui_scale
from ..toolkit.buttons import entry, quiet_button, tip_of, tool
from ..toolkit.places import item_rect
from ..toolkit.words import SMALL, font, tip, write
from .playback import Loop
from .ruler import Ruler

if TYPE_CHECKING:
    from .context import TimelineContext

HEIGHT = 40.0
"""The height of the bar, at UI scale 1."""

_LOOPS: dict[Loop, str] = {
    "loop": icons.ICON_FA_REPEAT,
    "once": icons.ICON_FA_ARROW_RIGHT_TO_BRACKET,
    "ping-pong": icons.ICON_FA_RIGHT_LEFT,
}
_ROOMY, _NARROW = 1050.0, 760.0
"""Widths below which the text, then the fields of the range, are left out."""


class Timeline:
    """The timeline at the bottom of the window."""

    def __init__(self, context: TimelineContext) -> None:
        self._context = context
        self._fields = Fields(DARK)
        self._ruler = Ruler(context)

    def draw(self) -> None:
        """Draw into the current window."""
        fields, scale = self._fields, ui_scale()
        fields.palette, fields.places, fields.items = self._context.palette, self._context.places, self._context.items
        dragged = fields.dragging
        fields.begin(imgui.is_mouse_down(imgui.MouseButton_.left))
        start, size = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail()
        high = imgui.get_frame_height()
        top = start.y + max((size.y - high) * 0.5, 0.0)
        imgui.set_cursor_screen_pos((start.x + 6.0 * scale, top))
        imgui.push_style_var(imgui.StyleVar_.item_spacing, (2.0 * scale, 0.0))
        self._transport()
        imgui.same_line(0.0, 6.0 * scale)
        self._frame(60.0 * scale)
        imgui.same_line(0.0, 8.0 * scale)
        left = imgui.get_cursor_screen_pos().x
        wide = size.x / scale
        words, range_wide = (196.0 if wide > _ROOMY else 0.0) * scale, (196.0 if wide > _NARROW else 0.0) * scale
        right = start.x + size.x - words - range_wide - 8.0 * scale
        pad = 4.0 * scale
        target_frame = self._ruler.draw((left, start.y + pad, max(right, left + 8.0), start.y + size.y - pad))
        if range_wide:
            imgui.set_cursor_screen_pos((right + 8.0 * scale, top))
            self._range(scale)
        if words:
            self._words((right + range_wide + 12.0 * scale, top, start.x + size.x - 8.0 * scale, top + high))
        imgui.pop_style_var()
        if target_frame:
            imgui.open_popup("timeline menu")
        if imgui.begin_popup("timeline menu"):
            for action in self._context.actions.in_menu("timeline"):
                if action.separated:
                    imgui.separator()
                entry(self._context, action)
            imgui.end_popup()
        if dragged and not fields.dragging:
            self._context.session.seal()
        fields.end()

    # --- parts -------------------------------------------------------------------------------------------------------

    def _transport(self) -> None:
        playing, timeline = self._context.timeline.playing, self._context.timeline
        tool(self._context, icons.ICON_FA_BACKWARD_FAST, "time.first")
        imgui.same_line()
        tool(self._context, icons.ICON_FA_BACKWARD_STEP, "time.previous")
        imgui.same_line()
        tool(self._context, icons.ICON_FA_PAUSE if playing else icons.ICON_FA_PLAY, "time.play")
        imgui.same_line()
        tool(self._context, icons.ICON_FA_FORWARD_STEP, "time.next")
        imgui.same_line()
        tool(self._context, icons.ICON_FA_FORWARD_FAST, "time.last")
        imgui.same_line()
        action = self._context.actions[f"time.{timeline.loop.replace('-', '_')}"]
        doc = f"{tip_of(self._context, action)}\n{translate('Click to change it')}"
        if quiet_button(self._context, _LOOPS[timeline.loop], "button time.loops", doc):
            timeline.next_loop()

    def _frame(self, width: float) -> None:
        edit = self._number("timeline frame", self._context.session.time.frame, width, translate("The current frame"))
        if edit and isinstance(edit.value, int | float):
            self._context.timeline.stop()
            self._context.session.time.seek(edit.value)

    def _range(self, scale: float) -> None:
        """Draw the frame range and the rate of the document."""
        session = self._context.session
        first, last = session.time.frames
        stated = session.root.settings.frames is not None
        automatic = translate("From the sequences that it reads, or from its keys. Type a number to set it")
        for name, doc, value, gap in (
            ("first", translate("First frame of the graph"), first, 3.0),
            ("last", translate("Last frame of the graph"), last, 8.0),
        ):
            doc = doc if stated else f"{doc}\n{automatic}"
            edit = self._number(f"timeline {name}", value, 52.0 * scale, doc)
            imgui.same_line(0.0, gap * scale)
            if edit and isinstance(edit.value, int | float):
                at, merge = int(edit.value), edit.merge
                low, high = (at, max(last, at)) if name == "first" else (min(first, at), at)
                self._context.log.attempt(
                    lambda low=low, high=high, merge=merge: session.apply(SetFrameRange(low, high, merge=merge))
                )
        rate = number_field(
            self._fields,
            "timeline rate",
            session.root.settings.rate,
            RATE,
            76.0 * scale,
            suffix=translate("fps", "unit"),
            plain=True,
        )
        self._context.places["field timeline rate"] = item_rect()
        tip(translate("Frames per second of the graph"))
        if rate and isinstance(rate.value, int | float):
            value, merge = float(rate.value), rate.merge
            self._context.log.attempt(lambda: session.apply(SetFrameRate(value, merge=merge)))

    def _number(self, id: str, value: int, width: float, doc: str) -> Edit | None:
        edit = number_field(self._fields, id, value, near(value), width, plain=True)
        self._context.places[f"field {id}"] = item_rect()
        tip(doc)
        return edit

    def _words(self, rect: tuple[float, float, float, float]) -> None:
        """Draw the speed of playback, else what is computed, else how many frames are cached."""
        timeline, preview, palette = self._context.timeline, self._context.preview, self._context.palette
        text, color = timeline.playback.words, palette.text
        lead = preview.lead
        if lead:
            kind, computed, total = lead
            text = translate("planning {done} of {total} frames", done=computed, total=total)
            if kind == "pre-roll":
                text = translate("pre-roll {done} of {total}", done=computed, total=total)
            color = palette.accent
        elif not text:
            first, last = self._context.session.time.frames
            ready = sum(first <= frame <= last for frame in preview.frames)
            text, color = timeline.report, palette.dim
            if last > first and not text:
                text = translate(
                    "{count} of {total} ready, {size:.0f} MiB",
                    count=ready,
                    total=last - first + 1,
                    size=preview.frames_bytes / 2**20,
                )
        with font(self._context, "text", SMALL):
            write(rect, text, color)
        self._context.places["timeline words"] = rect
        imgui.set_cursor_screen_pos(rect[:2])
        imgui.dummy((max(rect[2] - rect[0], 1.0), rect[3] - rect[1]))
        tip(translate("Cached frames play at once. They use up to half of the memory budget."))
