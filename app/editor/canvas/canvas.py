"""The panel in which the graph is drawn and edited."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

from imgui_bundle import imgui
from msgspec import Struct

from ...authoring.edits.element_id import NO_ELEMENT, ElementId
from ...authoring.edits.elements import entry
from ...authoring.edits.link_curves import make_curve
from ...graph import Graph, Port
from ..theme.style import ui_scale
from ..toolkit.words import show_tip
from .brush import DETAILS_FROM, DrawContext, TextCache, make_canvas_colors
from .crumbs import draw_crumbs
from .frame import CanvasFrame
from .geometry import Point, Rect, avoid_corner, contains, find_bounds, fit_view, make_transform, reveal_rect
from .gestures import Band, CutGesture, Idle, LinkGesture, MoveGesture, ResizeGesture, make_band_rect
from .hints import explain_tool, hint_at_beginning
from .layout import PICTURE
from .legend import Legend
from .live import LiveFields, has_live_widget
from .looks import LookFacts, gather_look_facts
from .menus import CanvasMenus
from .minimap import Minimap
from .mouse import CanvasMouse
from .naming import NameField
from .paint_decor import (
    paint_band,
    paint_comment,
    paint_curve,
    paint_cut,
    paint_dot,
    paint_frame,
    paint_grid,
    paint_hint,
    paint_note,
    paint_wire,
)
from .paint_node import paint_node, paint_pin
from .pictures import ThumbnailSlots
from .places import PlaceRecorder
from .scene import CanvasScene, ElementBox
from .search import NodeSearch
from .staging import SceneBuilder

if TYPE_CHECKING:
    from .context import CanvasContext

_ANY_TIME = int(imgui.HoveredFlags_.allow_when_blocked_by_active_item)
_BUTTONS = (
    int(imgui.ButtonFlags_.mouse_button_left)
    | int(imgui.ButtonFlags_.mouse_button_right)
    | int(imgui.ButtonFlags_.mouse_button_middle)
)


class _FitState(Struct, frozen=True):
    """The elements of the last fit, the view that it gave, and its inputs."""

    keys: Collection[ElementId] = ()
    view: tuple[Point, float] = ((0.0, 0.0), 0.0)
    size: Point = (0.0, 0.0)
    scene: CanvasScene | None = None
    graph: Graph | None = None


class Canvas:
    """The graph canvas: draws nodes, links and overlays, and handles the mouse."""

    def __init__(self, context: CanvasContext) -> None:
        self._context = context
        self._builder = SceneBuilder()
        self._scene: CanvasScene | None = None
        self._scene_inputs: tuple[object, ...] = ()
        self._texts = TextCache()
        self._live = LiveFields(context)
        self._mouse = CanvasMouse()
        self._search = NodeSearch(context)
        self._menus = CanvasMenus(context)
        self._naming = NameField(context)
        self._minimap = Minimap(context)
        self._legend = Legend(context)
        self._places = PlaceRecorder(context)
        self._pictures = ThumbnailSlots()
        self._hot = NO_ELEMENT
        self._group_path: tuple[str, ...] = ()
        self._views: dict[tuple[str, ...], tuple[Point, float]] = {}

    def draw(self) -> None:
        """Draw the graph at the session's place into the current window. One invisible button takes the mouse over all
        of it, so that gestures may begin anywhere and go on outside; fields of nodes lie on top of that button."""
        fonts, view, scale = self._context.fonts, self._context.canvas, ui_scale()
        panel = _find_window_rect()
        area = panel[2] - panel[0], panel[3] - panel[1]
        if fonts is None or min(area) < 16:
            return
        imgui.set_scroll_x(0.0)
        imgui.set_scroll_y(0.0)
        self._restore_view()
        scene = self._build_scene()
        self._fit(scene, (area[0] / scale, area[1] / scale))
        self._reveal(scene, (area[0] / scale, area[1] / scale))
        to = make_transform(panel, view.center, view.zoom * scale)
        low_seen, high_seen = to.to_canvas(*panel[:2]), to.to_canvas(*panel[2:])
        brush = DrawContext(
            imgui.get_window_draw_list(),
            to,
            view.zoom,
            make_canvas_colors(self._context.palette.name),
            fonts,
            self._texts,
            (*low_seen, *high_seen),
        )
        brush.draw.push_clip_rect(panel[:2], panel[2:], False)
        imgui.set_cursor_screen_pos(panel[:2])
        imgui.set_next_item_allow_overlap()
        imgui.push_item_flag(int(imgui.ItemFlags_.no_nav), True)
        imgui.invisible_button("##canvas", area, _BUTTONS)
        imgui.pop_item_flag()
        view.hovered = imgui.is_window_hovered(_ANY_TIME)
        busy = imgui.is_any_item_active() and not imgui.is_item_active()
        over = view.hovered and not busy and not self._is_covered(panel)
        at = imgui.get_mouse_pos()
        frame = CanvasFrame(self._context, scene, to, panel, scale, over, to.to_canvas(at.x, at.y), (at.x, at.y))
        if view.hovered and not self._search.is_open:
            view.pointer = frame.pointer
        self._mouse.update(frame)

        paint_grid(brush, panel)
        self._paint(brush, frame)
        self._draw_overlays(brush, frame)
        brush.draw.pop_clip_rect()
        view.sizes, view.find_pins = scene.sizes, scene.find_pins
        if not view.panning:  # everything moves: nobody can point at a place that is already another
            self._places.record(self._mouse.preview.scene, brush)

    # --- before painting ---------------------------------------------------------------------------------------------

    def _restore_view(self) -> None:
        """Restore the view of the open group; fit the view to a group that is opened first."""
        place, view = self._context.session.place, self._context.canvas
        if place == self._group_path:
            return
        self._views[self._group_path] = view.center, view.zoom
        self._group_path = place
        if place in self._views:
            view.center, view.zoom = self._views[place]
        else:
            view.fit()

    def _build_scene(self) -> CanvasScene:
        session, pictures = self._context.session, self._pictures.list_elements(self._context)
        gesture = self._mouse.gesture
        expanded_key = self._expanded_key if isinstance(gesture, LinkGesture) else NO_ELEMENT
        graph = session.time.evaluated_graph
        frame = None if graph is session.graph else session.time.frame
        inputs = (session.revision, frame, pictures, expanded_key, frozenset(self._builder.expanded))
        if self._scene is None or inputs != self._scene_inputs:
            positions, background = session.positions, session.selection - {session.active}
            top = [key for key in session.elements if key in background] if background else []
            self._scene = self._builder.build(
                graph, positions.__getitem__, [*top, session.active], pictures, expanded_key
            )
            self._scene_inputs = inputs
        return self._scene

    @property
    def _expanded_key(self) -> ElementId:
        """The node that shows all its values because a link is dragged over it."""
        scene = self._mouse.preview.scene
        key = scene.find_node(*self._pointer) if scene.boxes else NO_ELEMENT
        gesture = self._mouse.gesture
        return key if isinstance(gesture, LinkGesture) and gesture.output else NO_ELEMENT

    _pointer: Point = (0.0, 0.0)

    def _fit(self, scene: CanvasScene, size: Point) -> None:
        """Fit the view to the requested elements, and again when the panel is resized or pictures make nodes larger,
        until the user moves the view or opens another graph; never below a hand that drags."""
        view, last = self._context.canvas, self._last_fit
        if view.pending_fit is None:
            is_idle, is_same = isinstance(self._mouse.gesture, Idle), last.graph is self._context.session.root
            untouched = last.view == (view.center, view.zoom) and is_idle and is_same
            if not untouched or (last.size == size and last.scene is scene):
                return
            keys = last.keys
        else:
            keys, view.pending_fit = view.pending_fit, None
        around = find_bounds(box.rect for key, box in scene.boxes.items() if not keys or key in keys)
        view.center, view.zoom = fit_view(around, size, view.least_zoom) if around else ((0.0, 0.0), 1.0)
        self._last_fit = _FitState(keys, (view.center, view.zoom), size, scene, self._context.session.root)

    _last_fit = _FitState()

    def _reveal(self, scene: CanvasScene, size: Point) -> None:
        view = self._context.canvas
        boxes = [scene.boxes[key] for key in view.pending_reveal if key in scene.boxes]
        if around := find_bounds(box.rect for box in boxes):
            below = around[3] + (PICTURE if self._context.store.current.thumbnails else 0.0)  # it comes a moment later
            rect = *around[:3], below
            center = reveal_rect(rect, view.center, view.zoom, size)
            view.center = avoid_corner(rect, center, view.zoom, size, self._minimap.find_corner(size))
        view.pending_reveal = ()

    def _is_covered(self, panel: Rect) -> bool:
        mouse = imgui.get_mouse_pos()
        preferences = self._context.store.current
        return any(
            contains(rect, mouse.x, mouse.y)
            for rect in (
                self._minimap.find_rect(panel) if preferences.minimap else None,
                self._legend.find_rect(panel),
                self._naming.rect,
                self._context.places.get("crumbs"),
            )
            if rect
        )

    # --- painting ----------------------------------------------------------------------------------------------------

    def _paint(self, brush: DrawContext, frame: CanvasFrame) -> None:
        scene, session, mouse = self._mouse.preview.scene, self._context.session, self._mouse
        self._pointer = frame.pointer
        hot = self._hot = self._find_hot(frame, scene)
        facts = gather_look_facts(self._context, brush.ink, mouse.gesture, hot)
        if not session.graph.nodes:
            paint_hint(brush, frame.panel, hint_at_beginning(self._context))
        visible = scene.list_boxes(_grow(brush.visible, 32.0))
        for box in visible:
            if box.sort == "frame":
                lit = mouse.hit.key == box.key or (
                    isinstance(mouse.gesture, ResizeGesture) and mouse.gesture.key == box.key
                )
                paint_frame(brush, box, entry(session.graph, box.key), box.key in session.selection, lit)
        self._paint_wires(brush, scene)
        self._live.begin()
        for box in visible:
            if box.layout:
                self._paint_node(brush, box, facts, hot)
            elif box.sort == "comment" and self._naming.key != box.key:
                text = str(entry(session.graph, box.key).get("text", ""))
                paint_comment(brush, box, text, box.key in session.selection)
            elif box.sort == "dot":
                kind = next((wire.kind for wire in scene.wires if box.key in wire.stops), None)
                paint_dot(brush, box, brush.ink.kinds[kind], box.key in session.selection)
        self._live.end()
        self._paint_gesture(brush, frame)
        self._draw_tooltip(facts, scene)

    def _find_hot(self, frame: CanvasFrame, scene: CanvasScene) -> ElementId:
        """The node whose fields are widgets: the one with an active field, else the one under the pointer."""
        if self._live.holder:
            return self._live.holder
        if self._live.open:
            return ElementId.of_port(self._live.open[0])
        if imgui.is_any_item_active() and isinstance(self._mouse.gesture, Idle):
            return self._hot
        is_idle = frame.hovered and isinstance(self._mouse.gesture, Idle)
        return scene.find_node(*frame.pointer) if is_idle else NO_ELEMENT

    def _paint_node(self, brush: DrawContext, box: ElementBox, facts: LookFacts, hot: ElementId) -> None:
        layout = box.layout
        if layout is None:
            return
        live = box.key == hot and brush.zoom >= DETAILS_FROM and box.sort == "node" and not layout.collapsed
        names = frozenset(row.value.name for row in layout.rows if live and row.value and has_live_widget(row))
        look = facts.make_look(box.key, names)
        paint_node(brush, box, layout, look)
        if look.overlay:
            facts.context.places[f"cost {box.key}"] = brush.project((box.x, box.y - 20.0, box.x + box.w, box.y))
        if live:
            self._live.draw(brush, box, layout.rows)

    def _paint_wires(self, brush: DrawContext, scene: CanvasScene) -> None:
        mouse, selection = self._mouse, self._context.session.selection
        linking = isinstance(mouse.gesture, LinkGesture)
        detached = mouse.gesture.detached if isinstance(mouse.gesture, LinkGesture) else None
        highlighted = {mouse.hit.port} if mouse.hit.part == "link" else {mouse.preview.insert, *mouse.preview.crossed}
        for wire in scene.links.list_visible(brush.visible):
            if wire.target != detached:
                lit = wire.target in highlighted or wire.stops[0] in selection or wire.stops[-1] in selection
                paint_wire(brush, wire, lit=lit, faded=linking)
        for port in (mouse.preview.insert, *mouse.preview.crossed):
            if port and port in scene.by_target:
                color = brush.ink.accent if port == mouse.preview.insert else brush.ink.error
                for shape in scene.by_target[port].curves:
                    paint_curve(brush, shape, color, 3.0, halo=False)

    def _paint_gesture(self, brush: DrawContext, frame: CanvasFrame) -> None:
        mouse = self._mouse
        match mouse.gesture:
            case Band() as band:
                paint_band(brush, make_band_rect(band, frame.pointer))
            case CutGesture() as line:
                color = brush.ink.accent if line.dots else brush.ink.error
                paint_cut(brush, line.start, frame.pointer, color)
                imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
            case LinkGesture() as link:
                self._paint_link(brush, frame, link)
            case MoveGesture() as move if move.is_moving:
                imgui.set_mouse_cursor(imgui.MouseCursor_.resize_all)
            case _:
                if mouse.hit.part == "edge":
                    across = set(mouse.hit.name) <= set("lr")
                    is_corner = len(mouse.hit.name) > 1
                    cursor = (
                        imgui.MouseCursor_.resize_nwse
                        if is_corner
                        else (imgui.MouseCursor_.resize_ew if across else imgui.MouseCursor_.resize_ns)
                    )
                    imgui.set_mouse_cursor(cursor)
        if self._context.canvas.refusal:
            paint_note(brush, *frame.screen, self._context.canvas.refusal, brush.ink.error)
        elif self._context.canvas.tool and frame.hovered:
            paint_note(brush, *frame.screen, explain_tool(self._context.canvas.tool), brush.ink.text)
            if imgui.is_key_pressed(imgui.Key.escape):
                self._context.canvas.tool = ""

    def _paint_link(self, brush: DrawContext, frame: CanvasFrame, link: LinkGesture) -> None:
        scene = self._mouse.preview.scene
        start_pin = next(((box, pin) for port, box, pin in scene.list_pins(link.output) if port == link.port), None)
        if start_pin is None:
            return
        box, pin = start_pin
        start = box.x + pin.x, box.y + pin.y
        snap = self._mouse.preview.snap
        end = snap[1] if snap else frame.pointer
        shape = make_curve(*start, *end) if link.output else make_curve(*end, *start)
        color = brush.ink.error if frame.context.canvas.refusal else brush.ink.kinds[pin.kind]
        paint_curve(brush, shape, color, 3.0)
        paint_pin(brush, *start, pin.kind, color, 1.5)
        if snap:
            paint_pin(brush, *end, pin.kind, color, 2.5)

    def _draw_tooltip(self, facts: LookFacts, scene: CanvasScene) -> None:
        hit = self._mouse.hit
        if not isinstance(self._mouse.gesture, Idle) or self._menus.is_open:
            return
        text = ""
        if hit.part == "link" and hit.port and (wire := scene.by_target.get(hit.port)):
            text = f"{wire.source}  to  {wire.target}" + (f"\n{wire.fault}" if wire.fault else "")
        elif hit.part == "pin" and hit.port:
            text = _describe_pin(facts.context, hit.port, hit.output)
        elif hit.part == "title":
            box = scene.boxes[hit.key]
            text = "\n".join((*facts.faults(hit.key), *facts.warnings(hit.key))) or (
                box.layout.doc if box.layout else ""
            )
        flags = int(imgui.HoveredFlags_.for_tooltip)
        if text and imgui.is_window_hovered(flags):
            show_tip(text)

    # --- around it ---------------------------------------------------------------------------------------------------

    def _draw_overlays(self, brush: DrawContext, frame: CanvasFrame) -> None:
        requests, view = self._mouse.requests, self._context.canvas
        self._builder.expanded ^= {requests.toggle} if requests.toggle else set()
        if view.renaming or requests.rename:
            self._naming.begin(view.renaming or requests.rename)
            view.renaming = NO_ELEMENT
        self._naming.draw(brush, self._mouse.preview.scene)
        if self._context.store.current.minimap and self._mouse.preview.scene.boxes:
            self._minimap.draw(brush, frame.panel, self._mouse.preview.scene)
        self._legend.draw(brush, frame.panel)
        draw_crumbs(self._context, brush, frame.panel)
        if requests.menu:
            self._menus.begin(requests.menu, frame.pointer)
        self._menus.draw()
        if requests.search:
            self._search.begin(frame.pointer, *requests.search)
        elif view.searching:
            view.searching = False
            self._search.begin(view.pointer)
        elif view.replacing:
            self._search.begin_replacing(view.replacing)
            view.replacing = ""
        self._search.draw()


def _find_window_rect() -> Rect:
    """The area of the window below its tab, up to its borders."""
    low, pos, size = imgui.get_cursor_screen_pos(), imgui.get_window_pos(), imgui.get_window_size()
    return low.x, low.y, pos.x + size.x, pos.y + size.y


def _grow(rect: Rect, by: float) -> Rect:
    return rect[0] - by, rect[1] - by, rect[2] + by, rect[3] + by


def _describe_pin(context: CanvasContext, port: Port, output: bool) -> str:
    """A description of a socket: port, kind and doc."""
    graph = context.session.graph
    socket = context.log.attempt(lambda: graph.source(port) if output else graph.target(port))
    if socket is None:
        return str(port)
    return f"{port}  ({getattr(socket, 'kind', None) or 'value'})" + (f"\n{socket.doc}" if socket.doc else "")
