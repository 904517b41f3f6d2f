"""The panel in which the graph is drawn and edited."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from ...authoring.edits.elements import entry
from ...graph import Graph, Port
from ..theme.style import ui_scale
from .brush import DETAILS_FROM, DrawContext, TextCache, ink
from .crumbs import draw_crumbs
from .frame import CanvasFrame
from .geometry import Point, Rect, bounds, curve, fitted, holds, overlap, transform
from .gestures import Band, BandGesture, Idle, Link, MoveGesture, ResizeGesture, band_rect
from .legend import Legend
from .live import Live, drawn_live
from .looks import Moment, moment
from .menus import Menus
from .minimap import Minimap
from .mouse import CanvasMouse
from .naming import Naming
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
from .places import Places
from .scene import CanvasScene, ElementBox
from .search import Search
from .staging import SceneBuilder

if TYPE_CHECKING:
    from .context import CanvasContext

_HINTS = ("An empty graph", "Tab adds a node", "Drop an image or a graph file here")
_ANY_TIME = int(imgui.HoveredFlags_.allow_when_blocked_by_active_item)
_BUTTONS = (
    int(imgui.ButtonFlags_.mouse_button_left)
    | int(imgui.ButtonFlags_.mouse_button_right)
    | int(imgui.ButtonFlags_.mouse_button_middle)
)


@dataclass(frozen=True)
class _Fitted:
    """What was brought into view last, the view that this gave, and for what."""

    keys: Collection[str] = ()
    view: tuple[Point, float] = ((0.0, 0.0), 0.0)
    size: Point = (0.0, 0.0)
    scene: CanvasScene | None = None
    graph: Graph | None = None


class Canvas:
    """Nodes, links and what is around them; everything the mouse does to them."""

    title = "Graph"

    def __init__(self, context: CanvasContext) -> None:
        self._context = context
        self._stage = SceneBuilder()
        self._scene: CanvasScene | None = None
        self._staged: tuple[object, ...] = ()
        self._texts = TextCache()
        self._live = Live(context)
        self._mouse = CanvasMouse()
        self._search = Search(context)
        self._menus = Menus(context)
        self._naming = Naming(context)
        self._minimap = Minimap(context)
        self._legend = Legend(context)
        self._places = Places(context)
        self._pictures = ThumbnailSlots()
        self._hot = ""
        self._place: tuple[str, ...] = ()
        self._views: dict[tuple[str, ...], tuple[Point, float]] = {}

    def draw(self) -> None:
        """Draw the graph at the session's place into the current window."""
        fonts, view, scale = self._context.fonts, self._context.canvas, ui_scale()
        panel = _whole_window()
        area = panel[2] - panel[0], panel[3] - panel[1]
        if fonts is None or min(area) < 16:
            return
        imgui.set_scroll_x(0.0)
        imgui.set_scroll_y(0.0)
        self._enter()
        scene = self._build()
        self._fit(scene, (area[0] / scale, area[1] / scale))
        to = transform(panel, view.center, view.zoom * scale)
        low_seen, high_seen = to.to_canvas(*panel[:2]), to.to_canvas(*panel[2:])
        brush = DrawContext(
            imgui.get_window_draw_list(),
            to,
            view.zoom,
            ink(self._context.palette.name),
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
        over = view.hovered and not busy and not self._blocked(panel)
        at = imgui.get_mouse_pos()
        frame = CanvasFrame(self._context, scene, to, panel, scale, over, to.to_canvas(at.x, at.y), (at.x, at.y))
        if view.hovered and not self._search.is_open:
            view.pointer = frame.at
        self._mouse.update(frame)

        paint_grid(brush, panel)
        self._paint(brush, frame)
        self._around(brush, frame)
        brush.draw.pop_clip_rect()
        view.sizes = scene.sizes
        self._places.record(self._mouse.dragged.scene, brush)

    # --- before painting ---------------------------------------------------------------------------------------------

    def _enter(self) -> None:
        """Every group keeps the view that someone had of it; a new one is seen whole."""
        place, view = self._context.session.place, self._context.canvas
        if place == self._place:
            return
        self._views[self._place] = view.center, view.zoom
        self._place = place
        if place in self._views:
            view.center, view.zoom = self._views[place]
        else:
            view.fit()

    def _build(self) -> CanvasScene:
        session, pictures = self._context.session, self._pictures.of(self._context)
        gesture = self._mouse.gesture
        opened = self._opened if isinstance(gesture, Link) else ""
        graph = session.graph_now
        frame = None if graph is session.graph else session.frame
        staged = (session.revision, frame, pictures, opened, frozenset(self._stage.expanded))
        if self._scene is None or staged != self._staged:
            positions, others = session.positions, session.selection - {session.active}
            top = [key for key in session.elements if key in others] if others else []
            self._scene = self._stage.build(graph, positions.__getitem__, [*top, session.active], pictures, opened)
            self._staged = staged
        return self._scene

    @property
    def _opened(self) -> str:
        """The node that shows all it has because a link is dragged over it."""
        scene = self._mouse.dragged.scene
        key = scene.node_at(*self._over) if scene.boxes else ""
        return key if key and isinstance(self._mouse.gesture, Link) and self._mouse.gesture.output else ""

    _over: Point = (0.0, 0.0)

    def _fit(self, scene: CanvasScene, size: Point) -> None:
        """Bring into view what was asked for. It stays so until someone moves the view or changes the graph, even when
        the panel is resized or first pictures make nodes larger."""
        view, last = self._context.canvas, self._fitted
        if view.wanted is None:
            untouched = last.view == (view.center, view.zoom) and last.graph is self._context.session.root
            if not untouched or (last.size == size and last.scene is scene):
                return
            keys = last.keys
        else:
            keys, view.wanted = view.wanted, None
        around = bounds(box.rect for key, box in scene.boxes.items() if not keys or key in keys)
        view.center, view.zoom = fitted(around, size) if around else ((0.0, 0.0), 1.0)
        self._fitted = _Fitted(keys, (view.center, view.zoom), size, scene, self._context.session.root)

    _fitted = _Fitted()

    def _blocked(self, panel: Rect) -> bool:
        mouse = imgui.get_mouse_pos()
        likes = self._context.store.current
        return any(
            holds(rect, mouse.x, mouse.y)
            for rect in (
                self._minimap.rect(panel) if likes.minimap else None,
                self._legend.rect(panel),
                self._naming.rect,
                self._context.places.get("crumbs"),
            )
            if rect
        )

    # --- painting ----------------------------------------------------------------------------------------------------

    def _paint(self, brush: DrawContext, frame: CanvasFrame) -> None:
        scene, session, mouse = self._mouse.dragged.scene, self._context.session, self._mouse
        self._over = frame.at
        hot = self._hot = self._found_hot(frame, scene)
        now = moment(self._context, brush.ink, mouse.gesture, hot)
        if not session.graph.nodes:
            paint_hint(brush, frame.panel, _HINTS)
        visible = [box for box in scene.boxes.values() if overlap(box.rect, _grown(brush.seen, 32.0))]
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
                self._paint_node(brush, box, now, hot)
            elif box.sort == "comment" and self._naming.key != box.key:
                text = str(entry(session.graph, box.key).get("text", ""))
                paint_comment(brush, box, text, box.key in session.selection)
            elif box.sort == "dot":
                kind = next((wire.kind for wire in scene.wires if box.key in wire.stops), None)
                paint_dot(brush, box, brush.ink.kinds[kind], box.key in session.selection)
        self._live.end()
        self._paint_gesture(brush, frame)
        self._tooltip(now, scene)

    def _found_hot(self, frame: CanvasFrame, scene: CanvasScene) -> str:
        """The node whose fields are widgets: the one that holds the mouse, else the one below it."""
        if self._live.holder:
            return self._live.holder
        if self._live.open:
            return self._live.open[0].node
        if imgui.is_any_item_active() and isinstance(self._mouse.gesture, Idle):
            return self._hot
        return scene.node_at(*frame.at) if frame.over and isinstance(self._mouse.gesture, Idle) else ""

    def _paint_node(self, brush: DrawContext, box: ElementBox, now: Moment, hot: str) -> None:
        layout = box.layout
        if layout is None:
            return
        live = box.key == hot and brush.zoom >= DETAILS_FROM and box.sort == "node" and not layout.collapsed
        names = frozenset(row.value.name for row in layout.rows if live and row.value and drawn_live(row))
        look = now.look(box.key, names)
        paint_node(brush, box, layout, look)
        if look.overlay:
            now.context.places[f"cost {box.key}"] = brush.on_screen((box.x, box.y - 20.0, box.x + box.w, box.y))
        if live:
            self._live.draw(brush, box, layout.rows)

    def _paint_wires(self, brush: DrawContext, scene: CanvasScene) -> None:
        mouse, selection = self._mouse, self._context.session.selection
        linking = isinstance(mouse.gesture, Link)
        taken = mouse.gesture.detached if isinstance(mouse.gesture, Link) else None
        chosen = {mouse.hit.port} if mouse.hit.part == "link" else {mouse.dragged.insert, *mouse.dragged.crossed}
        for wire in scene.wires:
            if wire.target != taken:
                lit = wire.target in chosen or wire.stops[0] in selection or wire.stops[-1] in selection
                paint_wire(brush, wire, lit=lit, faded=linking)
        for port in (mouse.dragged.insert, *mouse.dragged.crossed):
            if port and port in scene.by_target:
                color = brush.ink.accent if port == mouse.dragged.insert else brush.ink.error
                for shape in scene.by_target[port].curves:
                    paint_curve(brush, shape, color, 3.0, halo=False)

    def _paint_gesture(self, brush: DrawContext, frame: CanvasFrame) -> None:
        mouse = self._mouse
        match mouse.gesture:
            case Band() as band:
                paint_band(brush, band_rect(band, frame.at))
            case BandGesture() as line:
                color = brush.ink.accent if line.dots else brush.ink.error
                paint_cut(brush, line.start, frame.at, color)
                imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
            case Link() as link:
                self._paint_link(brush, frame, link)
            case MoveGesture() as move if move.going:
                imgui.set_mouse_cursor(imgui.MouseCursor_.resize_all)
            case _:
                if mouse.hit.part == "edge":
                    across = set(mouse.hit.name) <= set("lr")
                    both = len(mouse.hit.name) > 1
                    cursor = (
                        imgui.MouseCursor_.resize_nwse
                        if both
                        else (imgui.MouseCursor_.resize_ew if across else imgui.MouseCursor_.resize_ns)
                    )
                    imgui.set_mouse_cursor(cursor)
        if self._context.canvas.refusal:
            paint_note(brush, *frame.screen, self._context.canvas.refusal, brush.ink.error)
        elif self._context.canvas.tool and frame.over:
            what = "cut them" if self._context.canvas.tool == "cut" else "put dots on them"
            paint_note(brush, *frame.screen, f"Drag across links to {what}; Escape ends", brush.ink.text)
            if imgui.is_key_pressed(imgui.Key.escape):
                self._context.canvas.tool = ""

    def _paint_link(self, brush: DrawContext, frame: CanvasFrame, link: Link) -> None:
        scene = self._mouse.dragged.scene
        found = next(((box, pin) for port, box, pin in scene.pins(link.output) if port == link.port), None)
        if found is None:
            return
        box, pin = found
        start = box.x + pin.x, box.y + pin.y
        snap = self._mouse.dragged.snap
        end = snap[1] if snap else frame.at
        shape = curve(*start, *end) if link.output else curve(*end, *start)
        color = brush.ink.error if frame.context.canvas.refusal else brush.ink.kinds[pin.kind]
        paint_curve(brush, shape, color, 3.0)
        paint_pin(brush, *start, pin.kind, color, 1.5)
        if snap:
            paint_pin(brush, *end, pin.kind, color, 2.5)

    def _tooltip(self, now: Moment, scene: CanvasScene) -> None:
        hit = self._mouse.hit
        if not isinstance(self._mouse.gesture, Idle) or self._menus.is_open:
            return
        words = ""
        if hit.part == "link" and hit.port and (wire := scene.by_target.get(hit.port)):
            words = f"{wire.source}  to  {wire.target}" + (f"\n{wire.fault}" if wire.fault else "")
        elif hit.part == "pin" and hit.port:
            words = _pin_words(now.context, hit.port, hit.output)
        elif hit.part == "title":
            box = scene.boxes[hit.key]
            words = "\n".join((*now.faults(hit.key), *now.warnings(hit.key))) or (box.layout.doc if box.layout else "")
        flags = int(imgui.HoveredFlags_.for_tooltip)
        if words and imgui.is_window_hovered(flags):
            imgui.set_tooltip(words)

    # --- around it ---------------------------------------------------------------------------------------------------

    def _around(self, brush: DrawContext, frame: CanvasFrame) -> None:
        asked, view = self._mouse.asked, self._context.canvas
        if asked.toggle:
            self._stage.expanded ^= {asked.toggle}
        if view.renaming or asked.rename:
            self._naming.begin(view.renaming or asked.rename)
            view.renaming = ""
        self._naming.draw(brush, self._mouse.dragged.scene)
        if self._context.store.current.minimap and self._mouse.dragged.scene.boxes:
            self._minimap.draw(brush, frame.panel, self._mouse.dragged.scene)
        self._legend.draw(brush, frame.panel)
        draw_crumbs(self._context, brush, frame.panel)
        if asked.menu:
            self._menus.begin(asked.menu, frame.at)
        self._menus.draw()
        if asked.search:
            self._search.begin(frame.at, *asked.search)
        elif view.searching:
            view.searching = False
            self._search.begin(view.pointer)
        elif view.replacing:
            self._search.begin_replacing(view.replacing)
            view.replacing = ""
        self._search.draw()


def _whole_window() -> Rect:
    """The window up to its borders, below its tab."""
    low, pos, size = imgui.get_cursor_screen_pos(), imgui.get_window_pos(), imgui.get_window_size()
    return low.x, low.y, pos.x + size.x, pos.y + size.y


def _grown(rect: Rect, by: float) -> Rect:
    return rect[0] - by, rect[1] - by, rect[2] + by, rect[3] + by


def _pin_words(context: CanvasContext, port: Port, output: bool) -> str:
    """What a socket takes or gives."""
    graph = context.session.graph
    found = context.log.attempt(lambda: graph.source(port) if output else graph.target(port))
    if found is None:
        return str(port)
    kind = getattr(found, "kind", None)
    return f"{port}  ({kind or 'value'})" + (f"\n{found.doc}" if found.doc else "")
