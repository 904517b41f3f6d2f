"""The page of a node: what it does, its pictures before and after, its main value from low to high, all of its sockets
and values, what it costs, the presets that use it, and its names in other programs.

Everything on it comes from the declaration of the node and from what the site says about it, so that no page is missing
or out of date. Before and after are pictures of the graph that is open; the strip shows the sample, as the site does.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from halation.nodes import Node
from imgui_bundle import ImVec2, imgui

from ...authoring.preview.preview import Preview
from ...graph import INPUTS, Graph, Port, Unknown, signature
from ...language.translation import translate
from ...reference.node_page import (
    describe_cost,
    describe_example,
    describe_time,
    find_main_value,
    find_users,
    list_names,
)
from ...reference.specimen import CANVAS, drawable_outputs
from ..fields.numbers import describe_default, describe_value
from ..shared.declared_words import describe_type, head_type, name_preset, name_value
from ..theme.style import ui_scale, vec4
from ..toolkit.buttons import close_button
from ..toolkit.dialogs import backdrop, dialog, escape_pressed
from ..toolkit.labels import make_label
from ..toolkit.places import record
from ..toolkit.words import draw_dim, draw_wrapped, font, tip

if TYPE_CHECKING:
    from ...graph import Item, Signature
    from .context import DialogContext

_SIZE = 760.0, 680.0
_PICTURE = 320.0
_NAMES = 150.0


class NodePage:
    """The page of the active node."""

    def __init__(self, context: DialogContext) -> None:
        self._context = context
        self._costs: dict[type[Node], str] = {}
        """What each type costs: to plan it takes some milliseconds."""

    def draw(self) -> None:
        """Draw the page, if it is open."""
        session = self._context.session
        if "node" not in self._context.dialogs.open:
            return
        item = session.graph.nodes.get(session.active)
        close = backdrop(self._context, "node") or item is None or isinstance(item, Unknown)
        with dialog(self._context, "Node", _SIZE):
            if item is not None and not isinstance(item, Unknown):
                self._draw_page(str(session.active), item)
            close = close_button(self._context, "close node") or close or escape_pressed()
        if close:
            self._context.dialogs.open.discard("node")

    def _draw_page(self, id: str, item: Item) -> None:
        palette, interface = self._context.palette, signature(item)
        with font(self._context, "bold", 20.0):
            imgui.text_unformatted(head_type(item.title) if isinstance(item, Node) else id)
        height = imgui.get_content_region_avail().y - imgui.get_frame_height_with_spacing()
        imgui.begin_child("page", ImVec2(0, height), imgui.ChildFlags_.nav_flattened.value)
        for paragraph in describe_item(item):
            draw_wrapped(palette.text, paragraph)
            imgui.spacing()
        self._draw_pictures(id, interface)
        if isinstance(item, Node):
            self._draw_strip(type(item))
        inputs = [
            (name_value(name), translate(socket.doc) or translate(socket.kind, "kind"))
            for name, socket in interface.unfolded_inputs.items()
        ]
        outputs = [
            (name_value(name), translate(output.doc) or translate(output.kind, "kind"))
            for name, output in interface.outputs.items()
        ]
        values = [
            (name_value(value.label or name), describe_value(value, describe_default(value)))
            for name, value in interface.values.items()
            if not value.folded
        ]
        for title, rows in (
            (translate("Inputs"), inputs),
            (translate("Values"), values),
            (translate("Outputs"), outputs),
        ):
            self._draw_rows(title, rows)
        if isinstance(item, Node):
            self._draw_reference(id, type(item))
        imgui.end_child()

    def _draw_strip(self, node: type[Node]) -> None:
        """Draw the node on the sample with its main value from low to high, as far as the pictures are there."""
        strip, value = self._context.strip, find_main_value(node)
        strip.want(node)
        strip.is_shown = True
        if value is None or not strip.numbers:
            return
        imgui.spacing()
        draw_dim(self._context, translate("{name} from low to high", name=name_value(value.label or value.name)))
        gap = imgui.get_style().item_spacing.x
        width = (imgui.get_content_region_avail().x - gap * (len(strip.numbers) - 1)) / len(strip.numbers)
        for index, number in enumerate(strip.numbers):
            if index:
                imgui.same_line(0.0, gap)
            imgui.begin_group()
            texture = strip.find(index)
            across, down = texture.size if texture else CANVAS
            size = ImVec2(width, width * down / across)
            if texture:
                imgui.image(imgui.ImTextureRef(texture.native_handle), size)
            else:
                imgui.dummy(size)
            draw_dim(self._context, f"{number:g}")
            imgui.end_group()
            corner, end = imgui.get_item_rect_min(), imgui.get_item_rect_max()
            self._context.places[f"strip {index}"] = (corner.x, corner.y, end.x, end.y)

    def _draw_reference(self, id: str, node: type[Node]) -> None:
        """Draw what the declaration does not say: cost, presets and names in other programs."""
        presets = find_users().get(node.id, ())
        self._draw_cost(id, node)
        self._draw_text(translate("Presets that use it"), ", ".join(map(name_preset, presets)))
        self._draw_rows(translate("In other programs"), list_names(node))

    def _draw_cost(self, id: str, node: type[Node]) -> None:
        """Draw what the node costs, with its time on this device or a button that measures it."""
        timer = self._context.node_timer
        timer.is_shown = True
        if timer.is_measuring and timer.node is not node:
            timer.stop()
        seconds, cost = timer.seconds.get(node), self._describe_cost(id, node)
        measured = describe_time(seconds, self._context.preview.renderer.device.description) if seconds else ""
        fault = timer.fault if timer.node is node else ""
        self._draw_text(translate("What it costs"), " ".join(filter(None, (cost, measured, fault))))
        if not drawable_outputs(node):
            return
        imgui.begin_disabled(timer.is_measuring)
        label = translate("Measuring…") if timer.is_measuring else translate("Measure the time")
        clicked = imgui.button(make_label(label, "measure node"))
        imgui.end_disabled()
        record(self._context, "measure node")
        tip(translate("Measures how long it takes on this device, at 1920 x 1080"))
        if clicked:
            timer.measure(node)

    def _describe_cost(self, id: str, node: type[Node]) -> str:
        """The cost of the node on the sample, and the time that it took in the graph that is open, if that is known."""
        if node not in self._costs:
            self._costs[node] = " ".join(filter(None, (_describe_values(node), describe_cost(node))))
        timing = self._context.preview.timings.get("/".join((*self._context.session.place, id)))
        if timing is None:
            return self._costs[node]
        here = translate("In this graph it took {milliseconds:.1f} ms.", milliseconds=1e3 * timing.seconds)
        return f"{self._costs[node]} {here}"

    def _draw_text(self, title: str, text: str) -> None:
        if text:
            imgui.spacing()
            imgui.text_colored(vec4(self._context.palette.accent), title)
            draw_wrapped(self._context.palette.dim, text)

    def _draw_pictures(self, id: str, interface: Signature) -> None:
        """Draw what goes into the first input, and what comes out, where the graph has pictures of both."""
        session, scale = self._context.session, ui_scale()
        before = find_picture_before(session.graph, id, interface)
        prefix = "".join(f"{group}/" for group in session.place)
        paths = [
            (title, prefix + path) for title, path in ((translate("Before"), before), (translate("After"), id)) if path
        ]
        pictures = [(title, picture) for title, path in paths if (picture := find_picture(self._context.preview, path))]
        gap = 16.0 * scale
        width = min(_PICTURE * scale, (imgui.get_content_region_avail().x - gap) / 2)
        for index, (title, (reference, across, down)) in enumerate(pictures):
            if index:
                imgui.same_line(0.0, gap)
            imgui.begin_group()
            draw_dim(self._context, title)
            imgui.image(reference, ImVec2(width, width * down / across))
            imgui.end_group()
            corner, end = imgui.get_item_rect_min(), imgui.get_item_rect_max()
            self._context.places[f"picture {title}"] = (corner.x, corner.y, end.x, end.y)

    def _draw_rows(self, title: str, rows: Iterable[tuple[str, str]]) -> None:
        rows = list(rows)
        if not rows:
            return
        imgui.spacing()
        imgui.text_colored(vec4(self._context.palette.accent), title)
        if imgui.begin_table(title, 2, int(imgui.TableFlags_.borders_inner_h)):
            imgui.table_setup_column("name", imgui.TableColumnFlags_.width_fixed.value, _NAMES * ui_scale())
            imgui.table_setup_column("text", imgui.TableColumnFlags_.width_stretch.value)
            for name, text in rows:
                imgui.table_next_row()
                imgui.table_next_column()
                imgui.text_wrapped(name)
                imgui.table_next_column()
                draw_wrapped(self._context.palette.dim, text)
            imgui.end_table()


def _describe_values(node: type[Node]) -> str:
    """The values of the strip and of the cost, where they are not the defaults."""
    values = describe_example(node).replace("`", "")
    return translate("At its defaults it changes nothing. Shown is {values}.", values=values) if values else ""


def describe_item(item: Item) -> tuple[str, ...]:
    """The paragraphs of what a node says about itself."""
    return describe_type(type(item)) if isinstance(item, Node) else ()


def find_picture_before(graph: Graph, id: str, interface: Signature) -> str:
    """The element that feeds the first linked input of a node, as the paths of thumbnails name it; "" for none."""
    for name in interface.unfolded_inputs:
        source = graph.links.get(Port(id, name))
        if source is not None:
            return str(source) if source.node == INPUTS else source.node
    return ""


def find_picture(preview: Preview, path: str) -> tuple[imgui.ImTextureRef, int, int] | None:
    """The thumbnail of an element with its size, None if there is none."""
    thumbnail = preview.thumbnail(path)
    if thumbnail is None:
        return None
    width, height = thumbnail[0].size
    return imgui.ImTextureRef(thumbnail[0].native_handle), width, height
