"""The rows of a value that holds named items: a list of them, buttons, and the fields of the selected one.

The list shows what the fields `color`, `on`, `solo`, `intensity` and `exposure` say, where items have them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from halation.nodes import Items, ItemSet
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui
from msgspec import Struct

from ...authoring.commands import AddItem, DuplicateItem, ExchangeItems, RemoveItem, RenameItem, SetValue
from ...graph import Port
from ...graph.named_items import KIND, join_path
from ...language.translation import mark, translate
from ..fields.colors import swatch
from ..fields.item_facts import choose_item, describe_count, describe_strength, icon_of, neighbor_of
from ..shared.declared_words import name_choice, raise_first
from ..theme.style import mix, u32, ui_scale, vec4
from ..toolkit.buttons import dropdown, quiet_button
from ..toolkit.labels import make_label
from ..toolkit.places import Rect, item_rect, place
from ..toolkit.words import tip, write
from .heading import draw_name_field

if TYPE_CHECKING:
    from .rows import Rows

ROWS = 8
"""The most visible rows; longer lists scroll."""

_MENU = "item menu"
_EITHER = int(imgui.ButtonFlags_.mouse_button_left) | int(imgui.ButtonFlags_.mouse_button_right)


class _ItemAction(Struct, frozen=True):
    """An action on the selected item."""

    icon: str
    label: str
    do: Callable[[], object]
    enabled: bool


class ItemRows(Struct, frozen=True):
    """Draws the items of one value. `draw_field` draws the row of a field of an item."""

    rows: Rows
    port: Port
    declared: Items
    items: ItemSet
    draw_field: Callable[[Port], None]

    @property
    def chosen(self) -> str:
        """The name of the selected item; "" if there is none."""
        return choose_item(self.rows.fields.items, str(self.port), self.items)

    def draw_list(self, width: float) -> None:
        """Draw the list and its buttons."""
        palette = self.rows.palette
        imgui.push_style_color(imgui.Col_.child_bg, vec4(palette.field))
        height = _row_height() * min(max(len(self.items), 1), ROWS)
        imgui.begin_child(f"##{self.port} items", (width, height), 0, int(imgui.WindowFlags_.no_nav))
        imgui.pop_style_color()
        self._draw_entries()
        self._draw_menu()
        imgui.end_child()
        self._draw_buttons(width)

    def draw_fields(self) -> None:
        """Draw the name, the kind and the fields of the selected item."""
        name, rows = self.chosen, self.rows
        if not name:
            return
        top, kind = imgui.get_cursor_screen_pos(), self.declared.by_name[self.items[name].kind]
        draw_name_field(
            rows,
            rows.fields,
            f"{self.port}.{name}",
            name,
            self._rename,
            translate(
                "The name of the {noun}: {port}.{name}",
                noun=translate(self.declared.noun, "item"),
                port=self.port,
                name=name,
            ),
        )
        for field in (KIND, *kind.fields):
            if len(self.declared.kinds) > 1 or field != KIND:
                self.draw_field(Port(self.port.node, join_path(self.port.socket, name, field)))
        left, scale = top.x - 4.0 * ui_scale(), ui_scale()
        imgui.get_window_draw_list().add_line(
            (left, top.y), (left, item_rect()[3]), u32(rows.palette.accent, 0.6), 2.0 * scale
        )

    # --- the list ----------------------------------------------------------------------------------------------------

    def _draw_entries(self) -> None:
        """Draw the visible rows only, since a list may have a thousand items."""
        names, fields, id = list(self.items), self.rows.fields, str(self.port)
        if not names:
            imgui.dummy((1.0, _row_height()))
            pad = imgui.get_style().frame_padding.x
            left, top, _, bottom = item_rect()
            right = left + imgui.get_content_region_avail().x
            write(
                (left + pad, top, right, bottom), describe_count(self.items, self.declared.noun), self.rows.palette.dim
            )
            return
        index, height = names.index(self.chosen), _row_height()
        if fields.items_shown.get(id, names[0]) != self.chosen:
            fields.items_shown[id] = self.chosen
            top = min(max(imgui.get_scroll_y(), (index + 1) * height - imgui.get_window_height()), index * height)
            imgui.set_scroll_y(top)
        imgui.push_style_var(imgui.StyleVar_.item_spacing, (0.0, 0.0))
        clipper = imgui.ListClipper()
        clipper.begin(len(names), height)
        while clipper.step():
            for row in range(clipper.display_start, clipper.display_end):
                self._draw_entry(names[row])
        clipper.end()
        imgui.pop_style_var()

    def _draw_entry(self, name: str) -> None:
        fields, palette, scale, key = self.rows.fields, self.rows.palette, ui_scale(), f"{self.port} {name}"
        settings = self.declared.settings(self.items[name])
        start, rect = imgui.get_cursor_pos(), place(imgui.get_content_region_avail().x, _row_height())
        switches = [switch for switch in _SWITCHES if switch.field in settings]
        side = rect[3] - rect[1] + 2.0 * scale
        edge = rect[2] - side * len(switches)
        imgui.invisible_button(f"##{name}", (max(edge - rect[0], 1.0), rect[3] - rect[1]), _EITHER)
        fields.places[f"item {key}"] = item_rect()
        hovered = imgui.is_item_hovered()
        if imgui.is_item_activated():
            fields.items[str(self.port)] = name
        if hovered and imgui.is_mouse_released(imgui.MouseButton_.right):
            fields.items[str(self.port)] = name
            imgui.open_popup(_MENU)
        if name == self.chosen or hovered:
            strength = 0.3 if name == self.chosen else 0.35
            color = mix(palette.field, palette.accent if name == self.chosen else palette.hover, strength)
            imgui.get_window_draw_list().add_rect_filled(
                rect[:2], rect[2:], u32(color), imgui.get_style().frame_rounding
            )
        self._draw_face(name, settings, (rect[0], rect[1], edge, rect[3]))
        for place_, switch in enumerate(switches):
            imgui.same_line(0.0, 0.0)
            left = edge + side * place_
            self._draw_switch(name, switch, bool(settings[switch.field]), (left, rect[1], left + side, rect[3]))
        imgui.set_cursor_pos((start.x, start.y + _row_height()))

    def _draw_switch(self, name: str, switch: _Switch, is_on: bool, rect: Rect) -> None:
        palette = self.rows.palette
        pressed = imgui.invisible_button(f"##{switch.field} {name}", (rect[2] - rect[0], rect[3] - rect[1]))
        self.rows.fields.places[f"{switch.field} {self.port} {name}"] = item_rect()
        lit = imgui.is_item_hovered() or (is_on and switch.field == "solo")
        tip(switch.doc_on if is_on else switch.doc_off)
        _draw_icon(rect, switch.icon_on if is_on else switch.icon_off, palette.text if lit else palette.dim)
        if pressed:
            port = Port(self.port.node, join_path(self.port.socket, name, switch.field))
            self.rows.act(lambda: self.rows.context.session.apply(SetValue(port, not is_on)))

    def _draw_face(self, name: str, settings: dict[str, Any], rect: Rect) -> None:
        """Draw a row: color (with a bar if the item takes light away), icon, name and intensity."""
        palette, lines, scale = self.rows.palette, imgui.get_window_draw_list(), ui_scale()
        left, top, right, bottom = rect
        pad, is_on = 4.0 * scale, bool(settings.get("on", True))
        if "color" in settings:
            chip = left + pad, top + pad, left + bottom - top, bottom - pad
            lines.add_rect_filled(
                chip[:2], chip[2:], u32(swatch(settings["color"]), 1.0 if is_on else 0.4), 3.0 * scale
            )
            if settings.get("intensity", 0.0) < 0.0:
                lines.add_line((chip[0], chip[3]), (chip[2], chip[1]), u32(palette.field), 4.0 * scale)
                lines.add_line((chip[0], chip[3]), (chip[2], chip[1]), u32(palette.text), 1.5 * scale)
            lines.add_rect(chip[:2], chip[2:], u32(palette.border), 3.0 * scale)
            left = chip[2]
        ink = palette.text if is_on else palette.dim
        icon = left + pad, top, left + bottom - top + pad, bottom
        _draw_icon(icon, icon_of(self.items[name].kind), mix(palette.dim, ink, 0.5))
        number = describe_strength(settings)
        used = write((icon[2] + pad, top, right, bottom), name, ink)
        if number and icon[2] + 4.0 * pad + used + imgui.calc_text_size(number).x <= right:
            write((icon[2], top, right, bottom), number, palette.dim, align=1.0)

    # --- what is done to it ------------------------------------------------------------------------------------------

    def _list_actions(self) -> tuple[_ItemAction, ...]:
        name, session, names = self.chosen, self.rows.context.session, list(self.items)
        has_room = len(self.items) < self.declared.most
        return (
            _ItemAction(
                icons.ICON_FA_CLONE,
                mark("Duplicate"),
                lambda: self._choose(session.apply(DuplicateItem(self.port, name))),
                bool(name) and has_room,
            ),
            _ItemAction(icons.ICON_FA_TRASH, mark("Remove"), self._remove, bool(name)),
            *(self._list_moves(name, names) if self.declared.ordered else ()),
        )

    def _list_moves(self, name: str, names: list[str]) -> tuple[_ItemAction, ...]:
        """Up and down, as far as the list goes."""
        up, down = icons.ICON_FA_ARROW_UP, icons.ICON_FA_ARROW_DOWN
        return (
            _ItemAction(up, mark("Move up"), lambda: self._move(-1), name not in ("", *names[:1])),
            _ItemAction(down, mark("Move down"), lambda: self._move(1), name not in ("", *names[-1:])),
        )

    def _move(self, step: int) -> None:
        """Exchange the selected item with the one before or after it; it stays selected."""
        names = list(self.items)
        other = names[names.index(self.chosen) + step]
        self.rows.context.session.apply(ExchangeItems(self.port, self.chosen, other))
        self._choose(other)

    def _remove(self) -> None:
        name = self.chosen
        after = neighbor_of(self.items, name)
        self.rows.context.session.apply(RemoveItem(self.port, name))
        self._choose(after)

    def _rename(self, new: str) -> None:
        self.rows.context.session.apply(RenameItem(self.port, self.chosen, new))
        self._choose(new.strip())

    def _choose(self, name: str) -> None:
        self.rows.fields.items[str(self.port)] = name

    def _draw_menu(self) -> None:
        """Draw the menu of a row."""
        if not imgui.begin_popup(_MENU):
            return
        for act in self._list_actions():
            if imgui.menu_item(make_label(f"{act.icon}  {translate(act.label)}", act.label), "", False, act.enabled)[0]:
                self.rows.act(act.do)
            self.rows.fields.places[f"menu {act.label}"] = item_rect()
        imgui.end_popup()

    def _draw_buttons(self, width: float) -> None:
        rows, noun, rect = self.rows, self.declared.noun, place(width)
        session, has_room = rows.context.session, len(self.items) < self.declared.most

        def draw_kinds() -> None:
            for kind in self.declared.kinds:
                label = kind.name.capitalize()
                shown = make_label(f"{icon_of(kind.name)}  {raise_first(name_choice(kind.name))}", label)
                if imgui.menu_item(shown, "", False, has_room)[0]:
                    rows.act(lambda name=kind.name: self._choose(session.apply(AddItem(self.port, name))))
                tip(translate(kind.doc))
                rows.fields.places[f"menu {label}"] = item_rect()

        dropdown(
            rows.fields,
            icons.ICON_FA_PLUS,
            f"button add {self.port}",
            translate("Add a {noun}", noun=translate(noun, "item")),
            draw_kinds,
        )
        for act in self._list_actions():
            imgui.same_line(0.0, 0.0)
            doc = translate("{act}: the selected {noun}", act=translate(act.label), noun=translate(noun, "item"))
            key = f"button {act.label.lower()} {self.port}"
            if quiet_button(rows.fields, act.icon, key, doc, enabled=act.enabled):
                rows.act(act.do)
        left = item_rect()[2] + imgui.get_style().item_inner_spacing.x
        words = describe_count(self.items, noun)
        write((left, rect[1], rect[2], rect[3]), words, rows.palette.dim, align=1.0)


class _Switch(Struct, frozen=True):
    """A field that is switched in the list."""

    field: str
    icon_on: str
    icon_off: str
    doc_on: str
    doc_off: str


_SWITCHES = (
    _Switch(
        "solo",
        icons.ICON_FA_STAR,
        icons.ICON_FA_STAR_HALF_STROKE,
        mark("Solo: only this light and other solo lights are on. Click to end it"),
        mark("Click for solo: only this light is on"),
    ),
    _Switch(
        "on",
        icons.ICON_FA_EYE,
        icons.ICON_FA_EYE_SLASH,
        mark("On. Click to switch it off"),
        mark("Off. Click to switch it on"),
    ),
)


def _row_height() -> float:
    return imgui.get_text_line_height() + 6.0 * ui_scale()


def _draw_icon(rect: Rect, icon: str, color: tuple[float, float, float]) -> None:
    size = imgui.calc_text_size(icon)
    x, y = (rect[0] + rect[2] - size.x) * 0.5, (rect[1] + rect[3] - size.y) * 0.5
    imgui.get_window_draw_list().add_text((round(x), round(y)), u32(color), icon)
