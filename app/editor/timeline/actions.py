"""Actions of the timeline: play, step, jump."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from ...authoring.commands import SetFrameRange
from ...language.translation import mark
from ..shared.action import Action
from .playback import LOOPS, Loop

if TYPE_CHECKING:
    from .context import TimelineContext


def play(context: TimelineContext) -> None:
    """Play, or stop."""
    context.timeline.play(context.session, imgui.get_time(), context.preview.remembers)


def _step(by: int) -> Callable[[TimelineContext], object]:
    """Go one frame forwards or back; at the end of a played loop, go to its other end."""

    def step(context: TimelineContext) -> None:
        context.timeline.stop()
        session = context.session
        first, last = context.timeline.span(session)
        target = session.time.frame + by
        if session.time.frame in (first, last) and not first <= target <= last and context.timeline.loop == "loop":
            target = first if by > 0 else last
        session.time.seek(target)

    return step


def _end(place: int) -> Callable[[TimelineContext], object]:
    def jump(context: TimelineContext) -> None:
        if context.timeline.playback.playing and place:
            context.timeline.stop()
        context.session.time.seek(context.timeline.span(context.session)[place])

    return jump


def _to_key(later: bool) -> Callable[[TimelineContext], object]:
    def jump(context: TimelineContext) -> None:
        session = context.session
        frame = session.time.find_next_key() if later else session.time.find_previous_key()
        context.timeline.stop()
        if frame is not None:
            session.time.seek(frame)

    return jump


def _set_loop(loop: Loop) -> Callable[[TimelineContext], object]:
    def choose(context: TimelineContext) -> None:
        context.timeline.loop = loop

    return choose


def _every(context: TimelineContext) -> None:
    context.timeline.every = not context.timeline.every


def _in(context: TimelineContext) -> None:
    session, timeline = context.session, context.timeline
    timeline.set_part(session, session.time.frame, max(timeline.span(session)[1], session.time.frame))


def _out(context: TimelineContext) -> None:
    session, timeline = context.session, context.timeline
    timeline.set_part(session, min(timeline.span(session)[0], session.time.frame), session.time.frame)


def _whole(context: TimelineContext) -> None:
    context.timeline.part = context.timeline.view = None


def _range_from_part(context: TimelineContext) -> None:
    first, last = context.timeline.span(context.session)
    context.session.apply(SetFrameRange(first, last))


def _has_part(context: TimelineContext) -> bool:
    return context.timeline.part is not None


def _loop(loop: Loop, label: str, doc: str) -> Action[TimelineContext]:
    return Action(
        f"time.{loop.replace('-', '_')}",
        label,
        _set_loop(loop),
        "Time",
        doc=doc,
        checked=lambda context: context.timeline.loop == loop,
        contexts=frozenset({"timeline"}),
    )


_KEYED = frozenset({"timeline"})
_LABELS = {
    "loop": (mark("Loop"), mark("After the last frame, start again at the first one.")),
    "once": (mark("Once"), mark("Stop at the last frame.")),
    "ping-pong": (mark("Ping-Pong"), mark("Play forwards and backwards in turn.")),
}

PLAYBACK: tuple[Action[TimelineContext], ...] = (
    Action(
        "time.play",
        "Play or Stop",
        play,
        "Time",
        "Space",
        checked=lambda context: context.timeline.playback.playing,
        doc="Play at the graph's frame rate. Frames that are not ready in time are dropped and counted.",
    ),
    Action("time.next", "Next Frame", _step(1), "Time", "RightArrow", repeats=True, separated=True),
    Action("time.previous", "Previous Frame", _step(-1), "Time", "LeftArrow", repeats=True),
    Action("time.first", "First Frame", _end(0), "Time", "Shift+LeftArrow"),
    Action("time.last", "Last Frame", _end(1), "Time", "Shift+RightArrow"),
    Action(
        "time.next_key",
        "Next Key",
        _to_key(True),
        "Time",
        "UpArrow",
        repeats=True,
        doc="Go to a key of the selected nodes, or of all nodes.",
    ),
    Action(
        "time.previous_key",
        "Previous Key",
        _to_key(False),
        "Time",
        "DownArrow",
        repeats=True,
        doc="Go to a key of the selected nodes, or of all nodes.",
    ),
    Action(
        "time.in",
        "Set In Point",
        _in,
        "Time",
        "Alt+I",
        contexts=_KEYED,
        separated=True,
        doc="Start playback at this frame. The frame range of the graph does not change.",
    ),
    Action(
        "time.out",
        "Set Out Point",
        _out,
        "Time",
        "Alt+O",
        contexts=_KEYED,
        doc="End playback at this frame. The frame range of the graph does not change.",
    ),
    Action(
        "time.whole",
        "Clear In and Out Points",
        _whole,
        "Time",
        "Alt+P",
        contexts=_KEYED,
        enabled=lambda context: context.timeline.part is not None or context.timeline.view is not None,
    ),
    Action(
        "time.range",
        "Set Frame Range to In and Out Points",
        _range_from_part,
        "Time",
        enabled=_has_part,
        contexts=_KEYED,
    ),
    *(_loop(loop, *_LABELS[loop]) for loop in LOOPS),
    Action(
        "time.every",
        "Play Every Frame",
        _every,
        "Time",
        checked=lambda context: context.timeline.every,
        contexts=_KEYED,
        separated=True,
        doc="Drop no frames, even if playback is slower.",
    ),
)
