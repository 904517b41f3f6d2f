"""Panels drawn by the real library without a window, a device's screen or a clock: in milliseconds, and always alike.

Places and texts come from the library itself, with the editor's font. What panels draw with their draw lists is written
down as `drawn_shapes` does; widgets are written down with their labels and places.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import imgui_bundle
import pytest
from drawn_shapes import DrawnShapes, Point, Shape
from halation.editor.theme.palette import DARK, Palette
from halation.editor.theme.style import EM, apply
from imgui_bundle import imgui

WIDGETS = (
    "text", "text_unformatted", "text_disabled", "text_wrapped", "text_colored", "separator_text", "button",
    "small_button", "checkbox", "radio_button", "selectable", "menu_item", "begin_menu", "tree_node", "tree_node_ex",
    "invisible_button", "input_text", "input_text_with_hint", "input_text_multiline", "drag_float", "input_int",
    "slider_float", "slider_int", "dummy", "image", "separator", "begin_combo", "progress_bar", "collapsing_header",
)  # fmt: skip
"""Functions of the library that draw a widget, and leave its place as that of the last item."""


CHOSEN, DISABLED = 0xFF, 0xFF00
"""The colors by which a widget that has none says that it is checked or selected, and that it is disabled."""

STACKS = {
    "push_font": "pop_font", "push_style_color": "pop_style_color", "push_style_var": "pop_style_var",
    "push_id": "pop_id", "push_item_flag": "pop_item_flag", "push_text_wrap_pos": "pop_text_wrap_pos",
    "begin_disabled": "end_disabled", "begin_group": "end_group", "begin_child": "end_child", "begin": "end",
    "begin_popup": "end_popup", "begin_popup_context_item": "end_popup", "begin_menu": "end_menu",
    "begin_combo": "end_combo", "begin_table": "end_table", "begin_tooltip": "end_tooltip",
    "indent": "unindent",
}  # fmt: skip
"""What a panel begins or sets, and the call that ends it: of each there must be as many in a frame."""

ENDED_IF_OPEN = (
    "begin_popup", "begin_popup_context_item", "begin_menu", "begin_combo", "begin_table", "begin_tooltip",
)  # fmt: skip
"""What has an end only where its beginning says that it is open."""

Rect = tuple[float, float, float, float]

_NO_HINTS = 1
"""What FreeType's loader in the library calls NoHinting."""


def overlap(first: Rect, second: Rect) -> Rect:
    """What two boxes have in common; right is left of left where they have nothing."""
    low = max(first[0], second[0]), max(first[1], second[1])
    return (*low, min(first[2], second[2]), min(first[3], second[3]))


_draw_list_of_window = imgui.get_window_draw_list


def find_clip() -> Rect:
    """Where the window of the library shows what is drawn now."""
    lines = _draw_list_of_window()
    low, high = lines.get_clip_rect_min(), lines.get_clip_rect_max()
    return low.x, low.y, high.x, high.y


@dataclass
class SeenShapes(DrawnShapes):
    """Writes down what more than one panel draws, and where each shape and text can be seen."""

    clips: list[Rect] = field(default_factory=list[Rect])
    """Where each shape can be seen."""
    boxes: list[Rect] = field(default_factory=list[Rect])
    """The box of each text."""
    _clips: list[Rect] = field(default_factory=list[Rect])

    def clear(self) -> None:
        self.shapes.clear()
        self.clips.clear()
        self.boxes.clear()

    def push_clip_rect(self, low: Any, high: Any, inside: bool) -> None:
        super().push_clip_rect(low, high, inside)
        self._clips.append((float(low[0]), float(low[1]), float(high[0]), float(high[1])))

    def pop_clip_rect(self) -> None:
        super().pop_clip_rect()
        self._clips.pop()

    def _add(self, kind: str, points: tuple[Any, ...], lengths: tuple[float, ...], color: int, text: str = "") -> None:
        super()._add(kind, points, lengths, color, text)
        clip = find_clip()
        for box in self._clips[-1:]:
            clip = overlap(clip, box)
        self.clips.append(clip)
        box: Rect = 0.0, 0.0, 0.0, 0.0
        if kind == "text":
            (x, y), (size, wrap) = self.shapes[-1].points[0], self.shapes[-1].lengths
            part = size / imgui.get_font_size() if size != self.em else 1.0
            room = imgui.calc_text_size(text, wrap_width=wrap / part if wrap else -1.0)
            box = x, y, x + room.x * part, y + room.y * part
        self.boxes.append(box)

    def add_image(self, picture: Any, low: Any, high: Any, *words: Any) -> None:
        self._add("image", (low, high), (), 0)

    def add_rect_filled_multi_color(self, low: Any, high: Any, *colors: int) -> None:
        self._add("shaded rect", (low, high), (), colors[0], " ".join(map(str, colors)))

    def add_polyline(self, points: Any, color: int, width: float, flags: int) -> None:
        self._add("polyline", tuple(points), (width,), color, str(flags))

    def add_triangle(self, a: Any, b: Any, c: Any, color: int, width: float = 1.0) -> None:
        self._add("outlined triangle", (a, b, c), (width,), color)

    def path_arc_to(self, at: Any, radius: float, start: float, end: float, *words: Any) -> None:
        self._add("arc", (at,), (radius,), 0, f"{start:.6f} {end:.6f}")

    def path_line_to(self, at: Any) -> None:
        self._add("path line", (at,), (), 0)

    def path_bezier_cubic_curve_to(self, a: Any, b: Any, c: Any, *words: Any) -> None:
        self._add("path curve", (a, b, c), (), 0)

    def path_stroke(self, color: int, width: float, flags: int = 0) -> None:
        self._add("stroke", (), (width,), color, str(flags))


TEXTS = "text", "text_unformatted", "text_disabled", "text_wrapped", "text_colored"
"""Widgets that are nothing but text."""


@dataclass(frozen=True)
class SeenText:
    """A text in a frame: its words, its box, and where it could be seen."""

    words: str
    box: Rect
    clip: Rect

    @property
    def sight(self) -> Rect:
        return overlap(self.box, self.clip)


@dataclass(frozen=True)
class Drawing:
    """What one frame has drawn."""

    shapes: tuple[Shape, ...]
    widgets: tuple[Shape, ...]
    drawn_texts: tuple[SeenText, ...]
    texts: tuple[SeenText, ...]
    """With those of widgets."""

    @property
    def all(self) -> list[Shape]:
        return [*self.shapes, *self.widgets]

    def list_boxes(self, *kinds: str) -> list[Rect]:
        """The boxes of rectangles and of widgets of some kinds."""
        return [(*shape.points[0], *shape.points[1]) for shape in self.all if shape.kind in kinds]


class StillWindow:
    """A pane of a size at a place, in which something is drawn frame by frame."""

    def __init__(self, at: Point, size: Point) -> None:
        self.at, self.size = at, size
        self.shapes = SeenShapes()
        self.widgets: list[Shape] = []
        self.font: imgui.ImFont | None = None
        self._widget_clips: list[Rect] = []
        self._open = Counter[str]()

    def draw(self, body: Callable[[], Any], frames: int = 1) -> Any:
        """Draw some frames; what the body returns in the last one."""
        answer = None
        for _ in range(frames):
            self.shapes.clear()
            self.widgets.clear()
            self._widget_clips.clear()
            imgui.new_frame()
            imgui.set_next_window_pos(self.at)
            imgui.set_next_window_size(self.size)
            imgui.begin("pane", None, int(imgui.WindowFlags_.no_title_bar) | int(imgui.WindowFlags_.no_saved_settings))
            self._open.clear()  # the pane's own beginning is not the panel's
            answer = body()
            open_parts = {name: count for name, count in self._open.items() if count}
            imgui.end()
            imgui.end_frame()
            assert not open_parts, f"what follows this panel would be drawn otherwise: {open_parts}"
            clips = [len(self.shapes.list_kinds(kind)) for kind in ("clip", "unclip")]
            assert clips[0] == clips[1], "as many clips end as begin"
        return answer

    def copy(self) -> Drawing:
        """What the last frame has drawn."""
        seen = zip(self.shapes.shapes, self.shapes.boxes, self.shapes.clips, strict=True)
        drawn = [SeenText(shape.text, box, clip) for shape, box, clip in seen if shape.kind == "text"]
        widgets = [
            SeenText(shape.text, (*shape.points[0], *shape.points[1]), clip)
            for shape, clip in zip(self.widgets, self._widget_clips, strict=True)
            if shape.kind in TEXTS
        ]
        return Drawing((*self.shapes.shapes,), (*self.widgets,), (*drawn,), (*drawn, *widgets))

    def point(self, at: Point) -> None:
        """Move the mouse."""
        imgui.get_io().add_mouse_pos_event(*at)

    def click(self, rect: tuple[float, float, float, float], body: Callable[[], Any], button: int = 0) -> list[Any]:
        """Click in the middle of a place; what the body returns in the frames of the press, the release and after."""
        self.point(((rect[0] + rect[2]) / 2, (rect[1] + rect[3]) / 2))
        self.draw(body, 2)
        answers = []
        for is_down in (True, False):
            imgui.get_io().add_mouse_button_event(button, is_down)
            answers.append(self.draw(body))
        return [*answers, self.draw(body)]

    def press(self, key: imgui.Key, body: Callable[[], Any]) -> Any:
        """Press and release a key; what the body returns in the frame of the press."""
        imgui.get_io().add_key_event(key, True)
        answer = self.draw(body)
        imgui.get_io().add_key_event(key, False)
        self.draw(body)
        return answer

    def list_texts(self) -> list[str]:
        """All words, drawn or of widgets, in their order."""
        drawn = [shape.text for shape in self.shapes.list_kinds("text")]
        return [*drawn, *(label for shape in self.widgets if (label := shape.text.split("##")[0]))]

    def find(self, kind: str, text: str = "") -> Shape:
        """The one widget of a kind with this label or identity."""
        (widget,) = [shape for shape in self.widgets if shape.kind == kind and text in shape.text]
        return widget

    def _wrap(self, name: str, call: Callable[..., Any]) -> Callable[..., Any]:
        def draw(*words: Any, **options: Any) -> Any:
            answer = call(*words, **options)
            low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
            label = next((word for word in words if isinstance(word, str)), "")
            states = [word for word in words if isinstance(word, bool)]  # whether it is on, and whether it can be used
            color = CHOSEN * states[:1].count(True) | DISABLED * states[1:2].count(False)
            if name == "text_colored":
                color = imgui.color_convert_float4_to_u32(imgui.ImVec4(*words[0]))
            self.widgets.append(Shape(name, ((low.x, low.y), (high.x, high.y)), (), color, label))
            self._widget_clips.append(find_clip())
            return answer

        return draw

    def _count(self, name: str, call: Callable[..., Any], end: str, by: int) -> Callable[..., Any]:
        """A call that is counted where it begins something, or ends it."""

        def count(*words: Any, **options: Any) -> Any:
            answer = call(*words, **options)
            if name in ("indent", "unindent"):
                self._open[end] += by * round(1000.0 * sum(words))
            elif name not in ENDED_IF_OPEN or answer:
                self._open[end] += by * (words[0] if words and name in ("pop_style_color", "pop_style_var") else 1)
            return answer

        return count

    def watch(self, patch: pytest.MonkeyPatch) -> None:
        """Write down what is drawn from now on."""
        for name, end in STACKS.items():
            patch.setattr(imgui, name, self._count(name, getattr(imgui, name), end, 1))
        for name in {*STACKS.values()}:
            patch.setattr(imgui, name, self._count(name, getattr(imgui, name), name, -1))
        for name in WIDGETS:
            patch.setattr(imgui, name, self._wrap(name, getattr(imgui, name)))
        for name in ("get_window_draw_list", "get_foreground_draw_list", "get_background_draw_list"):
            patch.setattr(imgui, name, lambda *words: self.shapes)


@contextmanager
def open_still(
    size: Point = (320.0, 600.0), at: Point = (20.0, 30.0), scale: float = 1.0, palette: Palette = DARK,
    screen: Point = (1600.0, 1200.0), density: float = 1.0,
) -> Iterator[StillWindow]:  # fmt: skip
    """A context of the library with the editor's style and font, and a pane in it.

    `density` is how many pixels of the screen a unit of the interface has, along each axis.

    The font has no hints: then glyphs have no whole pixels, and texts grow evenly with the interface.
    """
    context = imgui.create_context()
    try:
        io = imgui.get_io()
        io.display_size = imgui.ImVec2(screen[0] * scale, screen[1] * scale)
        io.display_framebuffer_scale = imgui.ImVec2(density, density)
        io.delta_time = 1.0 / 60.0
        io.backend_flags |= int(imgui.BackendFlags_.renderer_has_textures)
        io.set_ini_filename("")
        folder = Path(imgui_bundle.__file__).parent / "assets/fonts"
        plain = imgui.ImFontConfig()
        plain.font_loader_flags = _NO_HINTS
        font = io.fonts.add_font_from_file_ttf(str(folder / "Roboto/Roboto-Regular.ttf"), EM, plain)
        icons = imgui.ImFontConfig()
        icons.font_loader_flags = _NO_HINTS
        icons.merge_mode = True
        io.fonts.add_font_from_file_ttf(str(folder / "Font_Awesome_6_Free-Solid-900.otf"), 0.86 * EM, icons)
        apply(palette, scale)
        window = StillWindow((at[0] * scale, at[1] * scale), (size[0] * scale, size[1] * scale))
        window.shapes.em, window.font = EM * scale, font
        with pytest.MonkeyPatch.context() as patch:
            window.watch(patch)
            yield window
    finally:
        imgui.destroy_context(context)
