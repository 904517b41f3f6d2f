"""The search that adds nodes: a field and a list at the pointer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from halation.nodes import Kind
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui
from msgspec import Struct, field

from ...authoring.commands import (
    AddCodeFile,
    AddComment,
    AddFrame,
    AddGroupFile,
    AddInput,
    AddNode,
    AddOutput,
    AppendNode,
    ReplaceNode,
)
from ...authoring.edits.coding import with_code_type
from ...authoring.edits.element_id import ElementId
from ...authoring.edits.wiring import fits_picture, list_fitting_types
from ...authoring.state.group_files import GroupFiles
from ...graph import Port
from ...graph.names import fresh_name
from ...language.translation import translate
from ..shared.declared_words import name_category
from ..shared.entries import (
    GRAPH,
    GROUP,
    SHADER,
    CatalogEntry,
    Section,
    arrange_entries,
    code_entries,
    graph_entries,
    keep_fitting,
    mode_entries,
    node_entries,
    preset_entries,
    shader_entries,
)
from ..theme.style import mix, u32, ui_scale, vec4
from ..toolkit.fields import keep_typing
from ..toolkit.keys import is_enter_pressed
from ..toolkit.labels import make_label
from ..toolkit.places import record
from .geometry import Point

if TYPE_CHECKING:
    from .context import CanvasContext

_POPUP = "add to the graph"
_RECENT = 5
"""Nodes that were added last, on top of an empty search."""
_FLAGS = int(imgui.WindowFlags_.no_move) | int(imgui.WindowFlags_.no_scrollbar)
_WIDTH, _HEIGHT = 340.0, 380.0
_FOOT_LINES = 3
"""Lines below the list: no first line of a node's text is longer at this width."""


class NodeSearch(Struct):
    """The search popup: its text, the marked line, and where the new node goes."""

    context: CanvasContext
    is_open: bool = False
    _query: str = ""
    _marked: int = 0
    _at: Point = (0.0, 0.0)
    _link: tuple[Port, bool] | None = None
    _replaced: str = ""
    """The node to replace, or empty for a new node."""
    _entries: tuple[CatalogEntry, ...] = ()
    _awaits: bool = False
    """True while a search for the shader files of this machine runs; its shaders are added at the end."""
    _recent: list[str] = field(default_factory=list[str])
    _opening: bool = False
    _arranged: tuple[object, tuple[Section, ...]] = ((), ())
    _groups: GroupFiles = field(default_factory=GroupFiles)

    def begin(self, at: Point, port: Port | None = None, output: bool = True) -> None:
        """Open the search at a canvas position; with a port, for nodes that can be linked with it."""
        session = self.context.session
        self._replaced = ""
        presets = self.context.library.list_presets()
        nodes = (*node_entries(session.types), *mode_entries(session.types))
        entries = (*nodes, *code_entries(), *preset_entries(presets), *graph_entries())
        if port is None:
            self._link, self._entries = None, entries
        else:
            self._link = port, output
            fitting = self.context.log.attempt(lambda: self._list_fitting(port, output), frozenset())
            self._entries = keep_fitting(entries, fitting or ())
        self._at, self._query, self._marked, self._opening, self._awaits = at, "", 0, True, True

    def _list_fitting(self, port: Port, output: bool) -> frozenset[str]:
        """The node types and presets that could be linked with a port."""
        session = self.context.session
        types = list_fitting_types(session.graph, port, output, with_code_type(session.types))
        presets = [preset.path for preset in self.context.library.list_presets() if not preset.fault]
        files = self._groups.list_fitting(presets, session, port, output)
        return frozenset((*types, *map(str, files)))

    def begin_replacing(self, id: str) -> None:
        """Open the search for another type of a node."""
        node = self.context.session.graph.nodes.get(id)
        types = [type for type in self.context.session.types if not isinstance(node, self.context.session.types[type])]
        self._link, self._replaced = None, id
        self._entries = (*keep_fitting(node_entries(self.context.session.types), types), *code_entries())
        self._query, self._marked, self._opening, self._awaits = "", 0, True, False

    def draw(self) -> None:
        """Draw the popup, if it is open, and add the chosen entry."""
        scale = ui_scale()
        if self._opening:
            imgui.open_popup(_POPUP)
            mouse = imgui.get_mouse_pos()
            imgui.set_next_window_pos((mouse.x - 12 * scale, mouse.y - 12 * scale))
        imgui.set_next_window_size((_WIDTH * scale, _HEIGHT * scale))
        self.is_open = imgui.begin_popup(_POPUP, _FLAGS)
        if not self.is_open:
            self._opening = False
            return
        if self._awaits:
            self._add_shaders()
        self._opening = False
        chosen = self._draw_contents()
        if chosen or imgui.is_key_pressed(imgui.Key.escape):
            imgui.close_current_popup()
        imgui.end_popup()
        if chosen:
            self.context.log.attempt(lambda: self._add(chosen))

    def _add_shaders(self) -> None:
        files = self.context.shaders.find(self.context.store.current.isf_folders)
        if files is None:
            return
        self._awaits = False
        if self._link is not None:
            port, output = self._link
            takes = self.context.log.attempt(lambda: fits_picture(self.context.session.graph, port, output), False)
            files = [shader for shader in files if takes and (shader.has_image_input or not output)]
        self._entries = (*self._entries, *shader_entries(files))

    def _draw_contents(self) -> CatalogEntry | None:
        keep_typing()
        imgui.set_next_item_width(-1)
        hint = (
            translate("Search what fits {socket}", socket=self._link[0])
            if self._link
            else translate("Search nodes, presets, frames ...")
        )
        hint = translate("Replace {replaced} by ...", replaced=self._replaced) if self._replaced else hint
        before = self._query
        _, self._query = imgui.input_text_with_hint("##search", hint, self._query)
        record(self.context, "search field")
        if self._query != before:
            self._marked = 0
        sections = self._arrange()
        lines = [entry for section in sections for entry in section.entries]
        moved = _read_arrows()
        self._marked = min(max(self._marked + moved, 0), max(len(lines) - 1, 0))
        chosen = None
        foot = imgui.get_text_line_height() * _FOOT_LINES + imgui.get_style().item_spacing.y * 2 + 2.0 * ui_scale()
        if imgui.begin_child("##found", (0, -foot)):
            chosen = self._draw_list(sections, bool(moved) or self._query != before)
        imgui.end_child()
        self._draw_footer(lines)
        return lines[self._marked] if lines and is_enter_pressed() else chosen

    def _arrange(self) -> tuple[Section, ...]:
        """The list for the query; the same one as in the last frame if nothing has changed."""
        inputs = self._entries, self._query, tuple(self._recent)
        if self._arranged[0] != inputs:
            self._arranged = inputs, arrange_entries(*inputs)
        return self._arranged[1]

    def _draw_list(self, sections: tuple[Section, ...], follow: bool) -> CatalogEntry | None:
        chosen, index = None, 0
        palette, scale = self.context.palette, ui_scale()
        draw = imgui.get_window_draw_list()
        for section in sections:
            if section.title:
                imgui.push_font(self.context.fonts.bold if self.context.fonts else None, 12.0)
                imgui.text_colored(vec4(palette.dim), name_category(section.title).upper())
                imgui.pop_font()
            for entry in section.entries:
                corner = imgui.get_cursor_screen_pos()
                marked = index == self._marked
                if imgui.selectable(make_label(f"      {entry.shown}", f"{section.title} {entry.id}"), marked)[0]:
                    chosen = entry
                record(self.context, f"search {entry.title}")
                if imgui.is_item_hovered() and _is_mouse_moving():
                    self._marked = index
                if marked and follow:
                    imgui.set_scroll_here_y()
                middle = corner.y + imgui.get_text_line_height() / 2
                color = mix(palette.category(entry.kind or entry.category), palette.text, 0.2)
                draw.add_rect_filled(
                    (corner.x + 2 * scale, middle - 5 * scale),
                    (corner.x + 12 * scale, middle + 5 * scale),
                    u32(color),
                    3 * scale,
                )
                if not section.title or section.title == "recent":
                    category = name_category(entry.category)
                    width = imgui.calc_text_size(category).x
                    right = corner.x + imgui.get_content_region_avail().x - width
                    draw.add_text((right, corner.y), u32(palette.dim, 0.8), category)
                index += 1
        if not index:
            imgui.text_colored(vec4(palette.dim), translate("No node or preset matches."))
        return chosen

    def _draw_footer(self, lines: list[CatalogEntry]) -> None:
        imgui.separator()
        doc = lines[self._marked].doc if lines else ""
        imgui.push_style_color(imgui.Col_.text, vec4(self.context.palette.dim))
        keys = f"{icons.ICON_FA_ARROW_UP}{icons.ICON_FA_ARROW_DOWN} {translate('choose, Enter adds, Escape closes')}"
        imgui.text_wrapped(doc or keys)
        imgui.pop_style_color()

    def _add(self, entry: CatalogEntry) -> None:
        session, at = self.context.session, self._at
        if self._replaced:
            session.apply(ReplaceNode(self._replaced, entry.id))
            return
        port, output = self._link or (None, True)
        self._recent = [entry.id, *(id for id in self._recent if id != entry.id)][:_RECENT]
        if port is not None:
            # The socket that takes the link lies near the pointer, not the node's corner.
            at = (at[0] - (0.0 if output else 184.0), at[1] - 48.0)
        if entry.category != GRAPH or entry.kind == SHADER:
            if entry.kind == SHADER:
                addition = AddCodeFile(entry.id, at, port, output)
            elif entry.category == GROUP:
                addition = AddGroupFile(entry.id, at, port, output)
            else:
                addition = AddNode(entry.id, at, port, output, entry.values)
            canvas = self.context.canvas
            id = session.apply(addition if port is not None else AppendNode(addition, canvas.sizes))
            canvas.reveal((ElementId(id),))
        elif entry.id == "frame":
            session.apply(AddFrame("", at))
        elif entry.id == "comment":
            session.apply(AddComment(at, ""))
        else:
            side, _, kind = entry.id.partition(":")
            _add_end(self.context, side, Kind(kind), at)


def _add_end(context: CanvasContext, side: str, kind: Kind, at: Point) -> None:
    session = context.session
    ends = session.graph.inputs if side == "input" else session.graph.outputs
    name = fresh_name(kind.lower(), ends)
    if side == "input":
        session.apply(AddInput(name, kind, at=at))
    else:
        session.apply(AddOutput(name, kind, at=at))


def _read_arrows() -> int:
    return imgui.is_key_pressed(imgui.Key.down_arrow) - imgui.is_key_pressed(imgui.Key.up_arrow)


def _is_mouse_moving() -> bool:
    delta = imgui.get_io().mouse_delta
    return bool(delta.x or delta.y)
