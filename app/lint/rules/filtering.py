"""Pictures that are filtered twice although once would be enough."""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot
from typing import TYPE_CHECKING

from halation.nodes import Pointwise, Trait

from ...custom_nodes import CustomNode
from ...graph import Port, Problem
from ...graph.rules import Rule
from ..sheet import Check, GraphFacts, has_trait

if TYPE_CHECKING:
    from halation.nodes.distort.resize import Resize
    from halation.nodes.distort.transform import Transform

FILTERING_TWICE = Rule(
    "filtering-twice",
    "warning",
    "A picture is resampled or blurred twice although once would be enough, which costs sharpness and "
    "time. Transforms directly after one another with the same edge act as one, and are fine.",
    "Put transforms next to each other; make one of two resizes or two blurs.",
)
_PLACES = frozenset({"pixel", "extent"})
"""The words in a shader whose result depends on the place of the pixel."""


def find_double_filtering(sheet: GraphFacts) -> Iterator[Problem]:
    """Nodes that resample a picture directly after another node that resamples it."""
    for id, item in sheet.list_having(Trait.RESAMPLES):
        before, between = _find_earlier_filter(sheet, id)
        if before and (remedy := _remedy(sheet, before, between, id)):
            sentence = f"'{before}' and '{id}' filter the picture twice: {remedy}"
            yield Problem(id, next(iter(item.inputs)), sentence, FILTERING_TWICE, f"nodes.{id}")


def _find_earlier_filter(sheet: GraphFacts, id: str) -> tuple[str, list[str]]:
    """The node that resampled the picture of `id` before, and the nodes in between; "" if there is none."""
    between: list[str] = []
    port = sheet.first(id)
    while port and sheet.readers[port] == 1:
        item = sheet.works(port.node)
        if has_trait(item, Trait.RESAMPLES):
            return port.node, between[::-1]
        if not isinstance(item, Pointwise) or not (name := _picture(sheet, port.node, item)):
            break
        between.append(port.node)
        port = sheet.source(Port(port.node, name))
    return "", []


def _picture(sheet: GraphFacts, id: str, item: Pointwise) -> str:
    """The only linked input of a node that treats all pixels alike, so that it can also come after the filter."""
    fed = [name for name in (*item.inputs, *item.values) if Port(id, name) in sheet.graph.links]
    alike = len(fed) == len(item.outputs) == 1 and fed[0] in item.inputs and not isinstance(item, CustomNode)
    return fed[0] if alike and not sheet.library.uses(item.shader, _PLACES, id) else ""


def _remedy(sheet: GraphFacts, before: str, between: list[str], id: str) -> str:
    """The advice instead of filtering twice; "" if both nodes are needed."""
    from halation.nodes.blur.gaussian_blur import GaussianBlur
    from halation.nodes.distort.resize import Resize
    from halation.nodes.distort.transform import Transform

    first, second = sheet.graph.nodes[before], sheet.graph.nodes[id]
    still = sheet.moving.isdisjoint((before, id))
    match first, second:
        case Transform(), Transform() if between and first.edge == second.edge and not _hard(first, second):
            return f"put {_join_names(between)} behind '{id}', so that the two transforms act as one"
        case Resize(), Resize() if still and _same_way(first, second):
            wide, high = (a * b for a, b in zip(first.scale, second.scale, strict=True))
            return f"one resize by {wide:.4g}, {high:.4g} does both"
        case (Resize() as resize, Transform() as transform) | (Transform() as transform, Resize() as resize):
            if still and max(resize.scale) <= 1.0 and not _hard(resize, transform):
                wide, high = resize.scale
                return f"let the transform scale by {wide:.4g}, {high:.4g} too, and crop behind it"
        case GaussianBlur(), GaussianBlur() if still and not between and first.edge == second.edge:
            if first.scale == second.scale:
                return f"one blur with a sigma of {hypot(first.sigma, second.sigma):.4g} does both"
        case _:
            pass
    return ""


def _hard(*items: Transform | Resize) -> bool:
    """True if the node shall keep hard pixels."""
    return any(item.kernel in ("nearest", "box") for item in items)


def _same_way(first: Resize, second: Resize) -> bool:
    """False if one resize shrinks and the other enlarges: the loss of detail may be intended."""
    pairs = list(zip(first.scale, second.scale, strict=True))
    return all(max(pair) <= 1.0 for pair in pairs) or all(min(pair) >= 1.0 for pair in pairs)


def _join_names(names: list[str]) -> str:
    return " and ".join(f"'{name}'" for name in names)


CHECKS = (Check(FILTERING_TWICE, find_double_filtering),)
