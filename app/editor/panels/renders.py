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
from ..toolkit.buttons import main_button, quiet, right_aligned
from ..toolkit.places import record
from ..toolkit.words import dim, elided, font, nothing_here, tip, wrapped
from .export_form import DEPTHS, FORMATS, VIEWED, Form, Sizing, state_text, title
from .opening_folders import show_folder

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
        self._files(editor)
        self._options(editor)
        wanted = self._form.wanted(editor)
        label = f"{icons.ICON_FA_FILM}  Render"
        if main_button(editor, label, "render", enabled=bool(wanted), width=imgui.get_content_region_avail().x):
            editor.attempt(lambda: self._form.start(editor))
        self._queue(editor)

    def _files(self, editor: Editor) -> None:
        form, wanted = self._form, self._form.wanted(editor)
        button = imgui.calc_text_size(icons.ICON_FA_FOLDER_OPEN).x + 2 * imgui.get_style().frame_padding.x
        for name in editor.session.root.outputs:
            imgui.push_id(name)
            changed, on = imgui.checkbox(name, name in wanted)
            record(editor, f"render {name}")
            if changed:
                form.chosen[name] = on
            imgui.begin_disabled(name not in wanted)
            imgui.same_line(0, 8 * ui_scale())
            if imgui.get_content_region_avail().x < 150 * ui_scale():
                imgui.new_line()
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
        if chosen := _combo(editor, "Format", now, FORMATS):
            form.reform(chosen)
        if chosen := _combo(editor, "Size", form.sizing, _SIZINGS):
            form.sizing = next(one for one in _SIZINGS if one == chosen)
        if form.sizing == "scale":
            _label("")
            imgui.set_next_item_width(-1)
            form.scale = imgui.slider_float("##scale", form.scale, 0.05, 2.0, "x %.2f")[1]
        elif form.sizing == "size":
            _label("")
            imgui.set_next_item_width(-1)
            width, height = imgui.input_int2("##size", list(form.size))[1]
            form.size = (min(max(width, 1), 16384), min(max(height, 1), 16384))
        depth = dict(DEPTHS)
        if chosen := _combo(editor, "Precision", depth[form.precision], tuple(depth.values())):
            form.precision = next(name for name, text in DEPTHS if text == chosen)
        if now in VIEWED or now == "mixed":
            own = "as the output says"
            if chosen := _combo(editor, "View", form.view or own, (own, *views())):
                form.view = "" if chosen == own else chosen

    def _queue(self, editor: Editor) -> None:
        imgui.dummy(ImVec2(0, 2 * ui_scale()))
        imgui.separator()
        exports = editor.exports.all
        if not exports:
            wrapped(editor.palette.dim, "Renders appear here; you can go on working meanwhile.")
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
        imgui.text_unformatted(elided(title(export), imgui.get_content_region_avail().x - 76 * ui_scale()))
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


def _label(text: str) -> None:
    left = imgui.get_cursor_pos_x()
    imgui.align_text_to_frame_padding()
    imgui.text_unformatted(text)
    imgui.same_line(left + 80 * ui_scale())


def _combo(editor: Editor, label: str, now: str, choices: tuple[str, ...]) -> str:
    """A labelled choice; what was chosen in this frame, or ""."""
    _label(label)
    imgui.set_next_item_width(-1)
    chosen = ""
    if imgui.begin_combo(f"##{label}", now):
        for choice in choices:
            if imgui.selectable(choice, choice == now)[0]:
                chosen = choice
            record(editor, f"{label} {choice}")
        imgui.end_combo()
    record(editor, label)
    return chosen
