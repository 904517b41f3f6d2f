"""The Scopes panel: histogram, waveform, parade and vectorscope of side A."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...language.translation import translate
from ...renderer.viewing.plates import PlateTexture
from ..shared.coloring import find_color_manager
from ..theme.style import u32, ui_scale
from ..toolkit.buttons import quiet_button, tool, width_of_buttons
from ..toolkit.words import draw_empty_panel
from . import graticules, scope_images
from .geometry import Box, Sight, texels
from .looking import choose_meaning, choose_range, choose_view, display_pixels, look_of
from .reading import ValueReader
from .scopes import extent, measure_clipping, rgb_of
from .state import SCOPES
from .wanted import A

if TYPE_CHECKING:
    from ...authoring.preview import DisplayedImage
    from .context import ViewerContext

SECONDS = 0.2
"""Seconds between two refreshes."""

PLAYING = 0.6
"""Seconds between two refreshes during playback and while a stroke is drawn: measuring takes as long as two frames
(45 ms for 480x270)."""

_ICONS = (icons.ICON_FA_CHART_AREA, icons.ICON_FA_WAVE_SQUARE, icons.ICON_FA_CHART_COLUMN, icons.ICON_FA_CIRCLE_DOT)


class ScopesPanel:
    """Draws the chosen scopes, below each other or side by side."""

    def __init__(self, context: ViewerContext) -> None:
        self._context = context
        self._reader = ValueReader()
        self._plates: dict[str, PlateTexture] = {}
        self._textures: dict[str, int] = {}
        self._mark: object = None
        self._rgb = np.zeros((1, 1, 3), np.float32)
        self._waiting: list[str] = []
        """The scopes that still wait for an update, one in each frame, so that the window stays fluid; "" measures."""
        self._next = 0.0
        self._range = (0.0, 1.0)
        self._clipping = (0.0, 0.0)

    def draw(self) -> None:
        """Draw the tools and the scopes."""
        image = self._context.preview.find_whole_image(A)
        self._draw_tools()
        names = [name for name in SCOPES if name in self._context.viewer.scopes]
        if not names:
            draw_empty_panel(
                self._context,
                icons.ICON_FA_CHART_AREA,
                translate("No scope is chosen"),
                translate("Choose one with the buttons above."),
            )
            return
        if image is None:
            draw_empty_panel(
                self._context,
                icons.ICON_FA_CHART_AREA,
                translate("Nothing to measure yet"),
                translate("Scopes measure what A shows."),
            )
            return
        if image.kind.is_single:
            draw_empty_panel(
                self._context,
                icons.ICON_FA_CHART_AREA,
                translate("Nothing to measure"),
                translate("A shows one value, not a picture."),
            )
            return
        self._refresh(image, names)
        room, gap = imgui.get_content_region_avail(), 6.0 * ui_scale()
        columns = _columns(room.x, room.y, len(names))
        rows = -(-len(names) // columns)
        width = (room.x - gap * (columns - 1)) / columns
        height = max((room.y - gap * (rows - 1)) / rows, 56.0 * ui_scale())
        start = imgui.get_cursor_screen_pos()
        for index, name in enumerate(names):
            x = start.x + index % columns * (width + gap)
            y = start.y + index // columns * (height + gap)
            self._draw_scope(name, (round(x), round(y), round(x + width), round(y + height)))
        imgui.dummy((room.x, rows * (height + gap) - gap))

    # --- parts -------------------------------------------------------------------------------------------------------

    def _draw_tools(self) -> None:
        viewer = self._context.viewer
        gap = 2.0 * ui_scale()
        for icon, name in zip(_ICONS, SCOPES, strict=True):
            tool(self._context, icon, f"scopes.{name}")
            imgui.same_line(0.0, gap)
        _wrap(translate("Log", "histogram"))
        if quiet_button(
            self._context,
            translate("Log", "histogram"),
            "button logarithmic",
            translate("Logarithmic histogram"),
            lit=viewer.scopes_logarithmic,
        ):
            viewer.scopes_logarithmic = not viewer.scopes_logarithmic
        imgui.same_line(0.0, gap)
        label, lit = (translate("Scene"), True) if viewer.scopes_of_scene else (translate("Display"), False)
        _wrap(label)
        doc = translate("Measure scene-linear values, or display values")
        if quiet_button(self._context, label, "button measured", doc, lit=lit):
            viewer.scopes_of_scene = not viewer.scopes_of_scene

    def _refresh(self, image: DisplayedImage, names: list[str]) -> None:
        """Measure again if the picture, or how it is shown, has changed, but not too often. The mark holds all that a
        scope depends on."""
        viewer = self._context.viewer
        mark = (
            image.key,
            image.revision,
            tuple(names),
            viewer.exposure,
            viewer.gamma,
            viewer.view,
            viewer.display,
            viewer.region,
            viewer.scopes_of_scene,
            viewer.scopes_logarithmic,
            viewer.low,
            viewer.high,
            viewer.meaning,
            self._context.palette.name,
        )
        time_now = imgui.get_time()
        if self._waiting:
            self._take_step(image, self._waiting.pop(0))
            return
        if mark == self._mark or time_now < self._next:
            return
        is_hurried = self._context.preview.skims or viewer.brush.stroke != ""
        self._mark, self._next = mark, time_now + (PLAYING if is_hurried else SECONDS)
        self._waiting = ["", *names]  # nothing in this frame, in which the viewer has a new picture to draw

    def _take_step(self, image: DisplayedImage, name: str) -> None:
        """Update a scope, or without a name, what all of them measure."""
        if name:
            self._make(name)
            return
        self._rgb = self._measure_pixels(image)
        self._range = extent(self._rgb) if self._context.viewer.scopes_of_scene else (0.0, 1.0)
        self._clipping = measure_clipping(self._rgb)

    def _make(self, name: str) -> None:
        plate = self._plates.get(name) or self._plates.setdefault(
            name, PlateTexture(self._context.preview.renderer.device)
        )
        pixels = self._image(name, self._rgb, self._context.viewer.scopes_logarithmic, self._context.palette.is_dark)
        self._textures[name] = plate.show(pixels).native_handle

    def _measure_pixels(self, image: DisplayedImage) -> np.ndarray:
        """The picture, or its region, as [h, w, 3]."""
        viewer = self._context.viewer
        whole = self._reader.read_small(self._context.probe, image)
        part = whole
        if viewer.region is not None:
            x, y, width, height = texels(viewer.region, (whole.shape[1], whole.shape[0]))
            part = whole[y : y + height, x : x + width]
        if viewer.scopes_of_scene:
            return rgb_of(part)
        meaning = choose_meaning(viewer, image.kind, lambda: whole)
        port = self._context.session.views.find_port("A")
        view = choose_view(self._context.session.graph, port, image.default_view) if port else ""
        sight = Sight((0.0, 0.0), (1, 1), image.full_size)
        span = choose_range(viewer, meaning, lambda: whole)
        return display_pixels(
            part,
            look_of(
                viewer, sight, meaning, span, view, self._context.palette.surround, find_color_manager(self._context)
            ),
        )

    def _image(self, name: str, rgb: np.ndarray, logarithmic: bool, dark: bool) -> np.ndarray:
        low, high = self._range
        if name == "histogram":
            return scope_images.histogram_image(rgb, low, high, logarithmic, dark)
        if name == "waveform":
            return scope_images.waveform_image(rgb, low, high, dark)
        if name == "parade":
            return scope_images.parade_image(rgb, low, high, dark)
        return scope_images.vectorscope_image(rgb, dark)

    def _draw_scope(self, name: str, box: Box) -> None:
        palette, lines = self._context.palette, imgui.get_window_draw_list()
        back = graticules.back(palette)
        lines.add_rect_filled(box[:2], box[2:], u32(back), 3.0 * ui_scale())
        if name == "vectorscope":
            box = _square(box)
        self._context.places[f"scope {name}"] = box
        if name not in self._textures:
            return
        lines.add_image(imgui.ImTextureRef(self._textures[name]), box[:2], box[2:])
        lines.push_clip_rect(box[:2], box[2:], True)
        if name == "vectorscope":
            graticules.chroma_lines(lines, palette, box)
        elif name == "histogram":
            graticules.range_lines(lines, palette, box, *self._range)
            dark, bright = self._clipping
            graticules.hint(
                lines, palette, box, translate("black {dark:.1%}  white {bright:.1%}", dark=dark, bright=bright)
            )
        else:
            graticules.level_lines(lines, palette, box, *self._range)
        lines.pop_clip_rect()


def _wrap(label: str) -> None:
    """Continue on the same line if a button with that label fits, else on a new one."""
    if width_of_buttons(label) > imgui.get_content_region_avail().x:
        imgui.new_line()


def _columns(width: float, height: float, count: int) -> int:
    """The number of columns that makes scopes least narrow or flat."""

    def badness(columns: int) -> float:
        rows = -(-count // columns)
        shape = (width / columns) / max(height / rows, 1.0)
        return max(shape / 1.6, 1.6 / shape)

    return min(range(1, count + 1), key=badness)


def _square(box: Box) -> Box:
    left, top, right, bottom = box
    half = min(right - left, bottom - top) / 2
    x, y = (left + right) / 2, (top + bottom) / 2
    return x - half, y - half, x + half, y + half
