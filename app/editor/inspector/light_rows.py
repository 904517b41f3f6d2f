"""The rows of the selected light: one for each property of its kind."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from halation.nodes import Light, LightKind, Plain, Value
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...errors import UsageError
from ...graph.values import value_fault
from ..fields.choice_field import choice_field
from ..fields.color_field import color_field
from ..fields.fields import Edit
from ..fields.lights import KINDS, LightProperty, Numbers, change_kind, light_at, parts_of, replace_light
from ..fields.lights_field import find_selected
from ..fields.number_field import number_field, vector_field
from ..fields.numbers import describe_default, describe_value
from ..theme.style import u32, ui_scale
from ..toolkit.places import item_rect
from .applying import as_text, from_text

if TYPE_CHECKING:
    from .rows import Rows

Put = Callable[[Edit], object]

_KIND = Value("kind", "choice", KINDS[0], choices=KINDS, doc="What shines: a point, a cone of light, a sun, a sphere.")


def light_rows(rows: Rows, id: str, value: Numbers, put: Put) -> None:
    """Draw the rows; `put` sets the whole list. Ids of fields contain the light's index: typed text stays with it."""
    index = find_selected(rows.fields, id, value)
    if index < 0:
        return
    light, top = light_at(value, index), imgui.get_cursor_screen_pos()
    _kind(rows, f"{id} {index} kind", light, lambda new_light: put(Edit(replace_light(value, index, new_light))))
    for part in parts_of(light.kind):
        _Row(rows, id, value, index, light, part, put).draw()
    left, scale = top.x - 4.0 * ui_scale(), ui_scale()
    imgui.get_window_draw_list().add_line(
        (left, top.y), (left, item_rect()[3]), u32(rows.palette.accent, 0.6), 2.0 * scale
    )


def _kind(rows: Rows, key: str, light: Light, put: Callable[[Light], object]) -> None:
    rows.name(key, "kind", doc=_KIND.doc)
    edit = choice_field(rows.fields, key, KINDS[light.kind], _KIND, rows.field())
    rows.record(key)
    if edit:
        new_light = change_kind(light, LightKind(KINDS.index(str(edit.value))))
        rows.act(lambda: put(new_light))


class _Row:
    """One row: a property of the light."""

    def __init__(
        self, rows: Rows, id: str, value: Numbers, index: int, light: Light, part: LightProperty, put: Put
    ) -> None:
        self.rows, self.id, self.value, self.index, self.light, self.part = rows, id, value, index, light, part
        self.key, self.plain, self.put = f"{id} {index} {part.name}", part.read_from(light), put

    def draw(self) -> None:
        """Draw the name, the field, and their menu."""
        rows, part, declaration = self.rows, self.part, self.part.declaration
        doc = f"{describe_value(declaration, describe_default(declaration))}\nDouble click: reset. Right click: more."
        rows.name(self.key, declaration.name, doc=doc, changed=self.plain != declaration.default)
        if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left):
            self._set(Edit(declaration.default))
        menu = imgui.is_item_hovered() and imgui.is_mouse_released(imgui.MouseButton_.right)
        rows.fields.part(self.key, self.id, self._whole)
        width = rows.field()
        imgui.begin_group()
        edit = self._field(part, declaration, width)
        imgui.end_group()
        rows.record(self.key)
        menu |= imgui.is_item_hovered() and imgui.is_mouse_released(imgui.MouseButton_.right)
        if edit:
            self._set(edit)
        if menu:
            imgui.open_popup(f"menu {self.key}")
        if imgui.begin_popup(f"menu {self.key}"):
            self._menu()
            imgui.end_popup()

    def _field(self, part: LightProperty, declaration: Value, width: float) -> Edit | None:
        fields, plain = self.rows.fields, self.plain
        match declaration.type:
            case "vector":
                return vector_field(fields, self.key, plain, declaration, width)
            case "color":
                return color_field(fields, self.key, plain, declaration, width, eyedropper=False, alpha=False)
            case _:
                return number_field(fields, self.key, plain, declaration, width, suffix=part.unit(self.light.kind))

    def _menu(self) -> None:
        context, declaration = self.rows.context, self.part.declaration

        def entry(icon: str, label: str, act: Callable[[], object]) -> None:
            if imgui.menu_item(f"{icon}  {label}", "", False)[0]:
                self.rows.act(act)
            context.places[f"menu {label}"] = item_rect()

        entry(icons.ICON_FA_ROTATE_LEFT, "Reset", lambda: self._now(Edit(declaration.default)))
        entry(icons.ICON_FA_COPY, "Copy Value", lambda: context.clipboard.put(as_text(self.plain)))
        entry(icons.ICON_FA_PASTE, "Paste Value", lambda: self._now(Edit(self._read_pasted(context.clipboard.get()))))

    def _read_pasted(self, text: str) -> Plain:
        plain = from_text(text)
        if fault := value_fault(self.part.declaration, plain):
            raise UsageError(f"{self.part.declaration.name}: {fault}")
        return plain

    def _whole(self, edit: Edit) -> Edit | None:
        """An edit of the property as an edit of the whole list, based on the light before the drag."""
        fields, before = self.rows.fields, self.value
        if edit.merge and edit.merge == fields.merge:
            if fields.lights_gesture != edit.merge:
                fields.lights_gesture, fields.before = edit.merge, self.value
            assert isinstance(fields.before, tuple)
            before = fields.before
        new_light = self.part.apply_to(light_at(before, self.index), edit.value)
        return replace(edit, value=replace_light(before, self.index, new_light)) if new_light != self.light else None

    def _now(self, edit: Edit) -> None:
        if whole := self._whole(edit):
            self.put(whole)

    def _set(self, edit: Edit) -> None:
        self.rows.act(lambda: self._now(edit))
