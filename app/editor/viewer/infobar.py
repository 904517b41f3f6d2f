"""The info line below the picture: what is shown, and the pixel under the pointer."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from halation.nodes import Kind
from imgui_bundle import imgui
from msgspec import Struct

from ...color.management import ColorManager
from ...color.primaries import REC709_LUMINANCE, find_luminance_weights
from ...errors import HalationError
from ...language.translation import translate
from ...renderer.viewing.look import Look
from ..theme.palette import RGB
from ..theme.style import mix, u32, ui_scale
from ..toolkit.words import font
from .geometry import Pixels, Sight
from .looking import display_pixels
from .measuring import format_pixel_number, hsv

if TYPE_CHECKING:
    from ...authoring.preview import DisplayedImage
    from .context import ViewerContext

_LETTERS = "RGBA"
_CHANNEL_COLORS: tuple[RGB, ...] = ((0.93, 0.36, 0.36), (0.30, 0.72, 0.36), (0.36, 0.54, 0.98))


class Word(Struct, frozen=True):
    """A piece of text in the line, and its color; without text it is a square of that color."""

    text: str
    color: RGB
    gap: float = 1.0
    """Space before it, in parts of the font's height."""


def row_height() -> float:
    """The height of one line."""
    return imgui.get_text_line_height() + 6 * ui_scale()


def about(context: ViewerContext, side: str, image: DisplayedImage | None, sight: Sight, seconds: float) -> list[Word]:
    """The text on what a side shows; for A also zoom, proxy and render time."""
    palette, preview = context.palette, context.preview
    words: list[Word] = []
    if context.viewer.compares:
        words.append(Word(side, palette.accent if side == "A" else palette.good))
    if image is not None:
        width, height = image.full_size
        words += [Word(f"{width}\u00d7{height}", palette.text), Word(describe(image.kind, image.channels), palette.dim)]
        if image.pixel_aspect != 1.0:
            words.append(Word(translate("pixel aspect {ratio:.4g}", ratio=image.pixel_aspect), palette.dim))
        if image.scale != 1.0:
            words.append(Word(f"1/{1 / image.scale:.0f}", palette.warning))
    if side != "A":
        return words
    if image is not None and not image.kind.is_single:
        words.append(Word(f"{sight.zoom * 100:.{0 if sight.zoom >= 0.1 else 1}f} %", palette.dim))
    if preview.paused:
        words.append(Word(translate("paused"), palette.warning))
    elif preview.busy and not preview.completing:
        finished, total = preview.progress
        words.append(Word(f"{finished}/{total}", palette.accent))
    elif seconds > 0.0 and image is not None:
        words.append(Word(f"{seconds * 1000:.0f} ms" if seconds < 1.0 else f"{seconds:.1f} s", palette.dim))
    return words


def describe(kind: Kind, channels: int) -> str:
    """The kind of data, as text."""
    if kind.is_color:
        return "RGBA" if kind is Kind.IMAGE else translate("color", "kind")
    name = translate(kind.value.lower(), "kind")
    return f"{name} {channels}" if kind is Kind.VECTOR else name


def of_pixel(
    context: ViewerContext, pixel: Pixels | None, values: tuple[float, ...], kind: Kind, look: Look
) -> list[Word]:
    """The numbers of a pixel: scene-linear, then display-referred."""
    palette = context.palette
    if pixel is None or not values:
        return []
    words = [Word(f"{pixel[0]}, {pixel[1]}", palette.text, 1.5)]
    color = kind.is_color
    for index, value in enumerate(values):
        shade = mix(palette.text, _CHANNEL_COLORS[index], 0.6) if color and index < 3 else palette.text
        shade = shade if np.isfinite(value) else palette.error
        words.append(Word(f"{format_pixel_number(value):>8}", shade, 0.5 if index else 1.0))
    if color:
        display_rgb = display_pixels(np.asarray([[values]], np.float32), look)[0, 0]
        eight = " ".join(f"{int(part * 255 + 0.5):3d}" for part in display_rgb)
        hue, saturation, value = hsv(tuple(float(part) for part in display_rgb))
        luminance = float(np.dot(values[:3], _find_weights(look.manager)))
        words += [
            Word("", (float(display_rgb[0]), float(display_rgb[1]), float(display_rgb[2])), 1.5),
            Word(eight, palette.dim, 0.5),
            Word(f"H{hue:4.0f} S{saturation:5.2f} V{value:5.2f}", palette.dim, 1.5),
            Word(f"L {format_pixel_number(luminance)}", palette.dim, 1.5),
        ]
    return words


def _find_weights(manager: ColorManager) -> tuple[float, ...]:
    """The weights of luminance: those of the working space, so that the number is what a luminance node computes."""
    try:
        return find_luminance_weights(manager)
    except HalationError:  # another place of the window says that the space cannot be used
        return REC709_LUMINANCE


def draw_line(context: ViewerContext, name: str, words: list[Word]) -> None:
    """Draw a line of words, as many as fit."""
    lines = imgui.get_window_draw_list()
    inner = imgui.internal.get_current_window().inner_rect
    left, top, right = inner.min.x, imgui.get_cursor_screen_pos().y, inner.max.x
    height, scale = row_height(), ui_scale()
    lines.add_rect_filled((left, top), (right, top + height), u32(context.palette.panel))
    x, y, end = left + 8 * scale, round(top + 3 * scale), right - 4 * scale
    with font(context, "mono"):
        for number, word in enumerate(words):
            x += word.gap * imgui.get_font_size() if number else 0.0
            width = imgui.calc_text_size(word.text).x if word.text else height - 8 * scale
            if x + width > end:
                break
            if word.text:
                lines.add_text((round(x), y), u32(word.color), word.text)
            else:
                lines.add_rect_filled((x, top + 4 * scale), (x + width, top + height - 4 * scale), u32(word.color))
            x += width
    imgui.set_cursor_screen_pos((left, top))
    imgui.dummy((right - left, height))
    context.places[name] = left, top, right, top + height
