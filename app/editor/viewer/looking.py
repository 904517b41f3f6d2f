"""How the viewer displays a result: as a picture, or as data."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from halation.nodes import Kind
from msgspec.structs import replace

from ...color.display import to_display
from ...color.management import ColorManager, get_default_color_manager
from ...graph import OUTPUTS, Graph, Port
from ...media.comparison.data_range import Array, are_normals, balance_range, find_data_range
from ...renderer.viewing.look import Look
from .geometry import Sight, order_box
from .scopes import rgb_of
from .state import Background, Meaning, ViewerState

if TYPE_CHECKING:
    from ..theme.palette import RGB

Samples = Callable[[], Array]
"""Returns a small version of the picture; called only if it is needed."""


def choose_meaning(state: ViewerState, kind: Kind, samples: Samples) -> Meaning:
    """How to show a picture: the user's choice, or by its kind and numbers."""
    if state.meaning != "auto":
        return state.meaning
    if kind.is_color:
        return "image"
    if kind is Kind.VECTOR:
        return "normal" if are_normals(samples()) else "vector"
    return "field"


def choose_range(state: ViewerState, meaning: Meaning, samples: Samples) -> tuple[float, float]:
    """The numbers of data that are shown as black and as white."""
    if state.low != state.high:
        return state.low, state.high
    if meaning not in ("field", "vector"):
        return 0.0, 1.0
    low, high = find_data_range(samples())
    return balance_range(low, high) if meaning == "vector" else (low, high)


def measures(state: ViewerState, kind: Kind) -> bool:
    """True if the display depends on the numbers of the whole picture."""
    meaning = state.meaning
    if meaning == "auto":
        return kind is not Kind.IMAGE
    return meaning in ("field", "vector") and state.low == state.high


def choose_view(graph: Graph, port: Port, default: str = "") -> str:
    """The view that an output of the graph names, also for what is linked to it, for it is the same picture.

    Where none does, `default`: the one that suits the picture.
    """
    for name, output in graph.outputs.items():
        end = Port(OUTPUTS, name)
        if port in (end, graph.links.get(end)) and output.view:
            return output.view
    return default


def look_of(
    state: ViewerState,
    sight: Sight,
    meaning: Meaning,
    span: tuple[float, float],
    view: str,
    surround: RGB,
    manager: ColorManager | None = None,
) -> Look:
    """The look for the display.

    `span` is the range of data, `view` what the picture asks for, `manager` how its colors are managed.
    """
    region = None
    if state.region is not None:
        left, top, right, bottom = order_box(state.region)
        width, height = sight.picture
        region = (left * width, top * height, (right - left) * width, (bottom - top) * height)
    compare = state.compare if state.compare in ("wipe", "difference") else "off"
    compare = "b" if state.compare == "toggle" and state.toggled else compare
    gray = _GRAYS[state.background]
    return Look(
        zoom=sight.zoom,
        stretch=sight.stretch,
        pan=sight.pan,
        channels=state.channels,
        meaning="image" if meaning == "auto" else meaning,
        low=span[0],
        high=span[1],
        exposure=state.exposure,
        gamma=state.gamma,
        view=state.view or view,
        display=state.display,
        look=state.look,
        manager=manager or get_default_color_manager(),
        compare=compare,
        wipe=state.wipe,
        angle=state.wipe_angle,
        checker=state.background == "checker",
        background=(gray, gray, gray),
        clipping=state.warn_clipping,
        nonfinite=state.warn_nonfinite,
        region=region,
        surround=surround,
    )


def picture_only(look: Look) -> Look:
    """The look at the picture's own size, without overlays that only help to judge it."""
    return replace(look, zoom=1.0, stretch=1.0, pan=(0.0, 0.0), clipping=False, nonfinite=False, region=None)


def display_pixels(pixels: Array, look: Look) -> Array:
    """Pixels [h, w, channels] as the display shows them, [h, w, 3] of 0..1, transparency over black."""
    if look.meaning == "normal":
        return np.clip(rgb_of(pixels) * 0.5 + 0.5, 0.0, 1.0)
    if look.meaning != "image":
        return np.clip((rgb_of(pixels) - look.low) / max(look.high - look.low, 1e-6), 0.0, 1.0)
    lit = np.concatenate([rgb_of(pixels) * np.float32(2.0**look.exposure), _alpha(pixels)], axis=2)
    encoded = to_display(lit, look.view, bits=32, display=look.display, look=look.look, manager=look.manager)[..., :3]
    cover = np.where(lit[..., 3:] > 0.0, np.minimum(lit[..., 3:], 1.0), 1.0)  # color with an alpha of 0 adds light
    return np.clip(encoded, 0.0, 1.0) ** np.float32(1.0 / look.gamma) * cover


def _alpha(pixels: Array) -> Array:
    if pixels.shape[2] == 4:
        return np.nan_to_num(pixels[..., 3:].astype(np.float32), nan=1.0, posinf=1.0, neginf=0.0)
    return np.ones((*pixels.shape[:2], 1), np.float32)


_GRAYS: Mapping[Background, float] = MappingProxyType({"checker": 0.0, "black": 0.0, "gray": 0.5, "white": 1.0})
