"""The presets of the start screen: a search field, categories, and cards with pictures."""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING

from halation.presets import picture
from imgui_bundle import ImVec2, imgui

from ...authoring.preset_versions import PresetVersion, list_versions, restore_version
from ...language.translation import translate
from ...media.pictures.thumbnail import load_thumbnail
from ...resources.sandbox import UNRESTRICTED
from ..shared.declared_words import name_category, name_preset, raise_first
from ..shared.entries import preset_entries, rank_entries
from ..theme.style import u32, ui_scale
from ..toolkit.buttons import outline, quiet_button, width_of_buttons
from ..toolkit.labels import make_label
from ..toolkit.places import record
from ..toolkit.textures import Textures
from ..toolkit.words import cut_end, draw_dim, font, tip

if TYPE_CHECKING:
    from ...authoring.library import PresetFacts
    from .context import StartContext

_CARD, _PICTURE_HEIGHT = 200.0, 112.0
_ALL = "all"


class PresetGallery:
    """Cards of presets. Typing searches names, tags and descriptions; Enter opens the first card."""

    def __init__(self, context: StartContext) -> None:
        self._context = context
        self._textures = Textures()
        self._presets: tuple[PresetFacts, ...] = ()
        self._pictured: frozenset[PresetFacts] = frozenset()
        self._query, self._category = "", _ALL
        self._is_new = False

    def begin(self) -> None:
        """Read the library."""
        self._presets = self._context.library.list_presets()
        self._pictured = frozenset(preset for preset in self._presets if picture(preset.path).is_file())
        self._textures.clear()  # a preset that was replaced has another picture
        self._query, self._category, self._is_new = "", _ALL, True

    def close(self) -> None:
        """Release textures."""
        self._textures.clear()

    def draw(self, covered: bool) -> None:
        """Draw the search field, the categories and the cards; a screen that is covered takes no keys."""
        entered, leaves = self._draw_field(covered)
        self._draw_categories()
        presets = self._choose_presets()
        if not presets:
            draw_dim(self._context, translate("No preset matches."))
        imgui.begin_child("cards", ImVec2(0, 0), imgui.ChildFlags_.nav_flattened.value)
        gap = imgui.get_style().item_spacing.x
        room = imgui.get_content_region_avail().x
        count = max(int((room + gap) / (_CARD * ui_scale() + gap)), 1)
        width = (room - gap * (count - 1)) / count
        chosen = presets[0] if entered and presets else None
        for index, preset in enumerate(presets):
            if index % count:
                imgui.same_line()
            if self._draw_card(preset, width):
                chosen = preset
            if preset.is_own:
                self._draw_versions(preset)
            if leaves and index == 0:
                imgui.internal.clear_active_id()
                imgui.internal.focus_item()
                imgui.set_nav_cursor_visible(True)
        imgui.end_child()
        if chosen is not None and not covered:
            self._context.documents.open_preset(chosen.path)

    def _draw_field(self, covered: bool) -> tuple[bool, bool]:
        """Whether Enter was pressed in it, and whether the down arrow was, which leads to the cards."""
        imgui.set_next_item_width(-1)
        if self._is_new and not covered and not imgui.is_window_appearing():
            imgui.set_keyboard_focus_here()
            self._is_new = False
        flags = int(imgui.InputTextFlags_.enter_returns_true)
        hint = translate("Search {count} presets by name or tag", count=len(self._presets))
        entered, self._query = imgui.input_text_with_hint("##presets", hint, self._query, flags)
        record(self._context, "start search")
        leaves = imgui.is_item_active() and imgui.is_key_pressed(imgui.Key.down_arrow)
        if imgui.is_item_active():  # else the library would look for the nearest widget, which is a button at the left
            imgui.internal.set_key_owner(imgui.Key.down_arrow, imgui.get_item_id())
        return entered and bool(self._query.strip()), leaves

    def _draw_categories(self) -> None:
        """Draw a button for each category, in as many rows as they need."""
        right = imgui.get_cursor_screen_pos().x + imgui.get_content_region_avail().x
        names = (_ALL, *dict.fromkeys(preset.category for preset in self._presets))
        for index, name in enumerate(names):
            label = raise_first(name_category(name))
            if index:
                end = imgui.get_item_rect_max().x + imgui.get_style().item_spacing.x + width_of_buttons(label)
                if end < right:
                    imgui.same_line()
            lit = name == self._category
            if quiet_button(self._context, label, f"category {name}", "", lit=lit):
                self._category = _ALL if lit else name

    def _choose_presets(self) -> tuple[PresetFacts, ...]:
        """The presets of the category that the query finds, best first."""
        presets = [preset for preset in self._presets if self._category in (_ALL, preset.category)]
        if not self._query.strip():
            return tuple(presets)
        by_path = {str(preset.path): preset for preset in presets}
        return tuple(by_path[entry.id] for entry in rank_entries(preset_entries(presets), self._query))

    def _draw_versions(self, preset: PresetFacts) -> None:
        """Draw the menu of a card: the versions of a preset, to go back to one."""
        if not imgui.begin_popup_context_item(f"versions {preset.path}"):
            return
        versions = list_versions(preset.path)
        imgui.text_disabled(
            translate("Go back to a version") if versions else translate("There is no other version yet")
        )
        for version in versions:
            kept_at = time.strftime("%Y-%m-%d %H:%M", time.localtime(version.kept_at))
            label = translate("Version {number}, until {time}", number=version.number, time=kept_at)
            if imgui.menu_item(make_label(label, f"version {version.number}"), "", False)[0]:
                self._context.log.attempt(partial(self._restore, preset, version))
            record(self._context, f"version {version.number}")
        imgui.end_popup()

    def _restore(self, preset: PresetFacts, version: PresetVersion) -> None:
        restore_version(preset.path, version, UNRESTRICTED)
        self._context.log.add(
            translate(
                "{name} is version {number} again; what it was is a version now",
                name=preset.name,
                number=version.number,
            )
        )
        query, category = self._query, self._category
        self.begin()
        self._query, self._category = query, category

    def _draw_card(self, preset: PresetFacts, width: float) -> bool:
        """True if it was clicked, or chosen by keyboard."""
        scale, palette = ui_scale(), self._context.palette
        picture_height = width * _PICTURE_HEIGHT / _CARD
        size = ImVec2(width, picture_height + 26 * scale)
        clicked = imgui.invisible_button(f"##{preset.path}", size, int(imgui.ButtonFlags_.enable_nav))
        record(self._context, f"preset {preset.path.stem}")
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        is_focused = imgui.is_item_focused() and imgui.get_io().nav_visible
        lines, rounding = imgui.get_window_draw_list(), imgui.get_style().frame_rounding
        lines.add_rect_filled(low, high, u32(palette.hover if imgui.is_item_hovered() else palette.raised), rounding)
        corner = ImVec2(high.x, low.y + picture_height)
        if preset in self._pictured and imgui.is_item_visible():
            texture = self._context.log.attempt(
                lambda: self._textures.get(
                    preset.path, lambda: load_thumbnail(picture(preset.path), sandbox=UNRESTRICTED)
                )
            )
            if texture is None:  # a damaged picture is named once
                self._pictured -= {preset}
            else:
                lines.add_image_rounded(texture, low, corner, ImVec2(0, 0), ImVec2(1, 1), 0xFFFFFFFF, rounding)
        with font(self._context, "text"):
            name = cut_end(name_preset(preset.path.stem), width - 16 * scale)
        color = palette.error if preset.fault else palette.text
        lines.add_text(ImVec2(low.x + 8 * scale, corner.y + 5 * scale), u32(color), name)
        tip(preset.fault or "\n".join(filter(None, (preset.about.doc, ", ".join(preset.about.tags)))))
        if imgui.is_item_hovered() or is_focused:
            outline(palette.accent)
        return clicked
