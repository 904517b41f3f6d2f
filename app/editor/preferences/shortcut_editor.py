"""The page of Preferences where the user changes shortcuts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...language.translation import translate
from ..shared.action import ListedAction
from ..shared.fuzzy import match
from ..shared.keymaps import KEYMAPS
from ..shared.shortcut_groups import group_actions
from ..theme.style import ui_scale, vec4
from ..toolkit.buttons import align_right, quiet_button
from ..toolkit.fields import combo
from ..toolkit.keys import display_shortcut, find_pressed_chord
from ..toolkit.labels import make_label, translate_label
from ..toolkit.places import record
from ..toolkit.words import draw_dim, draw_wrapped, tip
from .shortcut_changes import assign_shortcut, reset_shortcut, take_shortcut

if TYPE_CHECKING:
    from .context import PreferencesContext


class ShortcutEditor:
    """The list of actions: click a shortcut, then press the new keys."""

    def __init__(self, context: PreferencesContext) -> None:
        self._context = context
        self._query = ""
        self._waiting = ""
        self._offered: tuple[str, str] | None = None

    @property
    def listening(self) -> bool:
        """True while the next keys are taken as a shortcut."""
        return bool(self._waiting)

    def draw(self) -> None:
        """Draw into the current window."""
        self._draw_keymaps()
        label = f"{icons.ICON_FA_ROTATE_LEFT}  {translate('Reset all')}"
        imgui.set_next_item_width(220 * ui_scale())
        hint = translate("Search actions")
        self._query = imgui.input_text_with_hint("##actions", hint, self._query)[1]
        record(self._context, "shortcut search")
        align_right(label)
        own = bool(self._context.store.current.shortcuts)
        if quiet_button(
            self._context,
            label,
            "reset shortcuts",
            translate("Reset to the default"),
            enabled=own,
        ):
            self._context.log.attempt(lambda: self._context.store.change(shortcuts={}))
        self._listen()
        self._ask()
        if imgui.begin_child("list", child_flags=imgui.ChildFlags_.nav_flattened.value):
            for title, actions in group_actions(self._context.actions, every=True):
                labels = tuple(translate(action.label) for action in actions)
                matches = sorted(ranked.index for ranked in match(self._query, labels))
                if matches:
                    imgui.separator_text(translate(title, "menu"))
                for index in matches:
                    self._draw_row(actions[index])
        imgui.end_child()

    def stop(self) -> None:
        """Stop listening for keys."""
        self._waiting, self._offered = "", None

    def _draw_keymaps(self) -> None:
        """Draw the choice of a program's shortcuts; the user's own ones stay above them."""
        keymap = self._context.store.current.keymap
        imgui.align_text_to_frame_padding()
        imgui.text_unformatted(translate("Keys as in"))
        tip(translate("The shortcuts of another program. What you change below counts in every keymap."))
        imgui.same_line()
        names = {name.capitalize(): name for name in KEYMAPS}
        if chosen := combo(self._context, "keymap", keymap.capitalize(), tuple(names), 160 * ui_scale()):
            self._context.log.attempt(lambda: self._context.store.change(keymap=names[chosen]))

    def _draw_row(self, action: ListedAction) -> None:
        scale, palette = ui_scale(), self._context.palette
        left = imgui.get_cursor_pos_x()
        room = imgui.get_content_region_avail().x
        imgui.align_text_to_frame_padding()
        imgui.text_unformatted(translate(action.label).removesuffix("..."))
        if action.doc:
            tip(translate(action.doc))
        width = 170 * scale
        imgui.same_line(left + room - width - 34 * scale)
        waiting = self._waiting == action.id
        text = (
            translate("Press keys...")
            if waiting
            else display_shortcut(self._context.actions.shortcut(action.id)) or translate("none", "shortcut")
        )
        changed = action.id in self._context.store.current.shortcuts
        imgui.push_style_color(imgui.Col_.button, vec4(palette.field))
        imgui.push_style_color(imgui.Col_.text, vec4(palette.accent if waiting or changed else palette.text))
        if imgui.button(make_label(text, action.id), ImVec2(width, 0)):
            self._waiting, self._offered = ("" if waiting else action.id), None
        imgui.pop_style_color(2)
        record(self._context, f"shortcut {action.id}")
        if changed:
            imgui.same_line(0, 4 * scale)
            if quiet_button(
                self._context, icons.ICON_FA_ROTATE_LEFT, f"reset {action.id}", translate("Reset to the default")
            ):
                self._context.log.attempt(lambda: reset_shortcut(self._context, action.id))

    def _listen(self) -> None:
        if not self._waiting:
            return
        if imgui.is_key_pressed(imgui.Key.escape, False):
            self._waiting = ""
            return
        keys = find_pressed_chord()
        if not keys:
            return
        id, self._waiting = self._waiting, ""
        if keys in ("Delete", "Backspace") and self._context.actions.default_shortcut(id) != keys:
            self._context.log.attempt(lambda: assign_shortcut(self._context, id, ""))
        elif self._context.actions.conflicts(id, keys):
            self._offered = (id, keys)
        else:
            self._context.log.attempt(lambda: assign_shortcut(self._context, id, keys))

    def _ask(self) -> None:
        """Draw which actions have the shortcut already, and offer to reassign it."""
        if self._waiting:
            draw_dim(self._context, translate("Press the new keys. Escape cancels, Delete removes the shortcut."))
            return
        if self._offered is None:
            draw_dim(self._context, translate("Click a shortcut to change it."))
            return
        id, keys = self._offered
        labels = translate(" and ").join(
            f"'{translate(conflict.label)}'" for conflict in self._context.actions.conflicts(id, keys)
        )
        draw_wrapped(
            self._context.palette.warning,
            translate("{keys} is the shortcut of {labels}.", keys=display_shortcut(keys), labels=labels),
        )
        if imgui.button(translate_label("Reassign")):
            self._offered = None
            self._context.log.attempt(lambda: take_shortcut(self._context, id, keys))
        record(self._context, "take over")
        imgui.same_line()
        if imgui.button(translate_label("Cancel")):
            self._offered = None
        record(self._context, "leave it")
