"""The status line at the bottom of the window: the last message or hints, and time and memory."""

from __future__ import annotations

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...language.translation import translate, translate_plural
from ..theme.style import vec4
from ..toolkit.places import record
from ..toolkit.words import cut_end, draw_dim, font, level_color
from ..viewer.wanted import A
from .contexts import Contexts
from .editor import Editor
from .hints import list_hints
from .panels import DOCKED

SECONDS = 8.0
"""Seconds for which a message stays."""


def draw_status(editor: Editor, contexts: Contexts) -> None:
    """Draw the message or hints on the left, figures on the right."""
    figures = _figures(editor)
    end = imgui.get_window_width() - imgui.get_style().window_padding.x
    left = max(end - imgui.calc_text_size(figures).x, 0.0)
    newest = editor.log.entries[-1] if editor.log.entries else None
    imgui.set_cursor_pos_x(imgui.get_style().window_padding.x)
    if newest and editor.log.age(newest) < SECONDS:
        text = cut_end(newest.sentence.splitlines()[0], left - 2 * imgui.get_font_size())
        imgui.text_colored(vec4(level_color(editor.palette, newest.level)), text)
    else:
        _draw_hints(editor, contexts, left)
    imgui.same_line(left)
    used, budget = editor.preview.memory
    imgui.text_colored(vec4(editor.palette.warning if used > budget else editor.palette.dim), figures)
    record(editor, "status figures")


def _draw_hints(editor: Editor, contexts: Contexts, end: float) -> None:
    """Draw as many hints as fit."""
    gap = imgui.get_font_size()
    for index, (keys, does) in enumerate(list_hints(editor, contexts.viewer, _panel_below(editor))):
        with font(contexts.dialogs, "bold"):
            width = imgui.calc_text_size(keys).x
        if index:
            imgui.same_line(0.0, gap * 1.4)
        if imgui.get_cursor_pos_x() + width + imgui.calc_text_size(does).x + gap > end:
            imgui.text_unformatted("")
            break
        with font(contexts.dialogs, "bold"):
            draw_dim(editor, keys)
        imgui.same_line(0.0, gap * 0.4)
        draw_dim(editor, does)


def _panel_below(editor: Editor) -> str:
    """The title of the panel that the mouse is over."""
    if editor.dialogs.any:
        return ""
    mouse = imgui.get_mouse_pos()
    for title in ("Timeline", *(docked.title for docked in DOCKED)):
        left, top, right, bottom = editor.places.get(title, (0.0, 0.0, 0.0, 0.0))
        if left <= mouse.x < right and top <= mouse.y < bottom:
            return title
    return ""


def _figures(editor: Editor) -> str:
    used, budget = editor.preview.memory
    computed, total = editor.preview.progress
    count = len(editor.session.graph.nodes)
    parts = [
        translate_plural("{count} node", "{count} nodes", count),
        translate("{used:.0f} of {budget:.0f} MiB", used=used / 2**20, budget=budget / 2**20),
    ]
    if editor.preview.paused:
        parts.insert(0, f"{icons.ICON_FA_PAUSE} {translate('paused')}")
    elif lead := editor.preview.lead:
        words = translate("planning {done} of {total}", done=lead[1], total=lead[2])
        if lead[0] == "pre-roll":
            words = translate("pre-roll {done} of {total}", done=lead[1], total=lead[2])
        parts.insert(0, words)
    elif (picture := editor.preview.find_visible_image(A)) and picture.partial:
        width, height = picture.texture.size
        parts.insert(0, translate("region {width}\u00d7{height}", width=width, height=height))
    elif editor.preview.busy:
        parts.insert(0, translate("pass {done} of {total}", done=computed, total=total))
    return "   ".join(parts)
