"""The dialog that saves the selection, or the whole graph, as a preset."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from imgui_bundle import ImVec2, imgui
from msgspec import Struct, field

from ...authoring.edits.extracting import extract_graph
from ...authoring.library import find_preset_file, list_folders, make_preset_name, save_preset, split_tags
from ...authoring.preset_versions import keep_version
from ...document.about import About, find_about
from ...errors import UsageError
from ...language.translation import mark, translate
from ...resources.sandbox import UNRESTRICTED
from ..shared.dialogs import Question
from ..theme.style import ui_scale
from ..toolkit.buttons import main_button, measure_buttons
from ..toolkit.dialogs import backdrop, dialog, escape_pressed
from ..toolkit.fields import combo, label, measure_labels
from ..toolkit.labels import translate_label
from ..toolkit.places import record
from ..toolkit.textures import Textures, fit_picture
from ..toolkit.words import draw_dim, draw_wrapped, font

if TYPE_CHECKING:
    from ...color.transforms import Array
    from .context import PresetContext

_LABELS = 104.0
_TITLES = ("Save", "Name", "Tags", "Description", "Folder")
_PICTURE = 200.0, 112.0
_DOC_LINES = 3
_ENTERED = int(imgui.InputTextFlags_.enter_returns_true)


class _PresetForm(Struct):
    """What the user has typed."""

    name: str = ""
    tags: str = ""
    doc: str = ""
    folder: str = ""
    of_selection: bool = False
    snapshots: list[Array] = field(default_factory=list["Array"])
    """The picture of the viewer, once the viewer has drawn it."""


def _label_width() -> float:
    """The width of the column of names, in units."""
    return measure_labels(map(translate, _TITLES), _LABELS)


class PresetDialog:
    """The dialog *Save as Preset*. Saving changes nothing in the document, so undo does not know of it."""

    def __init__(self, context: PresetContext) -> None:
        self._context = context
        self._form: _PresetForm | None = None
        self._textures = Textures()

    def close(self) -> None:
        """Release textures."""
        self._textures.clear()

    def draw(self) -> None:
        """Draw the dialog, if it is open."""
        if "preset" not in self._context.dialogs.open:
            self._form = None
            return
        if is_new := self._form is None:
            self._form = self._begin()
        form = self._form
        covered = self._context.dialogs.question is not None
        close = backdrop(self._context, "preset") and not covered
        with dialog(self._context, "Save as preset", (640, 0), top=0.4):
            with font(self._context, "bold", 18.0):
                imgui.text_unformatted(translate("Save as preset"))
            imgui.dummy(ImVec2(0, 2 * ui_scale()))
            self._draw_picture(form)
            imgui.same_line(0, 16 * ui_scale())
            imgui.begin_group()
            entered = self._draw_fields(form, is_new)
            imgui.end_group()
            fault = self._find_fault(form)
            accepted, cancelled = self._draw_buttons(fault)
            if not covered:
                close = close or cancelled or escape_pressed()
                if (accepted or (entered and not fault)) and not close:
                    self._context.log.attempt(lambda: self._ask_and_save(form))
        if close:
            self._end()

    def _begin(self) -> _PresetForm:
        self._textures.clear()
        session = self._context.session
        about = find_about(session.graph)
        form = _PresetForm(
            name="" if session.path is None else session.path.stem,
            tags=", ".join(about.tags),
            doc=about.doc,
            folder=str(list_folders(self._context.store.current.preset_folders)[0]),
            of_selection=any(element in session.graph.nodes for element in session.selection),
        )
        if form.of_selection:
            form.name = session.active if session.active in session.graph.nodes else ""
            form.tags = form.doc = ""
        self._context.viewer.snapshot = form.snapshots.append
        return form

    def _end(self) -> None:
        self._context.viewer.snapshot = None
        self._context.dialogs.open.discard("preset")

    # --- parts -------------------------------------------------------------------------------------------------------

    def _draw_picture(self, form: _PresetForm) -> None:
        size = ImVec2(_PICTURE[0] * ui_scale(), _PICTURE[1] * ui_scale())
        corner = imgui.get_cursor_pos()
        if form.snapshots:
            pixels = form.snapshots[0]
            across, down = fit_picture(pixels, size.x, size.y)
            imgui.image(self._textures.get("snapshot", lambda: np.asarray(pixels)), ImVec2(across, down))
        else:
            with font(self._context, "text", 13.0):
                draw_dim(self._context, translate("The viewer shows nothing:\nthere will be no picture."))
        imgui.set_cursor_pos(corner)
        imgui.dummy(size)

    def _draw_fields(self, form: _PresetForm, is_new: bool) -> bool:
        """Draw the fields; True if Enter was pressed in one."""
        if any(element in self._context.session.graph.nodes for element in self._context.session.selection):
            label(translate("Save"), _label_width())
            for text, of_selection in ((mark("Selection"), True), (mark("Whole graph"), False)):
                if imgui.radio_button(translate_label(text), form.of_selection is of_selection):
                    form.of_selection = of_selection
                record(self._context, f"preset {text}")
                imgui.same_line()
            imgui.new_line()
        label(translate("Name"), _label_width())
        if is_new:
            imgui.set_keyboard_focus_here()
        named, form.name = self._draw_text("name", form.name, translate("such as: warm glow"))
        label(translate("Tags"), _label_width())
        tagged, form.tags = self._draw_text("tags", form.tags, translate("glow, night, look"))
        label(translate("Description"), _label_width())
        height = imgui.get_text_line_height() * _DOC_LINES + 2 * imgui.get_style().frame_padding.y
        flags = _ENTERED | int(imgui.InputTextFlags_.ctrl_enter_for_new_line)
        described, form.doc = imgui.input_text_multiline("##preset doc", form.doc, ImVec2(-1, height), flags)
        record(self._context, "preset doc")
        folders = [str(folder) for folder in list_folders(self._context.store.current.preset_folders)]
        if len(folders) > 1:
            label(translate("Folder"), _label_width())
            form.folder = combo(self._context, "preset folder", form.folder, folders) or form.folder
        return named or tagged or described

    def _draw_text(self, name: str, text: str, hint: str) -> tuple[bool, str]:
        """Draw a field; whether Enter was pressed in it, and its text."""
        imgui.set_next_item_width(-1)
        entered, text = imgui.input_text_with_hint(f"##preset {name}", hint, text, _ENTERED)
        record(self._context, f"preset {name}")
        return entered, text

    def _find_fault(self, form: _PresetForm) -> str:
        """Why the name cannot be used; "" if it can, and for an empty one, which needs no message yet."""
        try:
            make_preset_name(form.name)
        except UsageError as fault:
            return str(fault)
        return ""

    def _draw_buttons(self, fault: str) -> tuple[bool, bool]:
        """Whether Save and Cancel were clicked."""
        form = self._form
        typed = form is not None and form.name.strip()
        path = "" if form is None or fault else str(find_preset_file(make_preset_name(form.name), Path(form.folder)))
        draw_wrapped(
            self._context.palette.error if fault and typed else self._context.palette.dim,
            f"{fault[:1].upper()}{fault[1:]}." if fault else path,
        )
        width = measure_buttons(translate("Cancel"), translate("Save"))
        room = imgui.get_content_region_avail().x - 2 * width - imgui.get_style().item_spacing.x
        imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + room)
        cancelled = imgui.button(translate_label("Cancel"), ImVec2(width, 0))
        record(self._context, "preset cancel")
        imgui.same_line()
        return main_button(self._context, translate("Save"), "preset save", width=width, enabled=not fault), cancelled

    # --- saving ------------------------------------------------------------------------------------------------------

    def _ask_and_save(self, form: _PresetForm) -> None:
        """Save the preset; ask first if there is one of that name."""
        path = find_preset_file(make_preset_name(form.name), Path(form.folder))
        if not path.exists():
            self._save(form, path)
            return
        self._context.dialogs.question = Question(
            translate("Replace the preset"),
            translate(
                "There is a preset {stem} in {parent} already. A new version keeps the one that is "
                "there: the start screen lists the versions of a preset on a right click.",
                stem=path.stem,
                parent=path.parent,
            ),
            (
                (translate("Save a new version"), partial(self._save_version, form, path)),
                (translate("Replace it"), partial(self._save, form, path)),
                (translate("Cancel"), lambda: None),
            ),
        )

    def _save_version(self, form: _PresetForm, path: Path) -> None:
        """Save the preset, and keep what it was until now as a version."""
        keep_version(path, UNRESTRICTED)
        self._save(form, path)

    def _save(self, form: _PresetForm, path: Path) -> None:
        session = self._context.session
        graph = extract_graph(session.graph, session.selection) if form.of_selection else session.root
        about = About(" ".join(form.doc.split()), split_tags(form.tags))
        pixels = form.snapshots[0] if form.snapshots else None
        save_preset(graph, about, path, pixels, sandbox=UNRESTRICTED)
        self._context.log.add(translate("saved the preset {stem}", stem=path.stem))
        self._end()
