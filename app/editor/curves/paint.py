"""Draws keys, the ruler, the current frame and the selection."""

from __future__ import annotations

from imgui_bundle import imgui

from ...graph import Interpolation
from ..theme.palette import Palette
from ..theme.style import mix, u32
from ..toolkit.plane import Rect, ticks
from .editing import find_frame_range
from .frame import CurvesFrame, draw_small_text

KEY = 5.0
"""Half the width of a key, at UI scale 1."""


def paint_key(draw: imgui.ImDrawList, x: float, y: float, size: float, look: Interpolation | None, color: int) -> None:
    """A key: a square holds, a diamond goes straight, a circle smoothly, an hourglass has handles."""
    if look == "linear" or look is None:
        draw.add_ngon_filled((x, y), size * 1.15, color, 4)
    elif look == "smooth":
        draw.add_circle_filled((x, y), size * 0.95, color, 12)
    elif look == "constant":
        draw.add_rect_filled((x - size * 0.82, y - size * 0.82), (x + size * 0.82, y + size * 0.82), color)
    else:
        wide, high = size * 0.95, size * 1.05
        draw.add_triangle_filled((x - wide, y - high), (x + wide, y - high), (x, y + 0.5), color)
        draw.add_triangle_filled((x - wide, y + high), (x, y - 0.5), (x + wide, y + high), color)


def find_background(palette: Palette) -> int:
    """The color behind keys."""
    return u32(palette.canvas)


def paint_background(frame: CurvesFrame) -> None:
    """Behind everything: the frames of the graph lighter than what lies outside, and lines of the ruler."""
    draw, palette, plane = imgui.get_window_draw_list(), frame.context.palette, frame.plane
    left, top, right, bottom = plane.rect
    draw.add_rect_filled((left, top), (right, bottom), find_background(palette))
    first, last = frame.context.session.time.frames
    shade = u32(palette.shadow, 0.26 if palette.name == "dark" else 0.09)
    a, b = min(max(plane.x(first), left), right), min(max(plane.x(last), left), right)
    draw.add_rect_filled((left, top), (a, bottom), shade)
    draw.add_rect_filled((b, top), (right, bottom), shade)
    strong, faint = u32(mix(palette.grid, palette.dim, 0.22)), u32(mix(palette.canvas, palette.grid, 0.9))
    for tick in ticks(plane.view.first, plane.view.last, plane.across, 64.0 * frame.scale, whole=True):
        x = round(plane.x(tick.at)) + 0.5
        draw.add_line((x, top), (x, bottom), strong if tick.label else faint)


def paint_ruler(frame: CurvesFrame) -> None:
    """Frames above, seconds below."""
    draw, palette, plane, scale = imgui.get_window_draw_list(), frame.context.palette, frame.plane, frame.scale
    session = frame.context.session
    left, top, right, bottom = frame.ruler
    draw.push_clip_rect((left, top), (right, bottom), True)
    draw.add_rect_filled((left, top), (right, bottom), u32(palette.window))
    first, last = session.time.frames
    a, b = max(plane.x(first), left), min(plane.x(last), right)
    if b > a:
        draw.add_rect_filled((a, top), (b, bottom), u32(palette.raised, 0.75 if palette.name == "dark" else 1.0))
        draw.add_rect_filled((a, bottom - 2.0 * scale), (b, bottom), u32(palette.dim, 0.55))
    high = (bottom - top) * 0.52
    line = u32(palette.dim, 0.55)
    for tick in ticks(plane.view.first, plane.view.last, plane.across, 64.0 * scale, whole=True):
        x = round(plane.x(tick.at)) + 0.5
        length = (6.0 if tick.label else 3.0) * scale
        draw.add_line((x, top), (x, top + length), line)
        if tick.label:
            draw_small_text(frame, x + 4.0 * scale, top + high * 0.5 + 1.0 * scale, tick.label, palette.text)
    rate = session.root.settings.rate
    start = first / rate
    for tick in ticks(
        plane.view.first / rate - start, plane.view.last / rate - start, plane.across * rate, 88.0 * scale
    ):
        if tick.label:
            x = round(plane.x((tick.at + start) * rate)) + 0.5
            draw_small_text(
                frame, x + 4.0 * scale, top + high + (bottom - top - high) * 0.42, f"{tick.label} s", palette.dim
            )
    draw.pop_clip_rect()


def paint_current_frame(frame: CurvesFrame, held: bool) -> None:
    """The current frame, over everything."""
    draw, palette, plane, scale = imgui.get_window_draw_list(), frame.context.palette, frame.plane, frame.scale
    left, top, right, bottom = frame.ruler
    x = round(plane.x(frame.context.session.time.frame)) + 0.5
    text = str(frame.context.session.time.frame)
    wide = imgui.calc_text_size(text).x * 0.8 * 0.5 + 6.0 * scale
    frame.context.places["keys now"] = (x - wide, top, x + wide, top + (bottom - top) * 0.55)
    if not left - wide <= x <= right + wide:
        return
    color = u32(palette.accent)
    draw.push_clip_rect((left, top), (right, plane.rect[3]), True)
    draw.add_line((x, top), (x, plane.rect[3]), color, (2.0 if held else 1.25) * scale)
    low = top + (bottom - top) * 0.56
    draw.add_rect_filled((x - wide, top + 1.0), (x + wide, low), color, 3.0 * scale)
    draw_small_text(frame, x, (top + 1.0 + low) * 0.5, text, palette.on_accent, align=0.5)
    draw.pop_clip_rect()


def find_grips(frame: CurvesFrame) -> tuple[float, float, float] | None:
    """Where the bar of the selected keys begins and ends, and how wide its grips are; None without two frames."""
    span = find_frame_range(frame.state.spots)
    if span is None or span[1] <= span[0]:
        return None
    pad = (8.0 + 5.0) * frame.scale
    return frame.plane.x(span[0]) - pad, frame.plane.x(span[1]) + pad, 8.0 * frame.scale


def paint_bar(frame: CurvesFrame, hot: str) -> None:
    """The bar above the keys: it spans the selected keys, and its ends scale them."""
    draw, palette, scale = imgui.get_window_draw_list(), frame.context.palette, frame.scale
    left, top, right, bottom = frame.bar
    draw.push_clip_rect((left, top), (right, bottom), True)
    draw.add_rect_filled((left, top), (right, bottom), u32(mix(palette.canvas, palette.window, 0.55)))
    bar_grips = find_grips(frame)
    if bar_grips:
        start, end, grip = bar_grips
        low, high = top + 2.0 * scale, bottom - 2.0 * scale
        body = u32(palette.accent, 0.55 if hot == "bar" else 0.32)
        draw.add_rect_filled((start, low), (end, high), body, 3.0 * scale)
        for name, x in (("left", start), ("right", end - grip)):
            color = u32(mix(palette.accent, palette.text, 0.25 if hot == name else 0.0))
            draw.add_rect_filled((x, low), (x + grip, high), color, 3.0 * scale)
            frame.context.places[f"keys {name} end"] = (x, top, x + grip, bottom)
    draw.pop_clip_rect()


def paint_box(frame: CurvesFrame, rect: Rect) -> None:
    """The selection box."""
    draw, palette = imgui.get_window_draw_list(), frame.context.palette
    low, high = (min(rect[0], rect[2]), min(rect[1], rect[3])), (max(rect[0], rect[2]), max(rect[1], rect[3]))
    draw.add_rect_filled(low, high, u32(palette.accent, 0.12))
    draw.add_rect(low, high, u32(palette.accent, 0.8))
