"""The rows of a cryptomatte node: a list of names to pick from, with a search field."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from halation.nodes import Matte, pick_names, toggle_name
from imgui_bundle import imgui

from ...authoring.commands import SetValue
from ...graph import Port
from ...language.translation import mark, translate
from ..fields.fields import Fields
from ..shared.render_facts import matte_at
from ..theme.style import mix, u32, ui_scale, vec4
from ..toolkit.labels import make_label
from ..toolkit.places import item_rect, place
from ..toolkit.words import SMALL, font, write

if TYPE_CHECKING:
    from .rows import Rows

ROWS = 9
"""The most visible names; longer lists scroll."""

SEARCHED = 6
"""The number of names from which on the list has a search field: more do not fit at one glance."""


class MatteRows:
    """The list of names below the field for names and wildcards."""

    def __init__(self, fields: Fields) -> None:
        self._fields = fields
        self._search: dict[str, str] = {}
        self._known: tuple[object, ...] = ()
        self._picked = frozenset[str]()
        self._seek = ""
        """The last picked name, to which the list scrolls."""
        self._sorted: tuple[object, list[str]] = (None, [])

    def draw(self, rows: Rows, port: Port) -> None:
        """Draw the names of one node; a click picks a name, or unpicks it."""
        matte, key = matte_at(rows.context, port.node), str(port)
        if not isinstance(matte, Matte):
            if matte and matte != translate("no file"):
                rows.field_note(matte, rows.palette.warning)
            return
        if not matte.ids:
            rows.field_note(
                translate("The file has no manifest. Type the names; they are hashed as the renderer does.")
            )
            return
        session = rows.context.session
        pick = str(session.graph.value(port))
        picked = self._of(pick, matte)
        rows.field_note(
            translate(
                "{count} of {total} selected. You can also click in the viewer.",
                count=len(picked),
                total=len(matte.ids),
            )
        )
        if session.graph.links.get(port) is not None:
            return
        names = self._find_names(rows, key, matte)
        self._list(
            rows, key, names, picked, lambda name: session.apply(SetValue(port, toggle_name(pick, name, matte.ids)))
        )
        self._buttons(rows, port)

    # --- parts -------------------------------------------------------------------------------------------------------

    def _of(self, pick: str, matte: Matte) -> frozenset[str]:
        """The picked names; cached until something changes."""
        if not self._known or self._known[0] != pick or self._known[1] is not matte.ids:
            before, same = self._picked, bool(self._known) and self._known[1] is matte.ids
            self._known, self._picked = (pick, matte.ids), pick_names(pick, matte.ids)
            new = self._picked - before if same else frozenset[str]()
            self._seek = next(iter(new)) if len(new) == 1 else ""
        return self._picked

    def _find_names(self, rows: Rows, key: str, matte: Matte) -> list[str]:
        """The names that match the search field, in alphabetical order."""
        if self._sorted[0] is not matte.ids:
            self._sorted = matte.ids, sorted(matte.ids, key=str.casefold)
        names = self._sorted[1]
        if len(names) < SEARCHED:
            return names
        rows.indent()
        imgui.set_next_item_width(rows.field_width)
        hint = translate("Find a name")
        _, text = imgui.input_text_with_hint(f"##search {key}", hint, self._search.get(key, ""))
        self._search[key] = text
        rows.context.places[f"search {key}"] = item_rect()
        return [name for name in names if text.strip().casefold() in name.casefold()]

    def _list(
        self, rows: Rows, key: str, names: list[str], picked: frozenset[str], toggle: Callable[[str], object]
    ) -> None:
        """Draw the names of a matte, only those in sight: a production render has thousands.

        A name picked in the viewer is scrolled to, but not while the mouse is over the list, where the user reads.
        """
        height = imgui.get_text_line_height() + 6.0 * ui_scale()
        rows.indent()
        imgui.push_style_color(imgui.Col_.child_bg, vec4(rows.palette.field))
        size = (rows.field_width, height * min(max(len(names), 1), ROWS))
        imgui.begin_child(f"##{key} names", size, 0, int(imgui.WindowFlags_.no_nav))
        imgui.pop_style_color()
        if self._seek in names and not imgui.is_window_hovered():
            imgui.set_scroll_y((names.index(self._seek) - ROWS / 2) * height)
        self._seek = ""
        imgui.push_style_var(imgui.StyleVar_.item_spacing, (0.0, 0.0))
        if not names:
            write(place(rows.field_width, height), translate("no name matches"), rows.palette.dim, align=0.5)
        clipper = imgui.ListClipper()
        clipper.begin(len(names), height)
        while clipper.step():
            for index in range(clipper.display_start, clipper.display_end):
                if self._name(rows, key, names[index], names[index] in picked, height):
                    rows.act(lambda name=names[index]: toggle(name))
        clipper.end()
        imgui.pop_style_var()
        imgui.end_child()
        rows.context.places[f"names {key}"] = item_rect()

    def _name(self, rows: Rows, key: str, name: str, on: bool, height: float) -> bool:
        """Draw a checkbox with a name; True if it was clicked."""
        palette, scale = rows.palette, ui_scale()
        rect = place(imgui.get_content_region_avail().x, height)
        pressed = imgui.invisible_button(f"##{key} {name}", (rect[2] - rect[0], height))
        rows.context.places[f"name {key} {name}"] = item_rect()
        lines = imgui.get_window_draw_list()
        if imgui.is_item_hovered():
            fill = mix(palette.field, palette.hover, 0.45)
            lines.add_rect_filled(rect[:2], rect[2:], u32(fill), imgui.get_style().frame_rounding)
        side, middle = 13.0 * scale, (rect[1] + rect[3]) / 2
        left = rect[0] + 7.0 * scale
        box = left, middle - side / 2, left + side, middle + side / 2
        if on:
            lines.add_rect_filled(box[:2], box[2:], u32(palette.accent), 3.0 * scale)
            points = ((0.22, 0.52), (0.43, 0.72), (0.78, 0.28))
            corners = [(box[0] + x * side, box[1] + y * side) for x, y in points]
            lines.add_line(corners[0], corners[1], u32(palette.on_accent), 2.0 * scale)
            lines.add_line(corners[1], corners[2], u32(palette.on_accent), 2.0 * scale)
        else:
            lines.add_rect(box[:2], box[2:], u32(palette.dim, 0.7), 3.0 * scale)
        ink = palette.text if on else mix(palette.dim, palette.text, 0.35)
        write((box[2] + 7.0 * scale, rect[1], rect[2] - 4.0 * scale, rect[3]), name, ink)
        return pressed

    def _buttons(self, rows: Rows, port: Port) -> None:
        """Draw the buttons that pick all names or none."""
        session = rows.context.session
        rows.indent()
        width = (rows.field_width - rows.gap) / 2
        with font(rows.context, "text", SMALL):
            for label, pick in ((mark("All"), "*"), (mark("None"), "")):
                if imgui.button(make_label(translate(label), f"{port} {label}"), (width, 0.0)):
                    rows.act(lambda pick=pick: session.apply(SetValue(port, pick)))
                rows.context.places[f"button {label} {port}"] = item_rect()
                if not pick:
                    break
                imgui.same_line(0.0, rows.gap)
