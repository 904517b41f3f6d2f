"""Draws the current step of a tutorial: a frame around its widget, and a card beside it."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...authoring.edits.element_id import NO_ELEMENT, ElementId
from ...authoring.edits.layout import Place
from ...authoring.edits.ports import is_viewable
from ...graph import Port
from ...language.translation import translate
from ..shared.window_commands import PanelTitle
from ..theme.style import u32, ui_scale
from ..toolkit.buttons import quiet_button, width_of_buttons
from ..toolkit.keys import display_shortcut
from ..toolkit.places import Rect
from ..toolkit.words import SMALL, draw_dim, draw_wrapped, font
from .moment import Moment

if TYPE_CHECKING:
    from .context import TutorialContext
    from .lesson import Lesson, Step

_WIDTH, _GAP, _MARGIN = 320.0, 14.0, 10.0
_PADDING = 14.0, 10.0
READABLE_ZOOM = 0.95
"""The zoom at which notes of a graph are nearly as large as the texts of panels: 13 pixels."""

NOTE_REACH = 130.0
"""How far above its node a note begins, at most, in units of the canvas."""

_OUT = 5.0
"""How far the frame is from its widget."""

_FLAGS = (
    int(imgui.WindowFlags_.no_decoration)
    | int(imgui.WindowFlags_.no_move)
    | int(imgui.WindowFlags_.no_saved_settings)
    | int(imgui.WindowFlags_.no_docking)
    | int(imgui.WindowFlags_.no_focus_on_appearing)
)


class Coach:
    """The open tutorial. It takes no keys of the panels: the user works in the editor while it looks on."""

    def __init__(self, context: TutorialContext) -> None:
        self._context = context

    def draw(self) -> None:
        """Draw the step, and go on when it is done."""
        progress = self._context.progress
        if progress.lesson is None or "start" in self._context.dialogs.open:
            return
        now = Moment.read(self._context.session, frozenset(progress.widgets))
        step = progress.lesson.steps[progress.index]
        if progress.beginning is None:
            progress.beginning = now
            if progress.index == 0:
                self._show_panels(progress.widgets)
            self._begin(step)
            self._show_notes(step, is_first=progress.index == 0)
        elif step.is_done is not None and not progress.went_back and step.is_done(progress.beginning, now):
            if not self._context.interface.dragging:  # a drag ends first
                self._go_on(progress.lesson)
            return
        rect = progress.widgets.get(step.widget)
        is_covered = self._context.dialogs.any
        if rect is not None and not is_covered and (frame := fit_frame(rect, progress.widgets, _OUT * ui_scale())):
            self._draw_frame(frame)
        self._draw_card(progress.lesson, step, rect)

    def _show_panels(self, widgets: Mapping[str, Rect]) -> None:
        """Bring what most steps point at to the front: the user may come from the code, or from renders."""
        for title in (PanelTitle.INSPECTOR, PanelTitle.VIEWER, PanelTitle.GRAPH):
            if title not in widgets:
                self._context.commands.show_panel(title)

    def _begin(self, step: Step) -> None:
        """Show what a step is about."""
        session, port = self._context.session, Port.parse(step.show) if step.show else None
        if port is not None and is_viewable(session.graph, port):
            session.views.show(port)
        self._context.passes.marked = step.marks
        if step.panel is not None:
            self._context.commands.show_panel(step.panel)

    def _show_notes(self, step: Step, *, is_first: bool) -> None:
        """Show the node of a step and its notes large enough to be read, where a graph has notes."""
        places = self._context.session.positions
        if not any(key.is_note for key in places):
            return
        if is_first:
            self._context.canvas.fit(least_zoom=READABLE_ZOOM)
        self._context.canvas.reveal(find_noted(step.widget, places))

    def _go_on(self, lesson: Lesson) -> None:
        """Go to the next step. A lesson that ends is finished if all its tasks are solved."""
        context, store = self._context, self._context.interface.store
        context.progress.go(1)
        finished = store.current.lessons
        if context.progress.lesson is None and lesson.id not in finished and lesson.is_solved(context.session.graph):
            context.log.attempt(lambda: store.change(lessons=(*finished, lesson.id)))

    def _solve(self, step: Step) -> None:
        """Do what a step asks for, as steps that can be undone."""
        for command in step.solution:
            self._context.session.apply(command)

    def _draw_frame(self, frame: Rect) -> None:
        """Draw a frame around a widget; it is wider than the focus ring, so that the two differ."""
        lines, scale, accent = imgui.get_foreground_draw_list(), ui_scale(), self._context.palette.accent
        low, high = frame[:2], frame[2:]
        lines.add_rect(low, high, u32(accent, 0.3), 8.0 * scale, 7.0 * scale)
        lines.add_rect(low, high, u32(accent), 8.0 * scale, 2.0 * scale)

    def _draw_card(self, lesson: Lesson, step: Step, rect: Rect | None) -> None:
        """Draw the card of a step. It lies above all panels, but not above dialogs and menus: a step may ask the user
        to choose something in them.
        """
        scale, progress = ui_scale(), self._context.progress
        sentence = self._fill_in_keys(translate(step.sentence))
        buttons = self._label_buttons(lesson, step)
        inner = max((_WIDTH - 2 * _PADDING[0]) * scale, width_of_buttons(*buttons.values()))
        wide = inner + 2 * _PADDING[0] * scale
        high = imgui.calc_text_size(sentence, False, inner).y + 2 * _PADDING[1] * scale + imgui.get_frame_height()
        high += 1.2 * SMALL * scale + 3 * imgui.get_style().item_spacing.y + 2.0 * scale
        notes, nodes = _list_seen(progress.widgets, "title comments."), _list_seen(progress.widgets, "node ")
        imgui.set_next_window_pos(place_card(rect, (wide, high), _find_area(), scale, notes, nodes))
        imgui.set_next_window_size(ImVec2(wide, high))
        imgui.push_style_color(imgui.Col_.border, u32(self._context.palette.accent))
        imgui.push_style_var(imgui.StyleVar_.window_padding, ImVec2(_PADDING[0] * scale, _PADDING[1] * scale))
        imgui.push_style_var(imgui.StyleVar_.window_rounding, 8.0 * scale)
        imgui.begin("##tutorial", None, _FLAGS)
        if not self._context.dialogs.any and not imgui.is_popup_open("", int(imgui.PopupFlags_.any_popup)):
            imgui.internal.bring_window_to_display_front(imgui.internal.get_current_window())
        with font(self._context, "text", SMALL):
            draw_dim(
                self._context,
                translate(
                    "{title}: {number} of {count}",
                    title=translate(lesson.title),
                    number=progress.index + 1,
                    count=len(lesson.steps),
                ),
            )
        draw_wrapped(self._context.palette.text, sentence)
        imgui.dummy(ImVec2(0.0, 2.0 * scale))
        self._draw_buttons(lesson, step, buttons)
        corner = imgui.get_window_pos()
        self._context.places["tutorial"] = (corner.x, corner.y, corner.x + wide, corner.y + high)
        imgui.end()
        imgui.pop_style_var(2)
        imgui.pop_style_color()

    def _label_buttons(self, lesson: Lesson, step: Step) -> dict[str, str]:
        """The labels of the buttons of a step, from left to right, by what they do."""
        labels = {}
        if self._context.progress.index:
            labels["back"] = f"{icons.ICON_FA_ARROW_LEFT}  {translate('Back')}"
        is_last = self._context.progress.index == len(lesson.steps) - 1
        following = translate("Next") if self._is_read(step) else translate("Skip")
        labels["next"] = translate("Finish") if is_last else f"{icons.ICON_FA_ARROW_RIGHT}  {following}"
        if step.solution:
            labels["solve"] = f"{icons.ICON_FA_WAND_MAGIC_SPARKLES}  {translate('Do it')}"
        if not is_last:
            labels["end"] = f"{icons.ICON_FA_XMARK}  {translate('End')}"
        return labels

    def _is_read(self, step: Step) -> bool:
        return step.is_done is None or self._context.progress.went_back

    def _draw_buttons(self, lesson: Lesson, step: Step, labels: Mapping[str, str]) -> None:
        progress = self._context.progress
        docs = {"solve": translate("Do it for me"), "end": translate("Close the tutorial")}
        acts: dict[str, Callable[[], object]] = {
            "back": lambda: progress.go(-1),
            "next": lambda: self._go_on(lesson),
            "solve": lambda: self._context.log.attempt(lambda: self._solve(step)),
            "end": lambda: progress.begin(None),
        }
        lit = self._is_read(step)
        for name, label in labels.items():
            if name != next(iter(labels)):
                imgui.same_line()
            if quiet_button(self._context, label, f"tutorial {name}", docs.get(name, ""), lit=lit and name == "next"):
                acts[name]()

    def _fill_in_keys(self, sentence: str) -> str:
        """The sentence with the current shortcuts of the actions that it names in braces."""
        actions = self._context.actions
        return re.sub(r"\{([\w.]+)\}", lambda match: display_shortcut(actions.shortcut(match[1])), sentence)


def find_noted(widget: str, places: Mapping[ElementId, Place]) -> list[ElementId]:
    """The element that a widget of the canvas belongs to, with the notes above it; nothing for other widgets."""
    match = re.match(r"(title|pin in|pin out) (.+)", widget)
    element = ElementId(match[2]) if match else NO_ELEMENT
    if element not in places:
        element = ElementId(element.rpartition(".")[0])  # the node of a pin
    if element not in places:
        return []
    x, y = places[element]
    above = [key for key, (left, top) in places.items() if key.is_note and left == x and 0.0 < y - top <= NOTE_REACH]
    return [element, *above]


def fit_frame(rect: Rect, widgets: Mapping[str, Rect], out: float) -> Rect | None:
    """The frame around a widget, `out` pixels away and inside of its panel; None if it is scrolled away."""
    x, y = (rect[0] + rect[2]) / 2, (rect[1] + rect[3]) / 2
    panels = [widgets[title] for title in PanelTitle if title in widgets]
    frame = rect[0] - out, rect[1] - out, rect[2] + out, rect[3] + out
    holders = [place for place in panels if place[0] <= x <= place[2] and place[1] <= y <= place[3]]
    if not holders:
        return None if any(_overlaps(rect, panel) for panel in panels) else frame
    left, top, right, bottom = holders[0]
    return max(frame[0], left), max(frame[1], top), min(frame[2], right), min(frame[3], bottom)


def _overlaps(first: Rect, second: Rect) -> bool:
    return first[0] < second[2] and second[0] < first[2] and first[1] < second[3] and second[1] < first[3]


def _list_seen(widgets: Mapping[str, Rect], start: str) -> list[Rect]:
    """What is seen in the graph of the widgets whose names begin like that."""
    left, top, right, bottom = widgets.get(PanelTitle.GRAPH, (0.0, 0.0, 0.0, 0.0))
    places = [place for name, place in widgets.items() if name.startswith(start)]
    return [(max(x0, left), max(y0, top), min(x1, right), min(y1, bottom)) for x0, y0, x1, y1 in places]


def place_card(
    rect: Rect | None,
    size: tuple[float, float],
    area: Rect,
    scale: float,
    notes: Sequence[Rect] = (),
    nodes: Sequence[Rect] = (),
) -> tuple[float, float]:
    """Where the card goes: beside its widget, so that it hides nothing of it; into a widget as large as a panel.

    Below comes first, as a reader looks there next; then above, at the right, at the left, and at the corners. A place
    that hides less of the notes is better, and of those one that hides less of the nodes.
    """
    width, height = size
    gap, margin = _GAP * scale, _MARGIN * scale
    low, high = (area[0] + margin, area[1] + margin), (area[2] - margin - width, area[3] - margin - height)
    if rect is None:
        return high
    x, y = min(max(rect[0], low[0]), high[0]), min(max(rect[1], low[1]), high[1])
    end = min(max(rect[2] - width, low[0]), high[0])
    right, left, below, above = rect[2] + gap, rect[0] - gap - width, rect[3] + gap, rect[1] - gap - height
    places = [(place, top) for place in (x, end) for top in (below, above)]
    places += [(right, y), (left, y), (right, below), (right, above), (left, below), (left, above)]
    inside = [place for place in places if low[0] <= place[0] <= high[0] and low[1] <= place[1] <= high[1]]

    def measure_hidden(place: tuple[float, float]) -> tuple[float, float]:
        card = *place, place[0] + width, place[1] + height
        return sum(_measure_shared(card, note) for note in notes), sum(_measure_shared(card, node) for node in nodes)

    if inside:
        return min(inside, key=measure_hidden)
    return min(max(rect[2] - width - margin, low[0]), high[0]), y + margin


def _measure_shared(first: Rect, second: Rect) -> float:
    """The area that two rectangles share, in whole pixels."""
    across = min(first[2], second[2]) - max(first[0], second[0])
    down = min(first[3], second[3]) - max(first[1], second[1])
    return float(round(across * down)) if across > 0.0 and down > 0.0 else 0.0


def _find_area() -> Rect:
    view = imgui.get_main_viewport()
    return view.work_pos.x, view.work_pos.y, view.work_pos.x + view.work_size.x, view.work_pos.y + view.work_size.y
