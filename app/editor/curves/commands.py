"""What can be done in the Animation panel, whichever mode it is in. Nothing here draws."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from ...authoring.commands import AnimateValues
from ...authoring.edits.values import animatable_values
from ...errors import UsageError
from ...graph import Graph, Interpolation, Keys, Outside, Port, Settings
from ..toolkit.plane import View
from .copying import copied, pasted, read
from .editing import Ease, automatic, chosen, eased, extent, fixed, going_on, interpolated, moved, removed, straightened
from .rows import CurveRow, Spot, limits, spots_of, width
from .shapes import Samples, heights

if TYPE_CHECKING:
    from .context import CurvesContext


def put(context: CurvesContext, changes: Mapping[Port, Keys], label: str, merge: str = "") -> None:
    """Give values other keys, as one step; a value without any stays as it is at this frame."""
    before = context.session.graph.animation
    context.session.apply(
        AnimateValues({port: keys for port, keys in changes.items() if before.get(port) != keys}, label, merge)
    )


def spoken(spots: frozenset[Spot]) -> str:
    """How many keys these are, in words."""
    count = len({(port, frame) for port, frame, _ in spots})
    return "a key" if count == 1 else f"{count} keys"


def some(context: CurvesContext) -> bool:
    """True if keys are chosen."""
    return bool(context.curves.spots)


def choose_all(context: CurvesContext) -> None:
    """Choose every key that has a row."""
    state, session = context.curves, context.session
    found = state.rows(session.graph, session.selection)
    rows = found if state.mode == "sheet" else state.curves(found)
    state.choose(frozenset(spot for row in rows if row.port and row.keys for spot in _seen(context, row)))


def choose_none(context: CurvesContext) -> None:
    """Choose nothing."""
    context.curves.spots = frozenset()


def delete(context: CurvesContext) -> None:
    """Remove chosen keys."""
    _change(context, lambda graph, spots: removed(graph.animation, spots), "Delete")


def interpolate(how: Interpolation) -> Callable[[CurvesContext], None]:
    """Chosen keys go to the next in that way."""
    return lambda context: _change(
        context, lambda graph, spots: interpolated(graph.animation, spots, how), f"Make {how}:"
    )


def ease(how: Ease) -> Callable[[CurvesContext], None]:
    """Chosen keys are come to, or left, gently."""
    words = {"in": "Ease into", "out": "Ease out of", "both": "Ease"}[how]
    return lambda context: _change(context, lambda graph, spots: eased(graph.animation, spots, how), words)


def make_automatic(context: CurvesContext) -> None:
    """Handles go along the smooth curve."""
    context.curves.free -= _keys_of(context)
    _change(context, lambda graph, spots: automatic(graph.animation, spots), "Automatic handles of")


def make_aligned(context: CurvesContext) -> None:
    """Both handles lie on one line, and turn together."""
    context.curves.free -= _keys_of(context)
    _change(context, lambda graph, spots: straightened(graph.animation, spots), "Align handles of")


def make_free(context: CurvesContext) -> None:
    """Each handle turns alone."""
    _change(context, lambda graph, spots: fixed(graph.animation, spots), "Free handles of")
    context.curves.free |= _keys_of(context)


def go_on(how: Outside) -> Callable[[CurvesContext], None]:
    """What the values of the chosen keys, or else of the chosen rows, do outside of their keys."""

    def act(context: CurvesContext) -> None:
        state, graph = context.curves, context.session.graph
        ports = {port for port, _, _ in state.spots} or state.shown
        if not ports:
            raise UsageError("no keys are selected: select some of the values that this is about")
        put(context, going_on(graph.animation, ports, how), f"Outside of keys: {how}")

    return act


def goes_on(context: CurvesContext, how: Outside) -> bool:
    """True if all values of the chosen keys do that outside of their keys."""
    state, animation = context.curves, context.session.graph.animation
    found = [animation.get(port) for port in ({port for port, _, _ in state.spots} or state.shown)]
    return bool(found) and all(isinstance(keys, Keys) and keys.outside == how for keys in found)


def copy(context: CurvesContext) -> None:
    """Chosen keys go to the clipboard."""
    context.clipboard.put(copied(context.session.graph.animation, context.curves.spots))


def cut(context: CurvesContext) -> None:
    """Chosen keys go to the clipboard, and away."""
    copy(context)
    _change(context, lambda graph, spots: removed(graph.animation, spots), "Cut")


def paste(context: CurvesContext) -> None:
    """Keys of the clipboard come in from the current frame on, and are chosen."""
    session, state = context.session, context.curves
    change = pasted(session.graph, read(context.clipboard.get()), session.frame, state.shown)
    put(context, change.made, f"Paste {spoken(change.spots)}")
    state.spots = change.spots


def duplicate(context: CurvesContext) -> None:
    """Chosen keys once more, behind themselves; the copies are chosen."""
    state, graph = context.curves, context.session.graph
    span = extent(state.spots)
    if span is None:
        raise UsageError("no keys are selected: select what to duplicate")
    change = moved(graph.animation, state.spots, float(int(span[1] - span[0]) + 1))
    made = {
        port: Keys((*before.keys, *(key for key in keys.keys if _holds(change.spots, port, key.frame))), before.outside)
        for port, keys in change.made.items()
        if isinstance(before := graph.animation[port], Keys)
    }
    put(context, made, f"Duplicate {spoken(state.spots)}")
    state.spots = change.spots


def nudge(by: float) -> Callable[[CurvesContext], None]:
    """Chosen keys so many frames later."""

    def act(context: CurvesContext) -> None:
        state = context.curves
        change = moved(context.session.graph.animation, state.spots, by)
        put(context, change.made, f"Move {spoken(state.spots)}", "nudge keys")
        state.spots = change.spots

    return act


def insert(context: CurvesContext, port: Port, frame: float) -> None:
    """A key on the curve, which is chosen."""
    keys = context.session.graph.animation.get(port)
    if isinstance(keys, Keys):
        frame = round(frame, 6)
        made = keys.insert(frame)
        put(context, {port: made}, f"Key {port}")
        context.curves.choose(spots_of(port, made, (frame,)))


def key_here(context: CurvesContext) -> None:
    """A key at the current frame for every chosen row, or for all."""
    state, session = context.curves, context.session
    found = state.curves(state.rows(session.graph, session.selection))
    made = {row.port: row.keys.insert(float(session.frame)) for row in found if row.port and row.keys}
    put(context, made, f"Key at frame {session.frame}")
    state.choose(frozenset().union(*(spots_of(port, keys, (float(session.frame),)) for port, keys in made.items())))


def swap_mode(context: CurvesContext) -> None:
    """From the dope sheet to curves, and back."""
    context.curves.mode = "curves" if context.curves.mode == "sheet" else "sheet"


def fitted(context: CurvesContext, samples: Samples) -> View:
    """The view that shows what is wanted: all rows and the range, or the chosen keys."""
    state, session = context.curves, context.session
    graph = session.graph
    spots = state.spots if state.wanted == "chosen" else frozenset[Spot]()
    rows = [row for row in state.curves(state.rows(graph, session.selection)) if row.port]
    if spots:
        tops = [
            found
            for port, frames in chosen(graph.animation, spots).items()
            for channel in {part for parts in frames.values() for part in parts}
            if isinstance(keys := graph.animation[port], Keys)
            and (found := heights(keys, channel, lambda key, frames=frames: key.frame in frames))
        ]
        return state.view.fit(extent(spots), _around(tops))
    first, last = session.frames
    every = [frame for row in rows if row.keys for frame in row.keys.frames]
    ends = min([first, *every]), max([last, *every])
    tops = [found for row in rows for found in _heights(graph, session.settings, row, state.hidden, samples, ends)]
    return state.view.fit(ends, _around(tops) or (0.0, 1.0))


def bounds(context: CurvesContext) -> Callable[[Port], tuple[float, float]]:
    """What the values of the graph cannot leave."""
    return lambda port: limits(context.session.graph, port)


def animatable(context: CurvesContext) -> tuple[Port, ...]:
    """Values of the selected nodes that could be keyed and are not yet."""
    session = context.session
    return tuple(
        port
        for id in session.graph.nodes
        if id in session.selection
        for port in animatable_values(session.graph, id)
        if port not in session.graph.animation and session.linked(port) is None
    )


def _change(context: CurvesContext, make: Callable[[Graph, frozenset[Spot]], Mapping[Port, Keys]], words: str) -> None:
    state, graph = context.curves, context.session.graph
    if not state.spots:
        raise UsageError("no keys are selected: click some, or drag a box around them")
    put(context, make(graph, state.spots), f"{words} {spoken(state.spots)}")


def _keys_of(context: CurvesContext) -> set[tuple[Port, float]]:
    return {(port, frame) for port, frame, _ in context.curves.spots}


def _seen(context: CurvesContext, row: CurveRow) -> frozenset[Spot]:
    assert row.port and row.keys
    spots, state = spots_of(row.port, row.keys), context.curves
    return (
        spots if state.mode == "sheet" else frozenset(spot for spot in spots if (spot[0], spot[2]) not in state.hidden)
    )


def _holds(spots: frozenset[Spot], port: Port, frame: float) -> bool:
    return (port, frame, 0) in spots or any(spot[:2] == (port, frame) for spot in spots)


def _around(found: list[tuple[float, float]]) -> tuple[float, float] | None:
    return (min(low for low, _ in found), max(high for _, high in found)) if found else None


def _heights(
    graph: Graph,
    settings: Settings,
    row: CurveRow,
    hidden: set[tuple[Port, int]],
    samples: Samples,
    ends: tuple[float, float],
) -> list[tuple[float, float]]:
    port = row.port
    if port is None:
        return []
    found: list[tuple[float, float]] = []
    for channel in range(width(graph, port)):
        if (port, channel) in hidden:
            continue
        if row.keys:
            inside = heights(row.keys, channel)
            found += [inside] if inside else []
        else:
            lines = samples.line(graph, settings, port, channel, *ends)
            found += [(float(line[:, 1].min()), float(line[:, 1].max())) for line in lines]
    return found
