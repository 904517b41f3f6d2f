"""Mouse input of the canvas: starts gestures, and applies finished gestures to the document."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from imgui_bundle import imgui
from msgspec import Struct, field
from msgspec.structs import replace

from ...authoring.commands import (
    AddDot,
    Connect,
    ConnectNodes,
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
from ...authoring.edits.decor import find_frame_members
from ...authoring.edits.element_id import NO_ELEMENT, ElementId
from ...authoring.edits.selection import SelectMode
from ...authoring.edits.wiring import why_not_linkable
from ...graph import Group, Port
from ...language.translation import translate
from .frame import CanvasFrame, apply_wheel, pan_at_border
from .geometry import Point, contains
from .gestures import (
    IDLE,
    Band,
    CutGesture,
    Gesture,
    GesturePreview,
    Idle,
    LinkGesture,
    MoveGesture,
    PanGesture,
    ResizeGesture,
    add_crossing_dots,
    add_members,
    find_fitting_pins,
    find_insertion,
    find_refused_pin,
    find_snap_pin,
    find_touched,
    make_band_rect,
    move_to,
    preview_gesture,
    resize_to,
)
from .scene import EMPTY, CanvasScene, Hit

if TYPE_CHECKING:
    from .context import CanvasContext

LEFT, RIGHT, MIDDLE = imgui.MouseButton_.left, imgui.MouseButton_.right, imgui.MouseButton_.middle

_SNAP_REACH = 30.0
"""Pixels from which a dragged link snaps to a pin: about a row of sockets. Chosen by feel."""


class PanelRequests(Struct):
    """Requests of a gesture to the canvas: a menu, the search, a text field, expanding a node."""

    menu: Hit | None = None
    search: tuple[Port, bool] | None = None
    rename: ElementId = NO_ELEMENT
    toggle: ElementId = NO_ELEMENT


class CanvasMouse(Struct):
    """The current gesture, and what is under the pointer."""

    gesture: Gesture = IDLE
    hit: Hit = EMPTY
    requests: PanelRequests = field(default_factory=PanelRequests)
    preview: GesturePreview = field(default_factory=lambda: GesturePreview(CanvasScene({})))
    _pressed: tuple[Hit, Point] | None = None
    """Where the right button was pressed."""
    _moves: int = 0
    _hit: tuple[CanvasScene, Point, float, Hit] = field(
        default_factory=lambda: (CanvasScene({}), (0.0, 0.0), 0.0, EMPTY)
    )
    """The last hit under the pointer, with its scene, position and reach."""

    def update(self, frame: CanvasFrame) -> None:
        """Continue the gesture, or begin one."""
        self.requests = PanelRequests()
        io = imgui.get_io()
        self.hit = self._find_hit(frame) if frame.hovered and isinstance(self.gesture, Idle) else EMPTY
        if frame.hovered or not isinstance(self.gesture, Idle):
            apply_wheel(frame, io, on_field=self.hit.part == "field")
        if isinstance(self.gesture, Idle):
            if frame.hovered:
                self._begin(frame, io)
        else:
            if not isinstance(self.gesture, PanGesture):
                pan_at_border(frame, io)
            self._continue(frame, io)
        frame.context.canvas.panning = isinstance(self.gesture, PanGesture)
        self._update_preview(frame)

    def _find_hit(self, frame: CanvasFrame) -> Hit:
        """The hit under the pointer, cached until the scene or the pointer moves."""
        inputs = frame.scene, frame.pointer, frame.reach
        if self._hit[0] is not frame.scene or self._hit[1:3] != inputs[1:]:
            self._hit = *inputs, frame.scene.find_hit(*frame.pointer, frame.reach)
        return self._hit[3]

    # --- beginning ---------------------------------------------------------------------------------------------------

    def _begin(self, frame: CanvasFrame, io: imgui.IO) -> None:
        context, view, hit = frame.context, frame.context.canvas, self.hit
        if imgui.is_mouse_clicked(MIDDLE) or (imgui.is_mouse_clicked(LEFT) and imgui.is_key_down(imgui.Key.space)):
            self.gesture = PanGesture(view.center, frame.screen)
        elif imgui.is_mouse_clicked(RIGHT):
            if io.key_ctrl or io.key_shift:
                self.gesture = CutGesture(frame.pointer, dots=io.key_shift)
            else:
                self._pressed = hit, frame.pointer
        elif imgui.is_mouse_double_clicked(LEFT):
            self._double_click(frame, hit)
        elif imgui.is_mouse_clicked(LEFT):
            if view.tool:
                self.gesture = CutGesture(frame.pointer, dots=view.tool == "dot")
                view.tool = ""
            else:
                self._press(frame, io, hit)
        if self._pressed and imgui.is_mouse_released(RIGHT):
            (hit, start), self._pressed = self._pressed, None
            if not frame.is_far(start):
                self._request_menu(context, hit)

    def _press(self, frame: CanvasFrame, io: imgui.IO, hit: Hit) -> None:
        context, session = frame.context, frame.context.session
        match hit.part:
            case "pin" if hit.port:
                self._begin_link(frame, hit.port, hit.output, io.key_ctrl)
            case "field":
                self._select(context, hit.key, "replace")
            case "more":
                self.requests.toggle = hit.key
            case "edge":
                self._select(context, hit.key, "replace")
                rect = frame.scene.boxes[hit.key].rect
                self.gesture = ResizeGesture(hit.key, hit.name, frame.pointer, rect, rect)
            case "title" | "body":
                if io.key_ctrl and io.key_shift and frame.scene.boxes[hit.key].sort in ("node", "end"):
                    context.log.attempt(lambda: session.views.show_element(hit.key))
                elif io.key_ctrl or io.key_shift:
                    self._select(context, hit.key, "toggle")
                else:
                    alone = hit.key in session.selection
                    if not alone:
                        self._select(context, hit.key, "replace")
                    self.gesture = MoveGesture(hit.key, frame.pointer, alone=alone)
            case _:
                mode = "add" if io.key_shift else "remove" if io.key_ctrl else "replace"
                self.gesture = Band(frame.pointer, mode)

    def _begin_link(self, frame: CanvasFrame, port: Port, output: bool, keep: bool) -> None:
        """Begin a link from a pin; an input gives up its link, unless `keep`."""
        graph = frame.context.session.graph
        detached = None if output or keep else port if port in graph.links else None
        start, is_output = (graph.links[port], True) if detached else (port, output)
        scene = frame.scene
        if detached:
            graph = graph.disconnect(detached)
        targets = frame.context.log.attempt(
            lambda: find_fitting_pins(graph, scene, start, is_output), frozenset[Port]()
        )
        self.gesture = LinkGesture(start, is_output, detached, targets or frozenset(), frame.pointer)

    def _double_click(self, frame: CanvasFrame, hit: Hit) -> None:
        context, session = frame.context, frame.context.session
        if hit.part == "link" and hit.port:
            target = hit.port
            context.log.attempt(lambda: session.apply(AddDot(target, frame.pointer)))
        elif hit.key.is_note:
            self.requests.rename = hit.key
        elif hit.part in ("title", "body") and hit.key.kind != "dot":
            item = session.graph.nodes.get(hit.key)
            if session.code_files.find_code(hit.key) is not None:
                context.code_files.show()
                return
            context.log.attempt(
                lambda: session.enter(hit.key) if isinstance(item, Group) else session.views.show_element(hit.key)
            )
        elif hit.part == "empty":
            context.canvas.searching = True

    def _request_menu(self, context: CanvasContext, hit: Hit) -> None:
        """Request a context menu; it acts on the selection, so a clicked element is selected first."""
        if hit.key and hit.part != "pin" and hit.key not in context.session.selection:
            self._select(context, hit.key, "replace")
        self.requests.menu = hit

    def _select(self, context: CanvasContext, key: ElementId, mode: SelectMode) -> None:
        context.log.attempt(lambda: context.session.select((key,), mode))

    # --- going on ----------------------------------------------------------------------------------------------------

    def _continue(self, frame: CanvasFrame, io: imgui.IO) -> None:
        gesture, view = self.gesture, frame.context.canvas
        cancelled = imgui.is_key_pressed(imgui.Key.escape) or (
            not isinstance(gesture, CutGesture | PanGesture) and imgui.is_mouse_clicked(RIGHT)
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
                self._end_if(not (imgui.is_mouse_down(MIDDLE) or imgui.is_mouse_down(LEFT)), lambda: None)
            case Band():
                self._end_if(not imgui.is_mouse_down(LEFT), lambda: self._finish_band(frame, gesture))
            case MoveGesture():
                self.gesture = self._update_move(frame, gesture, snap=io.key_ctrl, extract=io.key_alt)
                self._end_if(not imgui.is_mouse_down(LEFT), lambda: self._finish_move(frame))
            case ResizeGesture():
                self.gesture = resized = resize_to(gesture, frame.pointer, snap=io.key_ctrl)
                self._end_if(not imgui.is_mouse_down(LEFT), lambda: _resize(frame.context, resized))
            case CutGesture():
                released = not (imgui.is_mouse_down(LEFT) or imgui.is_mouse_down(RIGHT))
                self._end_if(released, lambda: _finish_cut(frame, gesture))
            case LinkGesture():
                self._end_if(not imgui.is_mouse_down(LEFT), lambda: self._finish_link(frame, gesture))
            case Idle():
                pass

    def _end_if(self, ended: bool, act: Callable[[], object]) -> None:
        if ended:
            act()
            self.gesture = IDLE

    def _update_move(self, frame: CanvasFrame, move: MoveGesture, snap: bool, extract: bool) -> MoveGesture:
        session = frame.context.session
        if not move.is_moving:
            if not frame.is_far(move.start):
                return move
            members = [
                find_frame_members(session.graph, key, session.positions, frame.scene.sizes)
                for key in session.selection
                if key.kind == "frame"
            ]
            move = replace(move, keys=add_members(session.selection, frame.scene, members))
            if extract and any(wire.crosses_border(move.keys) for wire in frame.scene.wires):
                self._moves += 1
                merge, steps = f"move {self._moves}", session.history.position
                frame.context.log.attempt(lambda: session.apply(ExtractSelection(merge)))
                if session.history.position > steps:
                    move = replace(move, merge=merge)
        return move_to(move, frame.scene, frame.pointer, snap)

    def _finish_move(self, frame: CanvasFrame) -> None:
        move, session = self.gesture, frame.context.session
        if not isinstance(move, MoveGesture):
            return
        if not move.is_moving:
            if move.alone:
                self._select(frame.context, move.key, "replace")
            return
        target = find_insertion(
            session.graph, preview_gesture(frame.scene, move), move.keys, frame.pointer, frame.reach
        )
        if target:
            ids, sizes = sorted(move.keys & session.graph.nodes.keys()), frame.scene.sizes
            frame.context.log.attempt(lambda: session.apply(SpliceChain(ids, target, move.offset, sizes, move.merge)))
        elif move.offset != (0.0, 0.0):
            keys = sorted(move.keys & frame.scene.boxes.keys())
            frame.context.log.attempt(lambda: session.apply(MoveElements(keys, *move.offset, merge=move.merge)))
        session.seal()

    def _finish_band(self, frame: CanvasFrame, band: Band) -> None:
        context = frame.context
        if not frame.is_far(band.start):
            hit = frame.scene.find_hit(*band.start, frame.reach)
            wire = frame.scene.by_target.get(hit.port) if hit.part == "link" and hit.port else None
            keys = {wire.stops[0], wire.stops[-1]} if wire else ()
            if keys or band.mode == "replace":
                context.log.attempt(lambda: context.session.select(keys, band.mode))
            return
        keys = find_touched(frame.scene, make_band_rect(band, frame.pointer))
        context.log.attempt(lambda: context.session.select(keys, band.mode))

    def _finish_link(self, frame: CanvasFrame, link: LinkGesture) -> None:
        """Connect what the link was dropped on. On its own start it was a click, which shows the output in the viewer;
        on nothing, a link that was picked up is removed, and a new one opens the search for nodes that fit.
        """
        context, session = frame.context, frame.context.session
        refused_port = find_refused_pin(frame.scene, link, frame.pointer, frame.reach)
        snap = self._find_snap(frame, link) if refused_port is None else None
        if snap:
            snap_port = snap[0]
            source, target = (link.port, snap_port) if link.output else (snap_port, link.port)
            detached = link.detached
            if detached == target:
                return
            if detached:
                context.log.attempt(lambda: session.apply(MoveLink(detached, target)))
            elif self._links_nodes(frame, source, target, snap[1]):
                context.log.attempt(lambda: session.apply(ConnectNodes(source, target)))
            else:
                context.log.attempt(lambda: session.apply(Connect(source, target)))
        elif not frame.is_far(link.start):
            if link.output and link.detached is None:
                context.log.attempt(lambda: session.views.show(link.port))
        elif refused_port is None and not frame.scene.find_node(*frame.pointer):
            if link.detached:
                target = link.detached
                context.log.attempt(lambda: session.apply(Disconnect(target)))
            elif contains(frame.panel, *frame.screen):
                self.requests.search = link.port, link.output

    def _find_snap(self, frame: CanvasFrame, link: LinkGesture) -> tuple[Port, Point] | None:
        return find_snap_pin(frame.scene, link, frame.pointer, _SNAP_REACH * frame.scale / frame.to.scale)

    def _links_nodes(self, frame: CanvasFrame, source: Port, target: Port, pin: Point) -> bool:
        """True if all sockets of the same name are meant: dropped on a node, or on a socket that is called alike.

        Ctrl links one socket alone.
        """
        reach = _SNAP_REACH * frame.scale / frame.to.scale
        on_node = math.dist(frame.pointer, pin) > reach
        return (on_node or source.socket == target.socket) and not imgui.get_io().key_ctrl

    # --- what is seen of it ------------------------------------------------------------------------------------------

    def _update_preview(self, frame: CanvasFrame) -> None:
        gesture, graph = self.gesture, frame.context.session.graph
        self.preview = GesturePreview(preview_gesture(frame.scene, gesture))
        frame.context.canvas.refusal = ""
        match gesture:
            case MoveGesture() if gesture.is_moving:
                self.preview.insert = find_insertion(
                    graph, self.preview.scene, gesture.keys, frame.pointer, frame.reach
                )
            case CutGesture():
                self.preview.crossed = frame.scene.links.find_crossed(gesture.start, frame.pointer)
            case LinkGesture():
                self.preview.snap = self._find_snap(frame, gesture)
                if refused_port := find_refused_pin(frame.scene, gesture, frame.pointer, frame.reach):
                    source, target = (gesture.port, refused_port) if gesture.output else (refused_port, gesture.port)
                    if refused_port != gesture.port and source.node != target.node:
                        frame.context.canvas.refusal = (
                            why_not_linkable(frame.context.session.graph, source, target) or ""
                        )
                    self.preview.snap = None
            case _:
                pass


def _resize(context: CanvasContext, resize: ResizeGesture) -> None:
    left, top, right, bottom = resize.rect
    note = resize.key
    if resize.rect == resize.before:
        return
    if note.kind == "frame":
        context.log.attempt(lambda: context.session.apply(ResizeFrame(note, left, top, right - left, bottom - top)))
    else:
        context.log.attempt(lambda: context.session.apply(ResizeComment(note, left, top, right - left)))


def _finish_cut(frame: CanvasFrame, gesture: CutGesture) -> None:
    context, session = frame.context, frame.context.session
    crossings = frame.scene.links.find_crossed(gesture.start, frame.pointer)
    if not crossings:
        return

    def add_dots() -> None:
        graph, dots = add_crossing_dots(session.graph, crossings)
        session.apply(ReplaceGraph(translate("Add dots"), graph, dots))

    context.log.attempt(add_dots if gesture.dots else lambda: session.apply(CutLinks(tuple(crossings))))
