"""The pixels that programs on the processor get and make, where pictures go on beyond their frame."""

from __future__ import annotations

from functools import reduce

import numpy as np

from ...compiler import Pass, Plan, Region, Surface
from .decoding import Array


def find_window(surface: Surface) -> Region:
    """The pixels of its picture that a surface holds."""
    return surface.window or Region.whole(surface.size)


def find_host_window(plan: Plan, render_pass: Pass) -> Region:
    """The pixels of all pictures of a program: those that any of them has, whatever is asked of its result."""
    frame = plan.surfaces[render_pass.targets[0]].frame_size
    surfaces = [plan.surfaces[number] for number in render_pass.textures]
    windows = [find_window(surface) for surface in surfaces if surface.frame_size == frame]
    return reduce(Region.union, windows, Region.whole(frame))


def cut_window(pixels: Array, window: Region, wanted: Region) -> Array:
    """The `wanted` pixels of a picture of which there are those of `window`; the others are 0."""
    if window == wanted:
        return pixels
    made = np.zeros((wanted.height, wanted.width, pixels.shape[2]), pixels.dtype)
    both = window.intersect(wanted)
    to, start = (both.x - wanted.x, both.y - wanted.y), (both.x - window.x, both.y - window.y)
    part = pixels[start[1] : start[1] + both.height, start[0] : start[0] + both.width]
    made[to[1] : to[1] + both.height, to[0] : to[0] + both.width] = part
    return made
