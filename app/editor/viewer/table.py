"""The pixel table: values of every layer under the pointer, at markers, and of a measured rectangle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from imgui_bundle import imgui

from ...errors import HalationError
from ...language.translation import translate
from ..theme.style import ui_scale, vec4
from ..toolkit.words import draw_dim, font
from .geometry import Pixels
from .measuring import format_pixel_number
from .reading import ValueReader
from .wanted import layer

if TYPE_CHECKING:
    from ...authoring.preview import DisplayedImage
    from .context import ViewerContext

_FLAGS = (
    int(imgui.TableFlags_.row_bg)
    | int(imgui.TableFlags_.scroll_y)
    | int(imgui.TableFlags_.sizing_fixed_fit)
    | int(imgui.TableFlags_.borders_inner_v)
    | int(imgui.TableFlags_.pad_outer_x)
)
_HEADINGS = ("", "x, y", *(f"{pair:>9}" for pair in ("R / X", "G / Y", "B / Z", "A / W")))


def rows_of(context: ViewerContext, reader: ValueReader) -> list[tuple[str, str, tuple[float, ...]]]:
    """The rows of the table: name, pixel, numbers.

    Where a newer part of a picture is shown, its pixels are read; outside of that part those of the whole picture.
    """
    viewer = context.viewer
    rows: list[tuple[str, str, tuple[float, ...]]] = []
    layers = _layers(context)
    points: list[tuple[str, Pixels]] = []
    if viewer.pixel is not None:
        points.append(("", viewer.pixel))
    width, height = viewer.picture
    points += ((f"{number}", (int(x * width), int(y * height))) for number, (x, y) in enumerate(viewer.markers, 1))
    for mark, pixel in points:
        for name, image in layers:
            if mark and name not in ("A", "B"):
                continue
            at = _same_place(pixel, viewer.picture, image.full_size)
            newer = (context.preview.find_visible_image(name) if name in ("A", "B") else None) or image
            values = reader.read_pixel(context.probe, f"table {mark} {name}", newer, at)
            values = values or reader.read_pixel(context.probe, f"table {mark} {name}", image, at)
            rows.append((f"{name} {mark}".strip(), f"{at[0]}, {at[1]}", values))
    box = viewer.measured or viewer.region
    if box is not None:
        for name, image in layers:
            if name not in ("A", "B"):
                continue
            statistics = reader.measure_box(context.probe, name, image, box)
            rows += [
                (translate("{name} least", name=name), "", statistics.low),
                (translate("{name} mean", name=name), f"{statistics.count} px", statistics.mean),
                (
                    translate("{name} most", name=name),
                    f"{statistics.wrong} NaN" if statistics.wrong else "",
                    statistics.high,
                ),
            ]
    return rows


def draw_table(context: ViewerContext, reader: ValueReader, height: float) -> None:
    """Draw the table."""
    try:
        rows = rows_of(context, reader)
    except HalationError as error:
        imgui.text_wrapped(str(error))
        return
    with font(context, "mono"):
        imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + 2 * ui_scale())
        if imgui.begin_table("pixel values", len(_HEADINGS), _FLAGS, (0, height)):
            imgui.table_setup_scroll_freeze(0, 1)
            longest = max((imgui.calc_text_size(name).x for name, _, _ in rows), default=0.0)
            for number, heading in enumerate(_HEADINGS):
                width = imgui.get_font_size() * (6.0, 5.5, 4.6, 4.6, 4.6, 4.6)[number]
                width = width if number else max(width, longest)
                imgui.table_setup_column(heading, int(imgui.TableColumnFlags_.width_fixed), width)
            imgui.table_headers_row()
            for name, place, values in rows:
                _row(context, name, place, values)
            imgui.end_table()


def _row(context: ViewerContext, name: str, place: str, values: tuple[float, ...]) -> None:
    imgui.table_next_row()
    imgui.table_next_column()
    imgui.text(name)
    imgui.table_next_column()
    draw_dim(context, place)
    for value in values:
        imgui.table_next_column()
        color = context.palette.text if np.isfinite(value) else context.palette.error
        imgui.text_colored(vec4(color), f"{format_pixel_number(value):>9}")


def _layers(context: ViewerContext) -> list[tuple[str, DisplayedImage]]:
    """The pictures of A, B and the inputs of the graph that are ready."""
    names = [("A", "A")]
    if context.viewer.compares:
        names.append(("B", "B"))
    names += ((name, layer(name)) for name in context.session.graph.inputs)
    return [(name, image) for name, key in names if (image := context.preview.find_whole_image(key)) is not None]


def _same_place(pixel: Pixels, of: Pixels, size: Pixels) -> Pixels:
    """The pixel at the same relative position of a picture of another size."""
    x, y = (min(int((pixel[i] + 0.5) * size[i] / max(of[i], 1)), size[i] - 1) for i in (0, 1))
    return x, y
