"""Nodes that read other frames: they are given pictures as functions of the frame."""

from __future__ import annotations

from collections.abc import Callable
from math import exp, floor

import numpy as np

from .merge import screen
from .pixels import Array, join, mix

Clip = Callable[[int], Array]
"""A picture that changes with time: what it is at a frame."""


def frame_of(clip: Clip | None, frame: int, channels: int) -> Array:
    """A frame of a picture; zeros where nothing is linked."""
    return clip(frame) if clip else np.zeros((1, 1, channels))


def echo(image: Clip, frame: int, echoes: int, spacing: int, decay: float, mode: str) -> Array:
    """Earlier frames beside this one: echo k is the frame k spacing frames earlier, times decay^k.

    Behind and in front lay frames over each other by alpha (Porter and Duff 1984).
    """
    shown, total = image(frame), 1.0
    for number in range(1, echoes + 1):
        strength = decay**number
        fainter = strength * image(frame - number * spacing)
        total += strength
        if mode == "brightest":
            shown = np.maximum(shown, fainter)
        elif mode == "add":
            shown = join(shown[..., :3] + fainter[..., :3], np.minimum(shown[..., 3:] + fainter[..., 3:], 1.0))
        elif mode == "screen":
            shown = screen(shown, fainter)
        elif mode == "behind":
            shown = shown + (1.0 - shown[..., 3:]) * fainter
        elif mode == "in front":
            shown = fainter + (1.0 - fainter[..., 3:]) * shown
        elif mode == "average":
            shown = shown + fainter
    return shown / total if mode == "average" else shown


def frame_average(image: Clip, frame: int, frames: int, weights: str, window: str) -> Array:
    """The mean of several frames, weighted by their distance as a part of the window.

    If a centered window has an even number of frames, those at its two ends count half.
    """
    fall = {
        "box": lambda away: 1.0,
        "tent": lambda away: 1.0 - away,
        "gaussian": lambda away: exp(-0.5 * (3.0 * away) ** 2),
        "exponential": lambda away: exp(-3.0 * away),
    }[weights]
    reach = frames // 2
    if window == "trailing":
        shares = {-back: fall(back / frames) for back in range(frames)}
    else:
        shares = {offset: fall(2.0 * abs(offset) / (frames + 1)) for offset in range(-reach, reach + 1)}
        if frames % 2 == 0:
            shares[-reach], shares[reach] = 0.5 * shares[-reach], 0.5 * shares[reach]
    total = np.sum([share * image(frame + offset) for offset, share in shares.items()], axis=0)
    return total / sum(shares.values())


def freeze(
    frame: int,
    held: int,
    every: int,
    image: Clip | None = None,
    field: Clip | None = None,
    vector: Clip | None = None,
) -> tuple[Array, Array, Array]:
    """Hold one frame, or every nth one."""
    seen = held + (frame - held) // every * every if every else held
    return frame_of(image, seen, 4), frame_of(field, seen, 1), frame_of(vector, seen, 4)


def time_offset(
    frame: int, frames: int, image: Clip | None = None, field: Clip | None = None, vector: Clip | None = None
) -> tuple[Array, Array, Array]:
    """Show the frame that lies so many frames later."""
    seen = frame + frames
    return frame_of(image, seen, 4), frame_of(field, seen, 1), frame_of(vector, seen, 4)


def time_speed(
    frame: int,
    mode: str,
    speed: float,
    pivot: int,
    source: float,
    between: str,
    image: Clip | None = None,
    field: Clip | None = None,
    vector: Clip | None = None,
) -> tuple[Array, Array, Array]:
    """Play at another speed, or the frames that keys say. Halves of frames go to the later one."""
    seen = round(pivot + speed * (frame - pivot), 6) if mode == "speed" else round(source, 6)
    near, before = floor(seen + 0.5), floor(seen)
    if between == "blend" and seen > before:
        picture = mix(frame_of(image, before, 4), frame_of(image, before + 1, 4), seen - before)
    else:
        picture = frame_of(image, near, 4)
    return picture, frame_of(field, near, 1), frame_of(vector, near, 4)
