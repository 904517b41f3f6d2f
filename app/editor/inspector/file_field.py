"""Fields for files and their layers: the path, a summary of the file, and layers with thumbnails."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from halation.nodes import Value
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...authoring.edits import paths
from ...errors import HalationError
from ...language.translation import mark, translate
from ...media import ImageInfo
from ...media.sequences import find_sequence
from ...resources.sandbox import Sandbox
from ...watch.sequence_files import representative_file
from ..fields.fields import Edit, Fields
from ..fields.text_field import text_field
from ..shared.coloring import find_color_manager
from ..shared.dialogs import browse
from ..toolkit.fields import draw_arrow
from ..toolkit.places import item_rect, place, union
from ..toolkit.textures import Textures
from ..toolkit.words import tip, write
from .layers import HEIGHT, WIDTH, Layers, describe_layer

if TYPE_CHECKING:
    from .rows import Rows

_TEXT = Value("path", "text", "")
PICTURE = Value("file", "path", "")
"""The declaration of the file of a graph input."""

FIRST = mark("first color layer")


class FileField:
    """Draws the fields of files, and reads the files in a thread."""

    def __init__(self, fields: Fields, sandbox: Sandbox) -> None:
        self.fields = fields
        self.known = Layers(sandbox)
        self._textures = Textures()

    def close(self) -> None:
        """Stop the threads and release textures."""
        self.known.close()
        self._textures.clear()

    def path(
        self, rows: Rows, key: str, value: str, declaration: Value, width: float, then: Callable[[str], object]
    ) -> Edit | None:
        """Draw the path, red if there is no such file, and a button to browse."""
        side = imgui.get_frame_height()
        missing = bool(value) and bool(self._fault(rows, value, declaration))
        edit = text_field(
            self.fields,
            key,
            value,
            _TEXT,
            width - side - rows.gap * 0.5,
            hint=translate("no file"),
            fault=missing,
            elide_left=True,
            lines=1,
        )
        first = item_rect()
        tip(str(self._full(rows, value)) if value else "")
        imgui.same_line(0.0, rows.gap * 0.5)
        if rows.icon(icons.ICON_FA_FOLDER_OPEN, f"browse {key}", translate("Choose a file")):
            context = rows.context
            context.dialogs.browse = browse(
                declaration,
                lambda path: context.log.attempt(lambda: then(paths.make_relative(path, context.session.root.folder))),
            )
        rows.context.places[f"field {key}"] = union(first, item_rect())
        return edit

    def about(self, rows: Rows, value: str, declaration: Value, layer: str) -> None:
        """Draw a summary of the file, or why it cannot be read."""
        if not value:
            return
        fault = self._fault(rows, value, declaration)
        if fault:
            rows.field_note(fault.removeprefix(f"{self._full(rows, value)}: "), rows.palette.error)
        elif declaration.holds == "picture":
            header = self.known.header(self._file(rows, value))
            frames = _frames(self._full(rows, value), rows.context.session.sandbox)
            rows.field_note(
                frames + describe_layer(header, layer) if isinstance(header, ImageInfo) else translate("reading…")
            )

    def space(self, rows: Rows, value: str, layer: str, chosen_space: str) -> None:
        """Draw the color space of a layer: `chosen_space`, or the detected one; nothing for data."""
        sentence, wrong = (
            ("", False)
            if not value
            else self.known.space(self._file(rows, value), layer, find_color_manager(rows.context), chosen_space)
        )
        if sentence:
            shortened_sentence = sentence.removeprefix(f"{self._file(rows, value)}: ")
            rows.field_note(shortened_sentence, rows.palette.error if wrong else rows.palette.dim)

    def layer(
        self, rows: Rows, key: str, file: str, value: str, width: float, first: str = "", fault: bool = False
    ) -> Edit | None:
        """Draw the layer: a list of those in the file, or a text field if they are unknown. `first` stands for ""."""
        path, first = self._file(rows, file), first or translate(FIRST)
        header = self.known.header(path) if file else translate("no file")
        if not isinstance(header, ImageInfo):
            return text_field(self.fields, key, value, _TEXT, width, hint=first, fault=fault)
        imgui.set_next_item_width(width)
        edit = None
        names = [layer.name for layer in header.layers]
        flags = int(imgui.ComboFlags_.height_large) | int(imgui.ComboFlags_.no_arrow_button)
        ink = rows.palette.error if fault else rows.palette.text if value else rows.palette.dim
        imgui.push_style_color(imgui.Col_.text, imgui.get_color_u32((*ink, 1.0)))
        least = max(width, imgui.get_font_size() * 15.0)
        imgui.set_next_window_size_constraints((least, 0.0), (least * 2, imgui.get_main_viewport().size.y * 0.7))
        opened = imgui.begin_combo(f"##{key}", value or first, flags)
        imgui.pop_style_color()
        rect = item_rect()
        draw_arrow(rows.palette, rect)
        if opened:
            if imgui.selectable(first, not value)[0]:
                edit = Edit("")
            rows.context.places[f"layer {key} "] = item_rect()
            for name in names:
                if self._choice(rows, path, name, name == value):
                    edit = Edit(name)
                rows.context.places[f"layer {key} {name}"] = item_rect()
            imgui.end_combo()
        rows.context.places[f"field {key}"] = rect
        return edit

    def _choice(self, rows: Rows, path: Path, name: str, chosen: bool) -> bool:
        """Draw a layer in the list, with its thumbnail as soon as that is ready."""
        unit = imgui.get_font_size() / 16.0 * 0.66
        size = (WIDTH * unit, HEIGHT * unit)
        rect = place(max(imgui.get_content_region_avail().x, size[0] + imgui.get_font_size() * 7), size[1])
        pressed = imgui.selectable(f"##layer {name}", chosen, 0, (0.0, size[1]))[0]
        lines = imgui.get_window_draw_list()
        pixels = self.known.picture(path, name)
        if pixels is not None:
            texture = self._textures.get((str(path), self.known.version(path), name), lambda: pixels)
            scale = min(size[0] / pixels.shape[1], size[1] / pixels.shape[0])
            wide, high = pixels.shape[1] * scale, pixels.shape[0] * scale
            left, top = rect[0] + (size[0] - wide) / 2, rect[1] + (size[1] - high) / 2
            lines.add_image(texture, (left, top), (left + wide, top + high))
        write((rect[0] + size[0] + rows.gap * 1.5, rect[1], rect[2], rect[3]), name, rows.palette.text)
        return pressed

    def _fault(self, rows: Rows, value: str, declaration: Value) -> str:
        """Why the file cannot be read; "" if it can, or while that is unknown."""
        path = self._file(rows, value)
        if not declaration.pixels:
            return self.known.fault(path)
        header = self.known.header(path)
        return header if isinstance(header, str) else ""

    def _file(self, rows: Rows, value: str) -> Path:
        """The path of the file; of a sequence, one frame that exists."""
        return representative_file(
            self._full(rows, value), rows.context.session.time.frames[0], sandbox=rows.context.session.sandbox
        )

    def _full(self, rows: Rows, value: str) -> Path:
        return Path(rows.context.session.graph.folder, value)


def _frames(path: Path, sandbox: Sandbox) -> str:
    """The frames of a sequence as text; "" for a single picture."""
    try:
        sequence = find_sequence(str(path), sandbox=sandbox)
    except HalationError:
        return ""
    if sequence is None or not sequence.frames:
        return ""
    frames = translate("frames {frames}", frames=sequence.frames_text)
    missing = translate(", {count} missing", count=sequence.missing) if sequence.missing else ""
    return f"{frames}{missing} · "
