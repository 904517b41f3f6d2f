"""The menu of what a side of the viewer shows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, cast

from imgui_bundle import imgui

from ...errors import GraphError
from ...graph import INPUTS, OUTPUTS, Port, signature
from ...language.translation import translate
from ..theme.style import u32, ui_scale
from ..toolkit.buttons import dropdown
from ..toolkit.labels import make_label, translate_label

if TYPE_CHECKING:
    from ...graph import Graph
    from .context import ViewerContext


def ports_of(graph: Graph) -> tuple[tuple[str, tuple[Port, ...]], ...]:
    """All ports that can be shown, grouped, in the order of the graph."""
    nodes = tuple(Port(id, name) for id in _order_nodes(graph) for name in signature(graph.nodes[id]).outputs)
    groups = (
        (translate("Outputs"), tuple(Port(OUTPUTS, name) for name in graph.outputs)),
        (translate("Nodes"), nodes),
        (translate("Inputs"), tuple(Port(INPUTS, name) for name in graph.inputs)),
    )
    return tuple(group for group in groups if group[1])


def title(graph: Graph, port: Port) -> str:
    """The title of a port in a list: only the id for a node with one output."""
    if port.node in (INPUTS, OUTPUTS):
        return port.socket
    return port.node if len(signature(graph.nodes[port.node]).outputs) == 1 else f"{port.node}.{port.socket}"


def pick_port(context: ViewerContext, side: str, label: str) -> None:
    """Draw the button with the shown port, and its menu."""
    name = f"button viewer {side}"
    doc = translate("What {side} shows. Ctrl+1 to Ctrl+9 assign a node to a key, 1 to 9 show it.", side=side)
    dropdown(context, label, name, doc, lambda: list_ports(context, side))
    left, _, right, bottom = context.places[name]
    color = context.palette.accent if side == "A" else context.palette.good
    line = 2.0 * ui_scale()
    imgui.get_window_draw_list().add_rect_filled((left, bottom - line), (right, bottom), u32(color), line / 2)


def list_ports(context: ViewerContext, side: str) -> None:
    """Draw everything that a side can show as entries of the open menu."""
    session = context.session
    chosen = session.views.find_port("A" if side == "A" else "B")
    numbers = {port: number for number, port in session.views.numbered_ports.items()}
    if side == "B" and imgui.menu_item(translate_label("Nothing"), "", chosen is None)[0]:
        session.views.clear("B")
    for heading, ports in ports_of(session.graph):
        imgui.separator_text(heading)
        for port in ports:
            key = str(numbers[port]) if port in numbers else ""
            if imgui.menu_item(make_label(title(session.graph, port), str(port)), key, port == chosen)[0]:
                context.log.attempt(lambda port=port: session.views.show(port, cast("Literal['A', 'B']", side)))


def _order_nodes(graph: Graph) -> tuple[str, ...]:
    try:
        return tuple(reversed(graph.order()))
    except GraphError:  # a loop: any order will do
        return tuple(graph.nodes)
