"""A canvas on which tests paint, without a window."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
from drawn_links import build_scene
from drawn_shapes import DrawnShapes
from halation import document, presets
from halation.editor.canvas import brush as brushes
from halation.editor.canvas import paint_decor
from halation.editor.canvas.brush import DrawContext, TextCache, make_canvas_colors
from halation.editor.canvas.geometry import CanvasTransform
from halation.editor.canvas.scene import CanvasScene
from halation.resources.sandbox import UNRESTRICTED
from imgui_bundle.imgui import ImDrawFlags_


@pytest.fixture(scope="module")
def scene() -> CanvasScene:
    """The canvas of a preset."""
    path = next(path for path in presets.paths() if path.stem == "film_halation")
    return build_scene(document.load(path, sandbox=UNRESTRICTED))


@pytest.fixture
def make_brush(monkeypatch: pytest.MonkeyPatch) -> Callable[..., DrawContext]:
    """`make_brush(zoom, scale, shift)`: a canvas whose letters are half as wide as high."""

    def make(zoom: float = 1.0, scale: float = 1.0, shift: tuple[float, float] = (0.0, 0.0)) -> DrawContext:
        shapes: Any = DrawnShapes(48.0)
        fonts: Any = SimpleNamespace(text=None, bold=None)
        imgui = SimpleNamespace(
            push_font=lambda font, size: setattr(shapes, "em", size),
            pop_font=lambda: None,
            calc_text_size=shapes.measure,
            get_font_size=lambda: shapes.em,
            get_foreground_draw_list=lambda: shapes,
            ImDrawFlags_=ImDrawFlags_,
        )
        for module in (brushes, paint_decor):
            monkeypatch.setattr(module, "imgui", imgui)
        to = CanvasTransform(16.0 * scale + shift[0], 8.0 * scale + shift[1], zoom * scale)
        return DrawContext(shapes, to, zoom, make_canvas_colors("dark"), fonts, TextCache(), (-1e4, -1e4, 1e4, 1e4))

    return make
