"""The keyer, which joins what keys and mattes do."""

from __future__ import annotations

import numpy as np

from .blur import blur_gaussian
from .matte import dilate_erode, screen_channel, screen_excess
from .pixels import Array, join, rgb


def keyer(
    image: Array,
    screen: tuple[float, ...],
    balance: float,
    black: Array | float,
    white: Array | float,
    shrink: float,
    soften: float,
    spill: Array | float,
    spill_balance: float,
    clean_plate: Array | None = None,
    core: Array | float = 0.0,
    garbage: Array | float = 0.0,
) -> tuple[Array, Array]:
    """Cut out a subject in front of a screen by color difference (Vlahos 1964): the subject, and its coverage.

    The matte is cut off below black and above white, made smaller and softer, and joined with mattes of what is solid
    (core) and what is removed (garbage). Then the screen is subtracted, and the light that it throws on the subject.
    """
    color, alpha, channel = image[..., :3], image[..., 3:], screen_channel(rgb(screen))
    plate = rgb(screen)[None, None] if clean_plate is None else clean_plate[..., :3]
    seen = screen_excess(color, channel, balance) / np.maximum(screen_excess(plate, channel, balance), 1e-6)
    cover = np.clip((1.0 - seen - black) / np.maximum(np.subtract(white, black), 1e-6), 0.0, 1.0)
    cover = blur_gaussian(dilate_erode(cover, -shrink, "circle", "clamp"), soften, "clamp")
    cover = np.maximum(cover, np.clip(core, 0.0, 1.0)) * (1.0 - np.clip(garbage, 0.0, 1.0))
    subject = color - (1.0 - cover) * plate
    excess = spill * np.maximum(screen_excess(subject, channel, spill_balance), 0.0)
    subject = subject - excess * np.eye(3)[channel]
    subject = np.where(cover > 0.0, np.maximum(subject, np.minimum(color, 0.0)), 0.0)
    return join(subject, cover * alpha), cover * np.clip(alpha, 0.0, 1.0)
