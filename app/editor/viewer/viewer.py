"""The Viewer panel: the toolbar, the picture, and the info line."""

from __future__ import annotations

from typing import TYPE_CHECKING

from halation.nodes import Kind, Plain
from imgui_bundle import imgui
from msgspec import Struct
from msgspec.structs import replace

from ...authoring.commands import SetValue
from ...graph import OUTPUTS, Port
from ...language.translation import translate, translate_plural
from ...renderer.viewing.look import Look
from ..shared.coloring import find_color_manager
from ..theme.style import u32, ui_scale
from ..toolkit.keys import display_shortcut
from . import infobar
from .banner import draw_banner
from .brush_bar import draw_brush_bar
from .finding import InvalidPixelSearch
from .focus import is_distance
from .geometry import Sight, share_height
from .ground import depth_at
from .hand import ViewerInput
from .handles import pixel_place, takes_position
from .looking import choose_meaning, choose_range, choose_view, look_of
from .mattes import picks
from .measuring import format_pixel, format_pixel_number, make_opaque_color
from .orbit import find_orbit_node
from .overlays import draw_badge, draw_message, draw_outline, draw_overlays, draw_progress
from .pacing import PictureTimer
from .played_pictures import STILL, PlayedPictures
from .reading import Scan, ValueReader
from .saving import ask_to_save, take_snapshot
from .strokes import draw_label
from .table import draw_table
from .toolbar import context_menu, draw_toolbar
from .wanted import A, B

if TYPE_CHECKING:
    from ...authoring.preview import DisplayedImage
    from .context import ViewerContext

_NOTICED_SECONDS = 0.12
"""How long a render may take before the viewer says so: shorter waits are hardly noticed. Chosen by judgement."""

TABLE_LINES = 7
"""The lines of the pixel table, always the same: otherwise the picture would move under the pointer."""
READING = 0.2
"""Seconds between two readings of values during playback."""

_CATCH = (
    int(imgui.ButtonFlags_.mouse_button_left)
    | int(imgui.ButtonFlags_.mouse_button_middle)
    | int(imgui.ButtonFlags_.mouse_button_right)
)


class _FrameImages(Struct, frozen=True):
    """The pictures of this frame."""

    a: DisplayedImage | None
    b: DisplayedImage | None
    view: str
    """The requested view of the picture."""

    @property
    def is_whole(self) -> bool:
        """True unless only a part of the picture is ready."""
        return not any(image is not None and image.partial for image in (self.a, self.b))

    def is_beside(self, context: ViewerContext) -> bool:
        """True if B is shown to the right of A."""
        return context.viewer.compare == "beside" and self.a is not None and self.b is not None


class Viewer:
    """Draws what `editor.viewer` says of what the session views."""

    def __init__(self, context: ViewerContext) -> None:
        self._context = context
        self._hand = ViewerInput(context)
        self._reader = ValueReader()
        self._scan = Scan()
        self._values: dict[str, tuple[float, ...]] = {}
        """The values under the pointer that were read last."""
        self._next_reading = 0.0
        self._finder = InvalidPixelSearch(context)
        self._watch = PictureTimer()
        self._played = PlayedPictures(context.display)
        self._seconds = 0.0
        self._busy_since: float | None = None
        self._search = 0
        self._right = False
        """True if the mouse is over B, beside A."""

    def draw(self) -> None:
        """Draw into the current window."""
        viewer, preview = self._context.viewer, self._context.preview
        port, a = self._context.session.views.find_port("A"), preview.find_visible_image(A)
        b = preview.find_visible_image(B) if viewer.compares else None
        view = choose_view(self._context.session.graph, port, a.default_view if a else "") if port else ""
        images = _FrameImages(a, b, view)
        viewer.scene = find_orbit_node(self._context.session)
        self._time(images)
        inner, pad = imgui.internal.get_current_window().inner_rect, 4 * ui_scale()
        imgui.set_cursor_screen_pos((inner.min.x + pad, inner.min.y + pad))
        draw_banner(self._context)
        draw_toolbar(self._context, images.view, images.a is not None and images.a.kind in (Kind.FIELD, Kind.VECTOR))
        draw_brush_bar(self._context)
        imgui.push_style_var(imgui.StyleVar_.item_spacing, (0.0, 0.0))
        try:
            self._draw_panel(images)
        finally:
            imgui.pop_style_var()
        context_menu(self._context)
        self._context.log.attempt(lambda: self._finder.step())

    # --- parts -------------------------------------------------------------------------------------------------------

    def _draw_panel(self, images: _FrameImages) -> None:
        viewer, scale = self._context.viewer, ui_scale()
        inner = imgui.internal.get_current_window().inner_rect
        start = inner.min.x, imgui.get_cursor_screen_pos().y + 3 * scale
        imgui.set_cursor_screen_pos(start)
        lines = 2 if images.b is not None else 1
        below = infobar.row_height() * lines
        row = imgui.get_text_line_height() + 2 * imgui.get_style().cell_padding.y
        table = row * TABLE_LINES if viewer.table else 0.0
        width, room = inner.max.x - start[0], inner.max.y - start[1]
        height, table = share_height(room, below, table)
        sight = self._catch(images, (max(width, 32.0), height))
        look = self._draw_picture(images, sight)
        self._draw_messages(images, sight)
        self._read(images, sight, look)
        if viewer.table:
            draw_table(self._context, self._reader, table)

    def _catch(self, images: _FrameImages, size: tuple[float, float]) -> Sight:
        """The sight of A after mouse and wheel were handled."""
        viewer, a, across = self._context.viewer, images.a, 2 if images.is_beside(self._context) else 1
        start = imgui.get_cursor_screen_pos()
        density = imgui.get_io().display_framebuffer_scale.x or 1.0
        origin = round(start.x), round(start.y)
        viewer.panel = round(size[0] * density) // across, round(size[1] * density)
        viewer.picture, viewer.pixel_aspect = (a.full_size, a.pixel_aspect) if a is not None else ((1, 1), 1.0)
        imgui.set_next_item_allow_overlap()
        imgui.invisible_button("##picture", size, _CATCH)
        self._context.places["viewer panel"] = (origin[0], origin[1], origin[0] + size[0], origin[1] + size[1])

        def sight() -> Sight:
            return Sight.of(origin, viewer.panel, viewer.picture, viewer.zoom, viewer.pan, density, viewer.stretch)

        if not imgui.is_item_active():
            self._right = across == 2 and imgui.get_mouse_pos().x >= origin[0] + viewer.panel[0] / density
        if a is not None:
            self._hand.follow(self._find_hovered_sight(sight()))
            self._context.places["viewer image"] = sight().rectangle((0.0, 0.0, 1.0, 1.0))
        else:
            viewer.hovered = imgui.is_item_hovered()
        return sight()

    def _find_hovered_sight(self, sight: Sight) -> Sight:
        """The sight of the picture under the mouse: A or B."""
        if not self._right:
            return sight
        return replace(sight, origin=(sight.origin[0] + sight.panel[0] / sight.density, sight.origin[1]))

    def _draw_picture(self, images: _FrameImages, sight: Sight) -> Look:
        """Draw A, with B beside it or over it, and the overlays; returns how they are shown."""
        viewer, palette = self._context.viewer, self._context.palette
        if images.a is None:
            look = Look(surround=palette.surround)
        else:
            toggled = viewer.compare == "toggle" and viewer.toggled
            name, image = (B, images.b) if toggled and images.b is not None else (A, images.a)

            def samples():
                return self._reader.read_small(
                    self._context.probe, self._context.preview.find_whole_image(name) or image
                )

            meaning = choose_meaning(viewer, image.kind, samples)
            viewer.span = choose_range(viewer, meaning, samples) if image.kind is not Kind.NUMBER else (0.0, 1.0)
            look = look_of(
                viewer, sight, meaning, viewer.span, images.view, palette.surround, find_color_manager(self._context)
            )
        slot = self._choose_slot(images, sight.panel)
        texture = self._context.log.attempt(
            lambda: self._context.display.draw(slot, sight.panel, images.a, images.b, look)
        )
        if texture is None:  # the config has no such view
            viewer.view = viewer.display = viewer.look = ""
            return look
        lines, (x, y) = imgui.get_window_draw_list(), sight.origin
        corner = x + sight.panel[0] / sight.density, y + sight.panel[1] / sight.density
        lines.add_image(imgui.ImTextureRef(texture.native_handle), (x, y), corner)
        if images.is_beside(self._context):
            second_texture = self._context.display.draw("viewer beside", sight.panel, images.b, None, look)
            lines.add_image(
                imgui.ImTextureRef(second_texture.native_handle), (corner[0], y), (2 * corner[0] - x, corner[1])
            )
            lines.add_line((corner[0], y), corner, u32(palette.border), ui_scale())
            for name, left in ((A, x), (B, corner[0])):
                draw_label(lines, (left + 18 * ui_scale(), y + 18 * ui_scale()), name)
        else:
            self._context.display.release_slot("viewer beside")
        if images.a is not None:
            lines.push_clip_rect((x, y), corner, True)
            if images.a.reaches_beyond:
                draw_outline(self._context, sight)
            draw_overlays(self._context, sight)
            lines.pop_clip_rect()
        self._save(images, look)
        return look

    def _choose_slot(self, images: _FrameImages, size: tuple[int, int]) -> str:
        """The slot of the display for the pictures of this frame."""
        if not self._context.preview.skims or images.a is None:
            self._played.clear()
            return STILL
        contents = images.a.key, images.b.key if images.b is not None else ""
        return self._played.choose_slot(contents, size, self._context.preview.memory[1])

    def _save(self, images: _FrameImages, look: Look) -> None:
        """Take the snapshot or save the picture that the user asked for.

        Both wait until the whole picture is there: a part of it would be saved as if it were all.
        """
        viewer, log, a = self._context.viewer, self._context.log, images.a
        if not images.is_whole:
            return
        if viewer.snapshot is not None and a is not None:
            take, viewer.snapshot = viewer.snapshot, None
            log.attempt(lambda: take(take_snapshot(self._context, a, look)))
        if viewer.saving and a is not None:
            log.attempt(lambda: ask_to_save(self._context, a, images.b, look))
        viewer.saving = False

    def _draw_messages(self, images: _FrameImages, sight: Sight) -> None:
        """Draw at most one message over the picture, the most urgent one, then the value or the progress.

        A short wait shows no progress: it would flash with every change.
        """
        preview, palette, viewer = self._context.preview, self._context.palette, self._context.viewer
        fault = preview.fault(A) or (preview.fault(B) if viewer.compares else None)
        if fault and images.a is None and fault not in preview.faults.values():  # the user has to choose something
            draw_message(self._context, sight, fault[:1].upper() + fault[1:], palette.dim)
        elif fault and (images.a is None or preview.faults.get(self._context.code.fault_path) != fault):
            draw_message(self._context, sight, fault, palette.error, dim=images.a is not None)
        elif images.a is None and not preview.busy:
            draw_message(self._context, sight, self._hint(), palette.dim)
        elif viewer.compares and self._context.session.views.find_port("B") is None:
            keys = display_shortcut(self._context.actions.shortcut("node.view_b"))
            sentence = translate("B shows nothing: choose it above, or press {keys} on a node", keys=keys)
            draw_badge(self._context, sight, sentence, palette.warning)
        elif viewer.picking:
            draw_badge(self._context, sight, translate("Click to pick. Right click cancels"), palette.accent)
        elif viewer.drawing_region:
            draw_badge(self._context, sight, translate("Drag a rectangle"), palette.accent)
        elif picks(self._context):
            draw_badge(self._context, sight, translate("Click objects to pick them"), palette.accent)
        elif viewer.finding:
            self._search += 1
            dots = 3 if self._context.store.current.reduced_motion else self._search // 8 % 4
            draw_badge(self._context, sight, f"{translate('Searching')}{'.' * dots}", palette.accent)
        elif self._scan.wrong and viewer.warn_nonfinite:
            self._offer_search(sight)
        if images.a is not None and not fault and images.a.kind.is_single:
            values = self._reader.read_pixel(self._context.probe, "single", images.a, (0, 0))
            draw_message(self._context, sight, "  ".join(format_pixel_number(value) for value in values), palette.text)
        waited = imgui.get_time() - self._busy_since if self._busy_since is not None else 0.0
        if waited > _NOTICED_SECONDS and not preview.paused:
            finished, total = preview.progress
            draw_progress(self._context, sight, finished / total if total else 0.0)

    def _offer_search(self, sight: Sight) -> None:
        count = self._scan.wrong
        text = translate_plural(
            "{count} pixel NaN or infinite: find the source", "{count} pixels NaN or infinite: find the source", count
        )
        box = draw_badge(self._context, sight, text, self._context.palette.error)
        back = imgui.get_cursor_screen_pos()
        imgui.set_cursor_screen_pos(box[:2])
        if imgui.invisible_button("##find", (box[2] - box[0], box[3] - box[1])):
            self._context.actions.run("viewer.find_nonfinite")
        if imgui.is_item_hovered():
            imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
        self._context.places["viewer find"] = box
        imgui.set_cursor_screen_pos(back)
        imgui.dummy((0, 0))

    def _read(self, images: _FrameImages, sight: Sight, look: Look) -> None:
        """Draw the values under the pointer below the picture.

        The search for invalid pixels runs only while nothing is computed or dragged, because it reads back the whole
        picture, part by part. During playback both read five times a second: each waits for the device (13 ms).
        """
        viewer, time_now, mouse = self._context.viewer, imgui.get_time(), imgui.get_mouse_pos()
        under, before = self._find_hovered_sight(sight).under((mouse.x, mouse.y)), viewer.pixel
        viewer.pixel = under if viewer.hovered and images.a is not None else None
        is_used = viewer.pixel != before or viewer.copying or bool(viewer.picking)
        is_due = is_used or not self._context.preview.skims or time_now >= self._next_reading
        self._next_reading = time_now + READING if is_due else self._next_reading
        for name, image in ((A, images.a), (B, images.b)):
            if name == B and image is None:
                continue
            values: tuple[float, ...] = ()
            if image is not None and viewer.pixel is not None:
                if is_due:
                    self._values[name] = self._reader.read_pixel(self._context.probe, name, image, viewer.pixel)
                values = self._values.get(name, ())
            words = infobar.about(self._context, name, image, sight, self._seconds)
            if image is not None:
                words += infobar.of_pixel(self._context, viewer.pixel, values, image.kind, look)
            infobar.draw_line(self._context, f"viewer info {name}", words)
            if name == A and values:
                self._use(values)
        viewer.copying = False
        if self._context.preview.skims:  # a picture that is gone in a moment
            self._scan.step(self._context.probe, None)
        elif is_due and viewer.warn_nonfinite and not (self._context.preview.busy or self._context.interface.dragging):
            self._scan.step(self._context.probe, images.a)

    def _use(self, values: tuple[float, ...]) -> None:
        """Copy or pick the values of A under the pointer."""
        viewer = self._context.viewer
        assert viewer.pixel is not None
        if viewer.copying:
            port = self._context.session.views.find_port("A")
            self._context.clipboard.put(format_pixel(str(port), viewer.pixel, values))
            self._context.log.add(translate("copied {x}, {y}", x=viewer.pixel[0], y=viewer.pixel[1]))
        if self._hand.picked_point is not None and viewer.picking:
            port = Port.parse(viewer.picking)
            picked_value = self._convert_pick(port, values)
            if picked_value is not None:
                self._context.log.attempt(
                    lambda: self._context.session.apply(SetValue(port, picked_value, merge=f"pick {port}"))
                )
            if not imgui.is_mouse_down(imgui.MouseButton_.left):
                self._context.session.seal()
                viewer.picking = ""

    def _convert_pick(self, port: Port, values: tuple[float, ...]) -> Plain | None:
        """The new number of a value after a click on the picture: a position, a depth or a color; None if unknown."""
        viewer = self._context.viewer
        if takes_position(self._context.session, port):
            return pixel_place(viewer)
        if not is_distance(port):
            return make_opaque_color(values)
        depth = depth_at(self._context, pixel_place(viewer))
        return None if depth is None else float(f"{depth:.7g}")

    def _hint(self) -> str:
        port = self._context.session.views.find_port("A")
        if port is not None and port.node == OUTPUTS:
            return translate("Nothing is linked to the output '{socket}' yet.", socket=port.socket)
        keys = display_shortcut(self._context.actions.shortcut("node.add"))
        return translate("Nothing to show yet: add a node ({keys} over the graph), or drop a picture here.", keys=keys)

    def _time(self, images: _FrameImages) -> None:
        """Measure how long pictures take, for the info line and the proxy of drags."""
        preview, moment = self._context.preview, imgui.get_time()
        busy = preview.busy and not preview.completing
        if busy:
            self._busy_since = moment if self._busy_since is None else self._busy_since
        else:
            self._busy_since = None
        key = f"{images.a.key} {images.a.revision}" if images.a is not None else ""
        seconds = self._watch.lap(busy and not preview.paused, key, moment)
        if seconds is not None and images.a is not None:
            self._seconds = seconds
            self._context.viewer.pace.took(images.a.scale, seconds, images.a.share)
