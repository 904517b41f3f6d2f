"""The state of every node in this frame: selected, viewed, faulty, slow."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from imgui_bundle import imgui
from msgspec import Struct

from ...authoring.edits.element_id import ElementId
from ...graph import Problem
from .brush import CanvasColors
from .gestures import Gesture, LinkGesture
from .paint_node import NodeLook

if TYPE_CHECKING:
    from .context import CanvasContext

SLOW, COSTLY = 0.35, 0.12
"""Shares of the whole render time from which the cost of a node is red, or yellow."""


class LookFacts(Struct, frozen=True):
    """Facts for the looks of all nodes in one frame, gathered once a frame."""

    context: CanvasContext
    ink: CanvasColors
    viewed: Mapping[ElementId, str]
    badges: Mapping[ElementId, str]
    lit: Mapping[ElementId, frozenset[tuple[bool, str]]] | None
    costs: Mapping[ElementId, tuple[float, int]]
    total: float
    hot: ElementId
    prefix: str
    selection: frozenset[ElementId]
    active: ElementId
    muted: frozenset[str]
    problems: Mapping[ElementId, tuple[Problem, ...]]
    pictures: bool

    def faults(self, key: ElementId) -> tuple[str, ...]:
        """The errors of an element."""
        problems, all_faults = self.problems.get(key), self.context.preview.faults
        if not problems and not all_faults:
            return ()
        errors = tuple(problem.sentence for problem in problems or () if problem.severity == "error")
        fault = all_faults.get(self.prefix + key, "")
        return (*errors, fault) if fault and fault not in errors else errors

    def warnings(self, key: ElementId) -> tuple[str, ...]:
        """The warnings of an element."""
        problems = self.problems.get(key, ())
        return tuple(problem.sentence for problem in problems if problem.severity == "warning") if problems else ()

    def make_look(self, key: ElementId, live: frozenset[str]) -> NodeLook:
        """Make the look of one node or end."""
        faults = self.faults(key)
        warnings = () if faults else self.warnings(key)
        picture, fresh, size = None, True, (1, 1)
        if self.pictures and (thumbnail := self.context.preview.thumbnail(self.prefix + key)):
            picture, fresh = imgui.ImTextureRef(thumbnail[0].native_handle), thumbnail[1]
            size = thumbnail[0].size
        overlay, color = self._describe_cost(key)
        return NodeLook(
            selected=key in self.selection,
            active=key == self.active,
            muted=key in self.muted,
            fault=faults[0] if faults else "",
            warning=warnings[0] if warnings else "",
            badges=self.badges.get(key, ""),
            viewed=self.viewed.get(key, ""),
            hot=key == self.hot,
            lit=None if self.lit is None else self.lit.get(key, frozenset()),
            picture=picture,
            picture_size=size,
            fresh=fresh,
            live=live,
            overlay=overlay,
            overlay_color=color,
        )

    def _describe_cost(self, key: ElementId) -> tuple[str, int]:
        if key not in self.costs:
            return "", 0
        seconds, size = self.costs[key]
        share = seconds / self.total if self.total else 0.0
        color = self.ink.error if share > SLOW else self.ink.warning if share > COSTLY else self.ink.dim
        return f"{seconds * 1e3:.1f} ms   {_format_size(size)}", color


def gather_look_facts(context: CanvasContext, ink: CanvasColors, gesture: Gesture, hot: ElementId) -> LookFacts:
    """Gather the facts for the looks of all nodes in this frame."""
    session = context.session
    viewed: dict[ElementId, str] = {}
    for side in ("A", "B"):
        if port := session.views.find_port(side):
            viewed[ElementId.of_port(port)] = viewed.get(ElementId.of_port(port), "") + side
    badges: dict[ElementId, str] = {}
    for number, port in session.views.numbered_ports.items():
        badges[ElementId.of_port(port)] = f"{badges.get(ElementId.of_port(port), '')} {number}".strip()
    lit: dict[ElementId, frozenset[tuple[bool, str]]] | None = None
    if isinstance(gesture, LinkGesture):
        lit = {}
        for port in gesture.targets:
            lit[ElementId.of_port(port)] = lit.get(ElementId.of_port(port), frozenset()) | {
                (not gesture.output, port.socket)
            }
        lit[ElementId.of_port(gesture.port)] = frozenset({(gesture.output, gesture.port.socket)})
    costs, total = _find_costs(context) if context.preview.timed else ({}, 0.0)
    prefix = "".join(f"{id}/" for id in session.place)
    return LookFacts(
        context,
        ink,
        viewed,
        badges,
        lit,
        costs,
        total,
        hot,
        prefix,
        session.selection,
        session.active,
        session.graph.muted,
        session.problems,
        context.preview.thumbnailing,
    )


def _find_costs(context: CanvasContext) -> tuple[dict[ElementId, tuple[float, int]], float]:
    """Seconds and bytes of every element here, groups with all that is in them, and the seconds of everything."""
    timings = context.preview.timings
    prefix = "".join(f"{id}/" for id in context.session.place)
    costs_by_key: dict[ElementId, dict[frozenset[str], tuple[float, int]]] = {}
    everything: dict[frozenset[str], float] = {}
    for path, timing in timings.items():
        passes = frozenset({path, *timing.shared})
        everything[passes] = timing.seconds
        if path.startswith(prefix):
            key = ElementId(path.removeprefix(prefix).partition("/")[0])
            costs_by_key.setdefault(key, {})[passes] = timing.seconds, timing.bytes
    costs = {
        key: (sum(seconds for seconds, _ in parts.values()), sum(size for _, size in parts.values()))
        for key, parts in costs_by_key.items()
    }
    return costs, sum(everything.values())


def _format_size(size: int) -> str:
    return f"{size / 2**20:.1f} MB" if size >= 2**20 else f"{size / 2**10:.0f} KB"
