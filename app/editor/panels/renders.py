"""Renders to files: what to make, and how far those under way are."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...media import views
from ..dialogs import Browse
from ..editor import Editor
from ..services.exporting import Export
from ..theme.style import ui_scale, vec4
from ..toolkit.buttons import main_button, quiet, right_aligned, room_for
from ..toolkit.fields import combo, label
from ..toolkit.places import record
from ..toolkit.words import dim, elided, fitted, font, nothing_here, tip, wrapped
from .export_form import DEPTHS, FORMATS, VIEWED, Form, Sizing, state_text, title
from .opening_folders import show_folder

_LABELS, _FORM, _WIDE = 80.0, 420.0, 760.0
"""Widths of labels and of the form, and from which width on the renders are beside it."""

_SIZINGS: tuple[Sizing, ...] = ("as it is", "scale", "size")
_COLORS = {"done": "good", "failed": "error", "cancelled": "dim", "running": "text"}


class Renders:
    """A form and a queue. Rendering runs beside the editor, on the graph as it was when it began."""

    title = "Renders"

    def __init__(self) -> None:
        self._form = Form()

    def draw(self, editor: Editor) -> None:
        """Draw into the current window."""
        outputs = editor.session.root.outputs
        if not outputs:
            sentence = "Add a graph output and link a node to it."
            nothing_here(editor, icons.ICON_FA_FILM, "There is nothing to render", sentence)
            return
        room, scale = imgui.get_content_region_avail(), ui_scale()
        if room.x < _WIDE * scale:
            self._draw_form(editor)
            imgui.separator()
            self._queue(editor)
            return
        imgui.begin_child("form", ImVec2(_FORM * scale, room.y))
        self._draw_form(editor)
        imgui.end_child()
        imgui.same_line(0, 20 * scale)
        imgui.begin_child("queue", ImVec2(0, room.y))
        self._queue(editor)
        imgui.end_child()

    def _draw_form(self, editor: Editor) -> None:
        self._files(editor)
        self._options(editor)
        wanted = self._form.wanted(editor)
        title = f"{icons.ICON_FA_FILM}  Render"
        if main_button(editor, title, "render", enabled=bool(wanted), width=imgui.get_content_region_avail().x):
            editor.attempt(lambda: self._form.start(editor))

    def _files(self, editor: Editor) -> None:
        form, wanted = self._form, self._form.wanted(editor)
        button = room_for(icons.ICON_FA_FOLDER_OPEN)
        for name in editor.session.root.outputs:
            imgui.push_id(name)
            left, column = imgui.get_cursor_pos_x(), _LABELS * ui_scale()
            shown = fitted(name, column - imgui.get_frame_height() - imgui.get_style().item_spacing.x)
            changed, on = imgui.checkbox(f"{shown}##on", name in wanted)
            record(editor, f"render {name}")
            tip(name)
            if changed:
                form.chosen[name] = on
            imgui.begin_disabled(name not in wanted)
            imgui.same_line(left + column)
            imgui.set_next_item_width(imgui.get_content_region_avail().x - button - 4 * ui_scale())
            path = str(form.file(editor, name))
            edited, path = imgui.input_text("##file", path)
            if edited:
                form.files[name] = path
            tip(path)
            record(editor, f"render file {name}")
            imgui.same_line(0, 4 * ui_scale())
            if quiet(editor, icons.ICON_FA_FOLDER_OPEN, f"choose {name}", "Choose where to write"):
                chosen = partial(self._chosen, name)
                file = form.file(editor, name)
                editor.dialogs.browse = Browse(f"Render {name} to", "export", chosen, saving=True, name=file.name)
            imgui.end_disabled()
            imgui.pop_id()

    def _chosen(self, output: str, path: Path) -> None:
        self._form.files[output] = str(path)

    def _options(self, editor: Editor) -> None:
        form = self._form
        kinds = {form.file(editor, name).suffix.lower() for name in form.wanted(editor)}
        now = kinds.pop() if len(kinds) == 1 else "mixed"
        if chosen := _choice(editor, "Format", now, FORMATS):
            form.reform(chosen)
        if chosen := _choice(editor, "Size", form.sizing, _SIZINGS):
            form.sizing = next(one for one in _SIZINGS if one == chosen)
        if form.sizing == "scale":
            label("", _LABELS)
            imgui.set_next_item_width(-1)
            form.scale = imgui.slider_float("##scale", form.scale, 0.05, 2.0, "x %.2f")[1]
        elif form.sizing == "size":
            label("", _LABELS)
            imgui.set_next_item_width(-1)
            width, height = imgui.input_int2("##size", list(form.size))[1]
            form.size = (min(max(width, 1), 16384), min(max(height, 1), 16384))
        depth = dict(DEPTHS)
        if chosen := _choice(editor, "Precision", depth[form.precision], tuple(depth.values())):
            form.precision = next(name for name, text in DEPTHS if text == chosen)
        if now in VIEWED or now == "mixed":
            own = "as the output says"
            if chosen := _choice(editor, "View", form.view or own, (own, *views())):
                form.view = "" if chosen == own else chosen

    def _queue(self, editor: Editor) -> None:
        exports = editor.exports.all
        if not exports:
            sentence = "They appear here; you can go on working meanwhile."
            nothing_here(editor, icons.ICON_FA_FILM, "No renders yet", sentence)
            return
        ended = len(exports) - len(editor.exports.running)
        imgui.align_text_to_frame_padding()
        dim(editor, f"{len(exports) - ended} running, {ended} ended")
        right_aligned(f"{icons.ICON_FA_TRASH} Clear")
        doc = "Forget what has ended"
        if quiet(editor, f"{icons.ICON_FA_TRASH}  Clear", "clear renders", doc, enabled=ended > 0):
            editor.exports.clear()
        for index, export in enumerate(reversed(editor.exports.all)):
            imgui.push_id(index)
            _export_row(editor, index, export)
            imgui.pop_id()


def _export_row(editor: Editor, index: int, export: Export) -> None:
    folder = export.destinations[0][1].parent
    buttons = (icons.ICON_FA_XMARK,) if export.state == "running" else (icons.ICON_FA_COPY, icons.ICON_FA_FOLDER_OPEN)
    imgui.align_text_to_frame_padding()
    with font(editor, "bold"):
        room = imgui.get_content_region_avail().x - room_for(*buttons) - 12 * ui_scale()
        imgui.text_unformatted(elided(title(export), room))
    tip("\n".join(str(path) for _, path in export.destinations))
    right_aligned(*buttons)
    if export.state == "running":
        if quiet(editor, icons.ICON_FA_XMARK, f"cancel {index}", "Cancel"):
            export.cancel()
    else:
        if quiet(editor, icons.ICON_FA_COPY, f"copy path {index}", "Copy the path"):
            editor.clipboard.put(str(export.destinations[0][1]))
        imgui.same_line()
        if quiet(editor, icons.ICON_FA_FOLDER_OPEN, f"open folder {index}", f"Show {folder}"):
            _open(editor, folder)
    if export.state == "running":
        fraction = export.done / export.total if export.total else 0.0
        imgui.progress_bar(fraction, ImVec2(-1, imgui.get_text_line_height() + 2 * ui_scale()), state_text(export))
    else:
        color = getattr(editor.palette, _COLORS[export.state])
        imgui.text_colored(vec4(color), state_text(export).capitalize())
    record(editor, f"export {index}")
    if export.sentence:
        wrapped(editor.palette.error, export.sentence)
    for note in export.notes:
        if not export.sentence or export.sentence not in note:
            wrapped(editor.palette.dim, note)


def _open(editor: Editor, folder: Path) -> None:
    if not show_folder(folder):
        editor.clipboard.put(str(folder))
        editor.say(f"no program here shows folders; the path is on the clipboard: {folder}")


def _choice(editor: Editor, title: str, now: str, choices: tuple[str, ...]) -> str:
    """A labelled choice; what was chosen in this frame, or ""."""
    label(title, _LABELS)
    return combo(editor, title, now, choices)
