"""Picking objects of a cryptomatte by clicking on the picture, while a node that picks some is active."""

from __future__ import annotations

from typing import TYPE_CHECKING

from halation.nodes import Matte, float_bits, pick_ids, toggle_name
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui
from msgspec import Struct

from ...authoring.commands import SetValue
from ...graph import Port
from ...language.translation import translate
from ...render_layers.mattes import IdMap
from ..shared.render_facts import matte_at, pick_value, render_file
from ..theme.style import u32, ui_scale

if TYPE_CHECKING:
    from .context import ViewerContext
    from .geometry import Point, Sight


class MatteHit(Struct, frozen=True):
    """The object under the pointer: its id, and its name if the file has one; `on` if it is picked."""

    port: Port
    matte: Matte
    id: int
    name: str
    on: bool

    @property
    def words(self) -> str:
        """The text of the label."""
        if not self.name:
            return translate("id {id:08x}: the file has no name for it", id=self.id)
        return f"{icons.ICON_FA_CHECK}  {self.name}" if self.on else self.name


def picks(context: ViewerContext) -> Port | None:
    """The list of names that a click changes: that of the active node, if its file has a cryptomatte."""
    session = context.session
    value = pick_value(session.graph.nodes.get(session.active))
    if value is None or not isinstance(matte_at(context, session.active), Matte):
        return None
    return Port(session.active, value.name)


def find_matte_hit(context: ViewerContext, sight: Sight, at: Point) -> MatteHit | None:
    """The object that a click would pick; None for nothing, and while the file is being read."""
    port = picks(context)
    file = render_file(context.session.graph, port.node) if port else None
    matte = matte_at(context, port.node) if port else None
    if port is None or file is None or not isinstance(matte, Matte) or sight.under(at) is None:
        return None
    id_map = context.renders.ids(file, matte)
    id = id_map.id_at(*sight.fraction(at)) if isinstance(id_map, IdMap) else 0
    if not id or not isinstance(id_map, IdMap):
        return None
    name = id_map.names.get(id, "")
    alone = {name: matte.ids[name]} if name in matte.ids else {}
    on = bool(alone) and float_bits(matte.ids[name]) in pick_ids(str(context.session.graph.value(port)), alone)
    return MatteHit(port, matte, id, name if alone else "", on)


def click(context: ViewerContext, sight: Sight, at: Point) -> None:
    """Pick the object under the mouse, or unpick it, as one step."""
    hit = find_matte_hit(context, sight, at)
    if hit is None:
        return
    if not hit.name:
        context.log.add(translate("the file has no name for the id {id:08x}: it cannot be picked by name", id=hit.id))
        return
    session = context.session
    pick = toggle_name(str(session.graph.value(hit.port)), hit.name, hit.matte.ids)
    context.log.attempt(lambda: session.apply(SetValue(hit.port, pick)))


def draw_name(context: ViewerContext, sight: Sight) -> None:
    """Draw the name of the object under the pointer."""
    if not context.viewer.hovered or picks(context) is None:
        return
    mouse, scale = imgui.get_mouse_pos(), ui_scale()
    hit = find_matte_hit(context, sight, (mouse.x, mouse.y))
    if hit is None:
        return
    size, pad = imgui.calc_text_size(hit.words), 6.0 * scale
    right = sight.origin[0] + sight.panel[0] / sight.density
    bottom = sight.origin[1] + sight.panel[1] / sight.density
    left = min(mouse.x + 14.0 * scale, right - size.x - 3.0 * pad)
    top = mouse.y + 18.0 * scale
    top = top if top + size.y + 2.0 * pad < bottom else mouse.y - size.y - 2.0 * pad
    box = round(left), round(top), round(left + size.x + 2.0 * pad), round(top + size.y + pad)
    lines = imgui.get_window_draw_list()
    lines.add_rect_filled(box[:2], box[2:], u32((0.0, 0.0, 0.0), 0.75), 4.0 * scale)
    edge = context.palette.accent if hit.on else (1.0, 1.0, 1.0)
    lines.add_rect(box[:2], box[2:], u32(edge, 0.9 if hit.on else 0.25), 4.0 * scale)
    ink = (1.0, 1.0, 1.0) if hit.name else (0.75, 0.75, 0.75)
    lines.add_text((round(left + pad), round(top + pad / 2)), u32(ink), hit.words)
    context.places["matte name"] = box
