"""The focus of depth of field nodes: a point of the picture, or a distance."""

from __future__ import annotations

from typing import TYPE_CHECKING

from halation.nodes import Node

from ...graph import Port
from ...language.translation import translate

if TYPE_CHECKING:
    from ...authoring.session import Session
    from .context import ViewerContext

_CHOICE, _POINT, _DISTANCE = "focus", "focus_point", "focus_distance"


def focuses(item: object) -> bool:
    """True for a node that focuses by depth."""
    return isinstance(item, Node) and "depth" in item.inputs and {_CHOICE, _POINT, _DISTANCE} <= item.values.keys()


def find_focus_port(session: Session) -> Port | None:
    """The focus value of the active node, if it is not linked."""
    item = session.graph.nodes.get(session.active)
    if item is None or not focuses(item):
        return None
    port = Port(session.active, f"{_CHOICE}_{session.graph.value(Port(session.active, _CHOICE))}")
    return port if session.graph.links.get(port) is None else None


def is_distance(port: Port) -> bool:
    """True for a focus distance."""
    return port.socket == _DISTANCE


def is_idle(session: Session, port: Port) -> bool:
    """True for a focus point that has no effect, because the node focuses by distance."""
    item = session.graph.nodes.get(port.node)
    return port.socket == _POINT and focuses(item) and read_focus_choice(session, port.node) != "point"


def read_focus_choice(session: Session, id: str) -> str:
    """How a node focuses: by `point` or `distance`."""
    return str(session.graph.value(Port(id, _CHOICE)))


def pick_focus(context: ViewerContext) -> None:
    """Let the next click on the picture set the focus; a second call cancels that."""
    port = find_focus_port(context.session)
    if port is not None:
        context.viewer.picking = "" if context.viewer.picking == str(port) else str(port)


def distance_in_words(depth: float | None) -> str:
    """A depth as the text of a label."""
    return (
        translate("depth unknown")
        if depth is None
        else translate("nothing here")
        if depth >= 1e9
        else translate("depth {depth:.4g}", depth=depth)
    )
