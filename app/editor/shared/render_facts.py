"""Facts about the renders that nodes read, for panels. Nothing here draws."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from halation.nodes import Matte, Node, Value, matte_of

from ...graph import Graph, Port
from ...language.translation import translate
from ...render_layers.conventions import Convention
from ...render_layers.naming import Role
from ...render_layers.overview import RenderOverview, RoleUse
from ...render_layers.report import describe_certainty
from .declared_words import name_choice, name_choices

if TYPE_CHECKING:
    from ...authoring.background.render_overviews import RenderOverviews
    from ...authoring.session import Session


class RenderContext(Protocol):
    """The context of a panel that shows what is known of renders."""

    @property
    def session(self) -> Session: ...

    @property
    def renders(self) -> RenderOverviews: ...


FOUND = "found"
"""The choice that detects a convention from the file."""


def render_path(item: object) -> str:
    """The name of the value with the path of a render, "" for nodes that read none."""
    values = item.values.values() if isinstance(item, Node) else ()
    return next((value.name for value in values if value.type == "path" and value.holds == "render"), "")


def render_file(graph: Graph, id: str) -> Path | None:
    """The file of the render that a node reads, if any."""
    item = graph.nodes.get(id)
    name = render_path(item)
    path = str(getattr(item, name)) if name else ""
    return Path(graph.folder, path) if path else None


def overview_of(context: RenderContext, id: str) -> RenderOverview | str | None:
    """The contents of a node's render; a sentence if it is missing or unreadable, None while it is being read."""
    graph = context.session.graph
    file = render_file(graph, id)
    return translate("no file") if file is None else context.renders.overview(file, find_named_layers(graph.nodes[id]))


def find_named_layers(item: object) -> Mapping[str, str]:
    """The layers that the user chose for a node, by role."""
    if not isinstance(item, Node):
        return {}
    values = item.values.values()
    return {value.role: str(item.setting(value.name)) for value in values if value.role and value.type == "text"}


def use_of(context: RenderContext, port: Port, declaration: Value) -> RoleUse | None:
    """The use of the layer that a value chooses."""
    overview = overview_of(context, port.node) if declaration.role else None
    return overview.uses.get(Role(declaration.role)) if isinstance(overview, RenderOverview) else None


def first_words(use: RoleUse | None) -> str:
    """The text of a layer field that is left to detection."""
    detected = name_choice(FOUND)
    if use is None:
        return detected
    return (
        f"{detected}: {use.found_layer}"
        if use.found_layer
        else translate("choose a layer")
        if use.is_open
        else translate("not found")
    )


def convention_words(declaration: Value, use: RoleUse | None) -> tuple[str, ...]:
    """The choices of a convention; the first one names the detected convention."""
    rule = use.rule if use else None
    return (
        f"{name_choice(FOUND)}: {rule.words}" if rule else name_choice(FOUND),
        *name_choices(declaration.choices[1:]),
    )


def rule_words(rule: Convention, *, kind_shown: bool) -> str:
    """How a convention was detected; `kind_shown` leaves out the convention, which is shown elsewhere."""
    return (
        f"{describe_certainty(rule)}: {rule.reason}"
        if kind_shown
        else f"{rule.words}, {describe_certainty(rule)}: {rule.reason}"
    )


def matte_at(context: RenderContext, id: str) -> Matte | str | None:
    """The cryptomatte that a node picks from, a sentence if there is none, None while the file is being read."""
    item, overview = context.session.graph.nodes.get(id), overview_of(context, id)
    pick = pick_value(item)
    if not isinstance(overview, RenderOverview) or pick is None:
        return overview if isinstance(overview, str) else None
    kind = str(getattr(item, pick.matte))
    matte = matte_of(overview.mattes, kind)
    if matte is not None:
        return matte
    kinds = [matte.kind or translate("unnamed") for matte in overview.mattes]
    return translate(
        "no cryptomatte of kind {kind} in this file; it has {kinds}",
        kind=kind,
        kinds=", ".join(kinds) or translate("none"),
    )


def pick_value(item: object) -> Value | None:
    """The value of a node that lists names of a cryptomatte."""
    values = item.values.values() if isinstance(item, Node) else ()
    return next((value for value in values if value.matte), None)
