"""The pictures that the viewer requests from the preview."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...authoring.preview import VisibleRegion
from ...graph import INPUTS, Port
from ...renderer.viewing.look import fit_zoom
from .geometry import Sight
from .ground import depths
from .looking import measures

if TYPE_CHECKING:
    from .context import ViewerContext

A, B = "A", "B"


def layer(name: str) -> str:
    """The request name of a graph input."""
    return str(Port(INPUTS, name))


def effective_scale(context: ViewerContext) -> float:
    """The chosen proxy, or a coarser one: of large files, and while a value is dragged and pictures come too slowly."""
    viewer, session, region = context.viewer, context.session, find_visible_region(context)
    viewer.large_files.follow(session.root, session.bindings, context.preview.renderer.pictures)
    _, budget = context.preview.memory
    finest = min(viewer.proxy, viewer.large_files.choose_scale(_find_zoom(context), budget))
    share = region.share(finest) if region else 1.0
    return viewer.pace.at(finest, context.interface.dragging and context.store.current.proxy_while_dragging, share)


def _find_zoom(context: ViewerContext) -> float:
    """Pixels of the panel for one of the picture at scale 1, as far as both are known; else 0."""
    viewer, image = context.viewer, context.preview.find_visible_image(A)
    picture = image.full_size if image else viewer.large_files.size
    if viewer.zoom > 0.0 or not all((*viewer.panel, *picture)):
        return viewer.zoom
    return fit_zoom(viewer.panel, picture, viewer.stretch)


def list_wanted_ports(context: ViewerContext) -> tuple[dict[str, Port], float]:
    """The ports to compute, by name, and the scale to compute them at.

    These are A, B while comparing, every input of the graph while the pixel table is open, and depth for handles.
    """
    session, viewer = context.session, context.viewer
    ports = _sides(context)
    if viewer.table:
        ports |= {layer(name): Port(INPUTS, name) for name in session.graph.inputs}
    return ports | depths(context), effective_scale(context)


def find_visible_region(context: ViewerContext) -> VisibleRegion | None:
    """The visible region of A, and of B while comparing; None if the whole picture is needed.

    So it is while frames are played, which are kept for the next time, and where numbers of the whole picture say how
    it is shown.
    """
    viewer = context.viewer
    if viewer.zoom <= 0.0 or context.timeline.playing or context.timeline.scrubbing:
        return None
    sides = {side: context.preview.find_visible_image(side) for side in _sides(context)}
    for image in sides.values():
        if image is None or image.full_size != viewer.picture or measures(viewer, image.kind):
            return None
    sight = Sight.of((0.0, 0.0), viewer.panel, viewer.picture, viewer.zoom, viewer.pan, 1.0, viewer.stretch)
    (left, top), (right, bottom) = sight.fraction((0.0, 0.0)), sight.fraction(viewer.panel)
    left, top, right, bottom = max(left, 0.0), max(top, 0.0), min(right, 1.0), min(bottom, 1.0)
    if not sides or left >= right or top >= bottom:
        return None
    return VisibleRegion((left, top, right, bottom), viewer.picture, frozenset(sides))


def list_whole_sides(context: ViewerContext) -> frozenset[str]:
    """The pictures of which the viewer shows what lies beyond the frame as well."""
    return frozenset(_sides(context)) if context.viewer.overscan and has_overscan(context) else frozenset()


def has_overscan(context: ViewerContext) -> bool:
    """True if pictures of the document may go on beyond their frame."""
    return context.session.root.settings.overscan > 0.0


def _sides(context: ViewerContext) -> dict[str, Port]:
    sides = (A, B) if context.viewer.compares else (A,)
    return {side: port for side in sides if (port := context.session.views.find_port(side)) is not None}
