"""From the mouse to gestures, and from finished gestures to what they do to the document."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from ...authoring.commands import (
    AddDot,
    Connect,
    CutLinks,
    Disconnect,
    ExtractSelection,
    MoveElements,
    MoveLink,
    ReplaceGraph,
    ResizeComment,
    ResizeFrame,
    SpliceChain,
)
from ...graph import Group, Port
from .frame import CanvasFrame, pan_at_border, turn_wheel
from .geometry import Point, holds
from .gestures import (
    IDLE,
    Band,
    BandGesture,
    Dragged,
    Gesture,
    Idle,
    Link,
    MoveGesture,
    PanGesture,
    ResizeGesture,
    band_rect,
    dotted,
    fitting,
    insertable,
    moved,
    nearest,
    refused,
    resized,
    shown,
    touched,
    with_members,
)
from .scene import EMPTY, CanvasScene, Hit

if TYPE_CHECKING:
    from .context import CanvasContext

LEFT, RIGHT, MIDDLE = imgui.MouseButton_.left, imgui.MouseButton_.right, imgui.MouseButton_.middle

_SNAP = 30.0


@dataclass
class Asked:
    """What a gesture wants from others: a menu, the search, a text field."""

    menu: Hit | None = None
    search: tuple[Port, bool] | None = None
    rename: str = ""
    toggle: str = ""


@dataclass
class CanvasMouse:
    """Which gesture is going on, and what is under the pointer."""

    gesture: Gesture = IDLE
    hit: Hit = EMPTY
    asked: Asked = field(default_factory=Asked)
    dragged: Dragged = field(default_factory=lambda: Dragged(CanvasScene({})))
    _pressed: tuple[Hit, Point] | None = None
    """Where the right button went down."""
    _moves: int = 0
    _hit: tuple[CanvasScene, Point, float, Hit] = field(
        default_factory=lambda: (CanvasScene({}), (0.0, 0.0), 0.0, EMPTY)
    )
    """What was under the pointer last, and where and in what that was."""

    def update(self, frame: CanvasFrame) -> None:
        """Go on with the gesture, or begin one."""
        self.asked = Asked()
        io = imgui.get_io()
        self.hit = self._found(frame) if frame.over and isinstance(self.gesture, Idle) else EMPTY
        if frame.over or not isinstance(self.gesture, Idle):
            turn_wheel(frame, io, on_field=self.hit.part == "field")
        if isinstance(self.gesture, Idle):
            if frame.over:
                self._begin(frame, io)
        else:
            if not isinstance(self.gesture, PanGesture):
                pan_at_border(frame, io)
            self._go_on(frame, io)
        self._show(frame)

    def _found(self, frame: CanvasFrame) -> Hit:
        """What is under the pointer; looked for again only when something has moved."""
        of = frame.scene, frame.at, frame.reach
        if self._hit[0] is not frame.scene or self._hit[1:3] != of[1:]:
            self._hit = *of, frame.scene.hit(*frame.at, frame.reach)
        return self._hit[3]

    # --- beginning ---------------------------------------------------------------------------------------------------

    def _begin(self, frame: CanvasFrame, io: imgui.IO) -> None:
        context, view, hit = frame.context, frame.context.canvas, self.hit
        if imgui.is_mouse_clicked(MIDDLE) or (imgui.is_mouse_clicked(LEFT) and imgui.is_key_down(imgui.Key.space)):
            self.gesture = PanGesture(view.center, frame.screen)
        elif imgui.is_mouse_clicked(RIGHT):
            if io.key_ctrl or io.key_shift:
                self.gesture = BandGesture(frame.at, dots=io.key_shift)
            else:
                self._pressed = hit, frame.at
        elif imgui.is_mouse_double_clicked(LEFT):
            self._double(frame, hit)
        elif imgui.is_mouse_clicked(LEFT):
            if view.tool:
                self.gesture = BandGesture(frame.at, dots=view.tool == "dot")
                view.tool = ""
            else:
                self._press(frame, io, hit)
        if self._pressed and imgui.is_mouse_released(RIGHT):
            (hit, start), self._pressed = self._pressed, None
            if not frame.is_far(start):
                self._menu(context, hit)

    def _press(self, frame: CanvasFrame, io: imgui.IO, hit: Hit) -> None:
        context, session = frame.context, frame.context.session
        match hit.part:
            case "pin" if hit.port:
                self._take(frame, hit.port, hit.output, io.key_ctrl)
            case "field":
                self._select(context, hit.key, "replace")
            case "more":
                self.asked.toggle = hit.key
            case "edge":
                self._select(context, hit.key, "replace")
                rect = frame.scene.boxes[hit.key].rect
                self.gesture = ResizeGesture(hit.key, hit.name, frame.at, rect, rect)
            case "title" | "body":
                if io.key_ctrl and io.key_shift and frame.scene.boxes[hit.key].sort in ("node", "end"):
                    context.log.attempt(lambda: session.view_node(hit.key))
                elif io.key_ctrl or io.key_shift:
                    self._select(context, hit.key, "toggle")
                else:
                    alone = hit.key in session.selection
                    if not alone:
                        self._select(context, hit.key, "replace")
                    self.gesture = MoveGesture(hit.key, frame.at, alone=alone)
            case _:
                mode = "add" if io.key_shift else "remove" if io.key_ctrl else "replace"
                self.gesture = Band(frame.at, mode)

    def _take(self, frame: CanvasFrame, port: Port, output: bool, keep: bool) -> None:
        """Begin a link from a pin; the link into an input comes along, unless it shall stay."""
        graph = frame.context.session.graph
        detached = None if output or keep else port if port in graph.links else None
        start, is_output = (graph.links[port], True) if detached else (port, output)
        scene = frame.scene
        if detached:
            graph = graph.disconnect(detached)
        targets = frame.context.log.attempt(lambda: fitting(graph, scene, start, is_output), frozenset[Port]())
        self.gesture = Link(start, is_output, detached, targets or frozenset())

    def _double(self, frame: CanvasFrame, hit: Hit) -> None:
        context, session = frame.context, frame.context.session
        if hit.part == "link" and hit.port:
            target = hit.port
            context.log.attempt(lambda: session.apply(AddDot(target, frame.at)))
        elif hit.key.startswith(("frames.", "comments.")):
            self.asked.rename = hit.key
        elif hit.part in ("title", "body") and not hit.key.startswith("dots."):
            item = session.graph.nodes.get(hit.key)
            if session.code(hit.key) is not None:
                context.code_files.show()
                return
            context.log.attempt(
                lambda: session.enter(hit.key) if isinstance(item, Group) else session.view_node(hit.key)
            )
        elif hit.part == "empty":
            context.canvas.searching = True

    def _menu(self, context: CanvasContext, hit: Hit) -> None:
        """A context menu acts on what is selected, so what was clicked is."""
        if hit.key and hit.part != "pin" and hit.key not in context.session.selection:
            self._select(context, hit.key, "replace")
        self.asked.menu = hit

    def _select(self, context: CanvasContext, key: str, mode: str) -> None:
        context.log.attempt(lambda: context.session.select((key,), mode))  # pyright: ignore[reportArgumentType]

    # --- going on ----------------------------------------------------------------------------------------------------

    def _go_on(self, frame: CanvasFrame, io: imgui.IO) -> None:
        gesture, view = self.gesture, frame.context.canvas
        cancelled = imgui.is_key_pressed(imgui.Key.escape) or (
            not isinstance(gesture, BandGesture | PanGesture) and imgui.is_mouse_clicked(RIGHT)
        )
        if cancelled:
            if isinstance(gesture, MoveGesture):
                frame.context.session.abandon(gesture.merge)
            self.gesture = IDLE
            return
        match gesture:
            case PanGesture():
                scale = frame.to.scale
                dx, dy = frame.screen[0] - gesture.mouse[0], frame.screen[1] - gesture.mouse[1]
                view.center = gesture.center[0] - dx / scale, gesture.center[1] - dy / scale
                self._until(not (imgui.is_mouse_down(MIDDLE) or imgui.is_mouse_down(LEFT)), lambda: None)
            case Band():
                self._until(not imgui.is_mouse_down(LEFT), lambda: self._banded(frame, gesture))
            case MoveGesture():
                self.gesture = self._moving(frame, gesture, snap=io.key_ctrl, extract=io.key_alt)
                self._until(not imgui.is_mouse_down(LEFT), lambda: self._moved(frame))
            case ResizeGesture():
                self.gesture = changed = resized(gesture, frame.at, snap=io.key_ctrl)
                self._until(not imgui.is_mouse_down(LEFT), lambda: _resize(frame.context, changed))
            case BandGesture():
                released = not (imgui.is_mouse_down(LEFT) or imgui.is_mouse_down(RIGHT))
                self._until(released, lambda: _drawn(frame, gesture))
            case Link():
                self._until(not imgui.is_mouse_down(LEFT), lambda: self._linked(frame, gesture))
            case Idle():
                pass

    def _until(self, over: bool, act: Callable[[], object]) -> None:
        if over:
            act()
            self.gesture = IDLE

    def _moving(self, frame: CanvasFrame, move: MoveGesture, snap: bool, extract: bool) -> MoveGesture:
        session = frame.context.session
        if not move.going:
            if not frame.is_far(move.start):
                return move
            members = [
                session.frame_members(key.removeprefix("frames."), frame.scene.sizes)
                for key in session.selection
                if key.startswith("frames.")
            ]
            move = replace(move, keys=with_members(session.selection, frame.scene, members))
            if extract and any(wire.leaves(move.keys) for wire in frame.scene.wires):
                self._moves += 1
                merge, steps = f"move {self._moves}", session.history.position
                frame.context.log.attempt(lambda: session.apply(ExtractSelection(merge)))
                if session.history.position > steps:
                    move = replace(move, merge=merge)
        return moved(move, frame.scene, frame.at, snap)

    def _moved(self, frame: CanvasFrame) -> None:
        move, session = self.gesture, frame.context.session
        if not isinstance(move, MoveGesture):
            return
        if not move.going:
            if move.alone:
                self._select(frame.context, move.key, "replace")
            return
        target = insertable(session.graph, shown(frame.scene, move), move.keys, frame.at, frame.reach)
        if target:
            ids, sizes = sorted(move.keys & session.graph.nodes.keys()), frame.scene.sizes
            frame.context.log.attempt(lambda: session.apply(SpliceChain(ids, target, move.by, sizes, move.merge)))
        elif move.by != (0.0, 0.0):
            keys = sorted(move.keys & frame.scene.boxes.keys())
            frame.context.log.attempt(lambda: session.apply(MoveElements(keys, *move.by, merge=move.merge)))
        session.seal()

    def _banded(self, frame: CanvasFrame, band: Band) -> None:
        context = frame.context
        if not frame.is_far(band.start):
            hit = frame.scene.hit(*band.start, frame.reach)
            wire = frame.scene.by_target.get(hit.port) if hit.part == "link" and hit.port else None
            keys = {wire.stops[0], wire.stops[-1]} if wire else ()
            if keys or band.mode == "replace":
                context.log.attempt(lambda: context.session.select(keys, band.mode))  # pyright: ignore[reportArgumentType]
            return
        keys = touched(frame.scene, band_rect(band, frame.at))
        context.log.attempt(lambda: context.session.select(keys, band.mode))  # pyright: ignore[reportArgumentType]

    def _linked(self, frame: CanvasFrame, link: Link) -> None:
        context, session = frame.context, frame.context.session
        snap = nearest(frame.scene, link, frame.at, _SNAP * frame.scale / frame.to.scale)
        if snap:
            other = snap[0]
            source, target = (link.port, other) if link.output else (other, link.port)
            detached = link.detached
            if detached == target:
                return
            if detached:
                context.log.attempt(lambda: session.apply(MoveLink(detached, target)))
            else:
                context.log.attempt(lambda: session.apply(Connect(source, target)))
        elif not frame.is_far(self._start(frame, link)):
            if link.output and link.detached is None:
                context.log.attempt(lambda: session.view(link.port))
        elif refused(frame.scene, link, frame.at, frame.reach) is None and not frame.scene.node_at(*frame.at):
            if link.detached:
                target = link.detached
                context.log.attempt(lambda: session.apply(Disconnect(target)))
            elif holds(frame.panel, *frame.screen):
                self.asked.search = link.port, link.output

    def _start(self, frame: CanvasFrame, link: Link) -> Point:
        end = link.detached or link.port
        for port, box, pin in frame.scene.pins(link.output and link.detached is None):
            if port == end:
                return box.x + pin.x, box.y + pin.y
        return frame.at

    # --- what is seen of it ------------------------------------------------------------------------------------------

    def _show(self, frame: CanvasFrame) -> None:
        gesture, graph = self.gesture, frame.context.session.graph
        self.dragged = Dragged(shown(frame.scene, gesture))
        frame.context.canvas.refusal = ""
        match gesture:
            case MoveGesture() if gesture.going:
                self.dragged.insert = insertable(graph, self.dragged.scene, gesture.keys, frame.at, frame.reach)
            case BandGesture():
                self.dragged.crossed = frame.scene.net.crossed(gesture.start, frame.at)
            case Link():
                self.dragged.snap = nearest(frame.scene, gesture, frame.at, _SNAP * frame.scale / frame.to.scale)
                if other := refused(frame.scene, gesture, frame.at, frame.reach):
                    source, target = (gesture.port, other) if gesture.output else (other, gesture.port)
                    if other != gesture.port and source.node != target.node:
                        frame.context.canvas.refusal = frame.context.session.refusal(source, target) or ""
                    self.dragged.snap = None
            case _:
                pass


def _resize(context: CanvasContext, resize: ResizeGesture) -> None:
    left, top, right, bottom = resize.rect
    section, _, id = resize.key.partition(".")
    if resize.rect == resize.before:
        return
    if section == "frames":
        context.log.attempt(lambda: context.session.apply(ResizeFrame(id, left, top, right - left, bottom - top)))
    else:
        context.log.attempt(lambda: context.session.apply(ResizeComment(id, left, top, right - left)))


def _drawn(frame: CanvasFrame, draw: BandGesture) -> None:
    context, session = frame.context, frame.context.session
    crossings = frame.scene.net.crossed(draw.start, frame.at)
    if not crossings:
        return

    def dots() -> None:
        graph, keys = dotted(session.graph, crossings)
        session.apply(ReplaceGraph("Add dots", graph, keys))

    context.log.attempt(dots if draw.dots else lambda: session.apply(CutLinks(tuple(crossings))))
