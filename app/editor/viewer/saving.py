"""Saves the picture of the viewer as displayed, and takes small ones of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from halation.nodes import Kind
from msgspec.structs import replace

from ...color.transforms import decode_srgb
from ...language.translation import translate
from ...media import write_picture
from ..shared.dialogs import Browse
from .looking import picture_only

if TYPE_CHECKING:
    from ...authoring.preview import DisplayedImage
    from ...renderer.viewing.look import Look
    from .context import ViewerContext


_SNAPSHOT = (320, 180)
"""The largest size of a small picture, that of the pictures of the presets."""


def take_snapshot(context: ViewerContext, a: DisplayedImage, look: Look) -> np.ndarray:
    """The picture as displayed, in small: [h, w, 3] of uint8."""
    width, height = a.full_size
    zoom = min(_SNAPSHOT[0] / width, _SNAPSHOT[1] / height, 1.0)
    small = max(round(width * zoom), 1), max(round(height * zoom), 1)
    plain = replace(picture_only(look), zoom=zoom, compare="off")
    texture = context.display.draw("snapshot", small, a, None, plain)
    try:
        pixels = context.probe.read_region(texture, (0, 0, *small))[..., :3]
    finally:
        context.display.release_slot("snapshot")
    return (np.clip(pixels, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


def ask_to_save(context: ViewerContext, a: DisplayedImage, b: DisplayedImage | None, look: Look) -> None:
    """Draw the picture at its own size, and ask for a file."""
    width, height = a.full_size
    texture = context.display.draw("saved", (width, height), a, b, picture_only(look))
    try:
        pixels = context.probe.read_region(texture, (0, 0, width, height))[..., :3]
    finally:
        context.display.release_slot("saved")
    name = f"{context.session.name}.{a.port.node.rpartition('/')[2]}.png"
    context.dialogs.browse = Browse(
        translate("Save viewer picture"),
        "export",
        lambda path: context.log.attempt(lambda: _save(context, path, pixels)),
        saving=True,
        name=name,
    )


def _save(context: ViewerContext, path: Path, pixels: np.ndarray) -> None:
    """Display-referred pixels 0..1: decoded, so that the view of the file encodes them as they are."""
    write_picture(
        path,
        {"image": decode_srgb(pixels).astype(np.float32)},
        kinds={"image": Kind.IMAGE},
        view="none",
        sandbox=context.session.sandbox,
    )
    context.log.add(translate("saved {path}", path=path))
