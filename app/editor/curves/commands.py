"""Commands of the Animation panel, in both modes. Nothing here draws."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from ...authoring.commands import AnimateValues
from ...authoring.edits.values import animatable_values
from ...errors import UsageError
from ...graph import Extrapolation, Graph, Interpolation, Keys, Port, Settings
from ...language.translation import mark, translate, translate_plural
from ..toolkit.plane import View
from .copying import decode_keys, encode_keys, paste_keys
from .editing import (
    Ease,
    align_handles,
    ease_keys,
    extrapolate_keys,
    find_frame_range,
    fix_handles,
    group_spots,
    interpolate_keys,
    move_keys,
    remove_keys,
    reset_handles,
)
from .rows import CurveRow, Spot, count_channels, find_limits, list_spots
from .shapes import ExpressionSamples, find_value_range

if TYPE_CHECKING:
    from .context import CurvesContext


def set_keys(context: CurvesContext, changes: Mapping[Port, Keys], label: str, merge: str = "") -> None:
    """Set the keys of values as one undo step; a value whose last key goes keeps its value at this frame."""
    before = context.session.graph.animation
    context.session.apply(
        AnimateValues({port: keys for port, keys in changes.items() if before.get(port) != keys}, label, merge)
    )


def describe_keys(spots: frozenset[Spot]) -> str:
    """The number of keys, in words."""
    count = len({(port, frame) for port, frame, _ in spots})
    return translate_plural("a key", "{count} keys", count)


def has_chosen_keys(context: CurvesContext) -> bool:
    """True if keys are selected."""
    return bool(context.curves.spots)


def choose_all(context: CurvesContext) -> None:
    """Select every key that has a row."""
    state, session = context.curves, context.session
    all_rows = state.list_rows(session.graph, session.selection)
    rows = all_rows if state.mode == "sheet" else state.list_curve_rows(all_rows)
    state.choose(frozenset(spot for row in rows if row.port and row.keys for spot in _list_visible_spots(context, row)))


def choose_here(context: CurvesContext) -> None:
    """Select the keys at the current frame, of every value that has a row."""
    choose_all(context)
    frame = context.session.time.frame
    context.curves.choose(frozenset(spot for spot in context.curves.spots if spot[1] == frame))


def choose_none(context: CurvesContext) -> None:
    """Deselect all keys."""
    context.curves.spots = frozenset()


def delete(context: CurvesContext) -> None:
    """Delete the selected keys."""
    _change(context, lambda graph, spots: remove_keys(graph.animation, spots), mark("Delete {keys}"))


def interpolate(how: Interpolation) -> Callable[[CurvesContext], None]:
    """A command that sets the interpolation of the selected keys."""
    label = {
        "constant": mark("Make constant: {keys}"),
        "linear": mark("Make linear: {keys}"),
        "smooth": mark("Make smooth: {keys}"),
        "bezier": mark("Make bezier: {keys}"),
    }[how]
    return lambda context: _change(context, lambda graph, spots: interpolate_keys(graph.animation, spots, how), label)


def ease(how: Ease) -> Callable[[CurvesContext], None]:
    """A command that eases the selected keys in, out or both."""
    label = {"in": mark("Ease into {keys}"), "out": mark("Ease out of {keys}"), "both": mark("Ease {keys}")}[how]
    return lambda context: _change(context, lambda graph, spots: ease_keys(graph.animation, spots, how), label)


def make_automatic(context: CurvesContext) -> None:
    """Reset the handles of the selected keys to the smooth curve."""
    context.curves.free -= _list_chosen_keys(context)
    _change(context, lambda graph, spots: reset_handles(graph.animation, spots), mark("Automatic handles of {keys}"))


def make_aligned(context: CurvesContext) -> None:
    """Align both handles of the selected keys, so that they turn together."""
    context.curves.free -= _list_chosen_keys(context)
    _change(context, lambda graph, spots: align_handles(graph.animation, spots), mark("Align handles of {keys}"))


def make_free(context: CurvesContext) -> None:
    """Let each handle of the selected keys turn alone."""
    _change(context, lambda graph, spots: fix_handles(graph.animation, spots), mark("Free handles of {keys}"))
    context.curves.free |= _list_chosen_keys(context)


def extrapolate(how: Extrapolation) -> Callable[[CurvesContext], None]:
    """A command that sets the extrapolation of the selected keys' values, or else of the selected rows."""

    def act(context: CurvesContext) -> None:
        state, graph = context.curves, context.session.graph
        ports = {port for port, _, _ in state.spots} or state.chosen_rows
        if not ports:
            raise UsageError(translate("no keys are selected: select a key or a row first"))
        set_keys(context, extrapolate_keys(graph.animation, ports, how), translate("Outside of keys: {how}", how=how))

    return act


def extrapolates(context: CurvesContext, how: Extrapolation) -> bool:
    """True if all values of the selected keys have this extrapolation."""
    state, animation = context.curves, context.session.graph.animation
    animations = [animation.get(port) for port in ({port for port, _, _ in state.spots} or state.chosen_rows)]
    return bool(animations) and all(isinstance(keys, Keys) and keys.outside == how for keys in animations)


def copy(context: CurvesContext) -> None:
    """Copy the selected keys to the clipboard."""
    context.clipboard.put(encode_keys(context.session.graph.animation, context.curves.spots))


def cut(context: CurvesContext) -> None:
    """Copy the selected keys to the clipboard and delete them."""
    copy(context)
    _change(context, lambda graph, spots: remove_keys(graph.animation, spots), mark("Cut {keys}"))


def paste(context: CurvesContext) -> None:
    """Paste keys from the clipboard at the current frame, and select them."""
    session, state = context.session, context.curves
    change = paste_keys(session.graph, decode_keys(context.clipboard.get()), session.time.frame, state.chosen_rows)
    set_keys(context, change.new_keys, translate("Paste {keys}", keys=describe_keys(change.spots)))
    state.spots = change.spots


def duplicate(context: CurvesContext) -> None:
    """Copy the selected keys to the frames after them, and select the copies."""
    state, graph = context.curves, context.session.graph
    span = find_frame_range(state.spots)
    if span is None:
        raise UsageError(translate("no keys are selected: select what to duplicate"))
    change = move_keys(graph.animation, state.spots, float(int(span[1] - span[0]) + 1))
    new_keys = {
        port: Keys(
            (*before.keys, *(key for key in keys.keys if _contains_key(change.spots, port, key.frame))), before.outside
        )
        for port, keys in change.new_keys.items()
        if isinstance(before := graph.animation[port], Keys)
    }
    set_keys(context, new_keys, translate("Duplicate {keys}", keys=describe_keys(state.spots)))
    state.spots = change.spots


def nudge(by: float) -> Callable[[CurvesContext], None]:
    """A command that moves the selected keys by some frames."""

    def act(context: CurvesContext) -> None:
        state = context.curves
        change = move_keys(context.session.graph.animation, state.spots, by)
        set_keys(context, change.new_keys, translate("Move {keys}", keys=describe_keys(state.spots)), "nudge keys")
        state.spots = change.spots

    return act


def insert(context: CurvesContext, port: Port, frame: float) -> None:
    """Insert a key on the curve, and select it."""
    keys = context.session.graph.animation.get(port)
    if isinstance(keys, Keys):
        frame = round(frame, 6)
        new_keys = keys.insert(frame)
        set_keys(context, {port: new_keys}, translate("Key {port}", port=port))
        context.curves.choose(list_spots(port, new_keys, (frame,)))


def key_here(context: CurvesContext) -> None:
    """Insert a key at the current frame in every selected row, or in all rows."""
    state, session = context.curves, context.session
    rows = state.list_curve_rows(state.list_rows(session.graph, session.selection))
    new_keys = {row.port: row.keys.insert(float(session.time.frame)) for row in rows if row.port and row.keys}
    set_keys(context, new_keys, translate("Key at frame {frame}", frame=session.time.frame))
    state.choose(
        frozenset().union(*(list_spots(port, keys, (float(session.time.frame),)) for port, keys in new_keys.items()))
    )


def swap_mode(context: CurvesContext) -> None:
    """Switch between the dope sheet and the curves."""
    context.curves.mode = "curves" if context.curves.mode == "sheet" else "sheet"


def fit_view(context: CurvesContext, samples: ExpressionSamples) -> View:
    """The view that shows all rows and the frame range, or the selected keys."""
    state, session = context.curves, context.session
    graph = session.graph
    spots = state.spots if state.pending_fit == "chosen" else frozenset[Spot]()
    rows = [row for row in state.list_curve_rows(state.list_rows(graph, session.selection)) if row.port]
    if spots:
        value_ranges = [
            value_range
            for port, frames in group_spots(graph.animation, spots).items()
            for channel in {part for parts in frames.values() for part in parts}
            if isinstance(keys := graph.animation[port], Keys)
            and (value_range := find_value_range(keys, channel, lambda key, frames=frames: key.frame in frames))
        ]
        return state.view.fit(find_frame_range(spots), _join_ranges(value_ranges))
    first, last = session.time.frames
    key_frames = [frame for row in rows if row.keys for frame in row.keys.frames]
    frame_range = min([first, *key_frames]), max([last, *key_frames])
    value_ranges = [
        value_range
        for row in rows
        for value_range in _find_value_ranges(graph, session.root.settings, row, state.hidden, samples, frame_range)
    ]
    return state.view.fit(frame_range, _join_ranges(value_ranges) or (0.0, 1.0))


def bounds(context: CurvesContext) -> Callable[[Port], tuple[float, float]]:
    """A function that gives the smallest and the largest number that a value may have."""
    return lambda port: find_limits(context.session.graph, port)


def list_animatable(context: CurvesContext) -> tuple[Port, ...]:
    """Values of the selected nodes that can be animated and are not yet."""
    session = context.session
    return tuple(
        port
        for id in session.graph.nodes
        if id in session.selection
        for port in animatable_values(session.graph, id)
        if port not in session.graph.animation and session.graph.links.get(port) is None
    )


def _change(context: CurvesContext, make: Callable[[Graph, frozenset[Spot]], Mapping[Port, Keys]], label: str) -> None:
    state, graph = context.curves, context.session.graph
    if not state.spots:
        raise UsageError(translate("no keys are selected: click some, or drag a box around them"))
    set_keys(context, make(graph, state.spots), translate(label, keys=describe_keys(state.spots)))


def _list_chosen_keys(context: CurvesContext) -> set[tuple[Port, float]]:
    return {(port, frame) for port, frame, _ in context.curves.spots}


def _list_visible_spots(context: CurvesContext, row: CurveRow) -> frozenset[Spot]:
    assert row.port and row.keys
    spots, state = list_spots(row.port, row.keys), context.curves
    return (
        spots if state.mode == "sheet" else frozenset(spot for spot in spots if (spot[0], spot[2]) not in state.hidden)
    )


def _contains_key(spots: frozenset[Spot], port: Port, frame: float) -> bool:
    return (port, frame, 0) in spots or any(spot[:2] == (port, frame) for spot in spots)


def _join_ranges(ranges: list[tuple[float, float]]) -> tuple[float, float] | None:
    return (min(low for low, _ in ranges), max(high for _, high in ranges)) if ranges else None


def _find_value_ranges(
    graph: Graph,
    settings: Settings,
    row: CurveRow,
    hidden: set[tuple[Port, int]],
    samples: ExpressionSamples,
    ends: tuple[float, float],
) -> list[tuple[float, float]]:
    port = row.port
    if port is None:
        return []
    ranges: list[tuple[float, float]] = []
    for channel in range(count_channels(graph, port)):
        if (port, channel) in hidden:
            continue
        if row.keys:
            value_range = find_value_range(row.keys, channel)
            ranges += [value_range] if value_range else []
        else:
            lines = samples.sample_lines(graph, settings, port, channel, *ends)
            ranges += [(float(line[:, 1].min()), float(line[:, 1].max())) for line in lines]
    return ranges
