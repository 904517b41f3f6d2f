"""The line at the bottom of the window: what is going on, and what things cost."""

from __future__ import annotations

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ..editor import Editor
from ..theme.style import vec4


def draw_status(editor: Editor) -> None:
    """What was said last on the left, figures on the right."""
    palette = editor.palette
    newest = editor.log.entries[-1] if editor.log.entries else None
    if newest:
        color = {"info": palette.dim, "warning": palette.warning, "error": palette.error}[newest.level]
        imgui.text_colored(vec4(color), newest.sentence.splitlines()[0])
    figures = _figures(editor)
    width = imgui.calc_text_size(figures).x
    imgui.same_line(max(imgui.get_window_width() - width - imgui.get_font_size(), 0))
    imgui.text_colored(vec4(palette.dim), figures)


def _figures(editor: Editor) -> str:
    used, budget = editor.preview.memory
    done, total = editor.preview.progress
    count = len(editor.session.graph.nodes)
    parts = [f"{count} node{'' if count == 1 else 's'}", f"{used / 2**20:.0f} of {budget / 2**20:.0f} MiB"]
    if editor.preview.paused:
        parts.insert(0, f"{icons.ICON_FA_PAUSE} paused")
    elif editor.preview.busy:
        parts.insert(0, f"pass {done} of {total}")
    return "   ".join(parts)
