"""The state of the Animation panel: view, rows and selection. Nothing here draws."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct, field

from ...graph import Graph, Keys, Port
from ..toolkit.plane import View
from .rows import CurveRow, Spot, make_rows

Mode = Literal["sheet", "curves"]
Fit = Literal["", "all", "chosen"]


class CurvesState(Struct):
    """The Animation panel. Both modes share the view, the rows and the selected keys."""

    mode: Mode = "sheet"
    view: View = field(default_factory=View)
    pending_fit: Fit = "all"
    """What to fit into the view in the next frame."""
    scroll: float = 0.0
    """Pixels that the rows are scrolled."""
    only_selected: bool = False
    """True leaves out the values of nodes that are not selected."""
    snap: bool = True
    """True keeps moved keys on whole frames."""
    spots: frozenset[Spot] = frozenset()
    """The selected channels of keys."""
    chosen_rows: frozenset[Port] = frozenset()
    """The selected rows: their curves are drawn. Empty means all."""
    anchor: Port | None = None
    """The row from which Shift extends."""
    folded: set[str] = field(default_factory=set[str])
    hidden: set[tuple[Port, int]] = field(default_factory=set[tuple[Port, int]])
    """Channels without a curve."""
    free: set[tuple[Port, float]] = field(default_factory=set[tuple[Port, float]])
    """Keys whose handles do not turn together."""
    hovered: bool = False
    """True while the mouse is over the panel."""
    _rows: tuple[tuple[object, ...], tuple[CurveRow, ...]] = ((), ())
    _curves: tuple[tuple[CurveRow, ...] | None, frozenset[Port] | None, tuple[CurveRow, ...]] = (None, None, ())
    _tidied: tuple[object, ...] = ()

    def list_rows(self, graph: Graph, selection: frozenset[str]) -> tuple[CurveRow, ...]:
        """The rows, rebuilt only when their inputs change."""
        filters = (self.only_selected, frozenset(self.folded), selection)
        inputs = (graph.animation, graph.nodes, filters)
        old_inputs = self._rows[0]
        if (
            len(old_inputs) != 3
            or old_inputs[0] is not inputs[0]
            or old_inputs[1] is not inputs[1]
            or old_inputs[2] != filters
        ):
            self._rows = inputs, make_rows(graph, selection, self.only_selected, self.folded)
        return self._rows[1]

    def list_curve_rows(self, all: tuple[CurveRow, ...]) -> tuple[CurveRow, ...]:
        """The rows whose curves are drawn; values of folded nodes are not."""
        old_rows, old_chosen, curve_rows = self._curves
        if old_rows is not all or old_chosen is not self.chosen_rows:
            curve_rows = tuple(row for row in all if row.port)
            if any(row.port in self.chosen_rows for row in curve_rows):
                curve_rows = tuple(row for row in curve_rows if row.port in self.chosen_rows)
            self._curves = all, self.chosen_rows, curve_rows
        return curve_rows

    def tidy(self, graph: Graph) -> None:
        """Drop keys and rows that no longer exist from the selection."""
        if self._tidied and self._tidied[0] is graph.animation:
            return
        self._tidied = (graph.animation,)
        animation = graph.animation
        self.spots = frozenset(
            spot
            for spot in self.spots
            if isinstance(keys := animation.get(spot[0]), Keys) and keys.key(spot[1]) is not None
        )
        self.chosen_rows = frozenset(port for port in self.chosen_rows if port in animation)
        self.hidden = {lane for lane in self.hidden if lane[0] in animation}

    def fit(self, target: Fit = "all") -> None:
        """Fit the view to all keys, or to the selected ones, in the next frame."""
        self.pending_fit = target

    def choose(self, spots: frozenset[Spot], how: Literal["replace", "add", "toggle", "remove"] = "replace") -> None:
        """Select keys: replace, extend, toggle or reduce the selection."""
        match how:
            case "replace":
                self.spots = spots
            case "add":
                self.spots |= spots
            case "remove":
                self.spots -= spots
            case "toggle":
                self.spots = self.spots - spots if spots <= self.spots else self.spots | spots

    @property
    def single(self) -> tuple[Port, float] | None:
        """The selected key, if there is exactly one."""
        chosen_keys = {(port, frame) for port, frame, _ in self.spots}
        return next(iter(chosen_keys)) if len(chosen_keys) == 1 else None
