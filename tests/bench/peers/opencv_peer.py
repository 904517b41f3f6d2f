"""The tasks as a script with OpenCV: the fastest single operations on a CPU. `--list` says which.

OPENCV_FAST=1 blurs large pictures at a reduced size, as an expert would: less exact.
"""

from __future__ import annotations

import math
import os
import sys
from pathlib import Path

import cv2
import numpy as np

sys.path.append(str(Path(__file__).parents[2]))

from bench.peers.harness import main
from bench.tasks import LUMINANCE, PUSH, SIGMAS, Bloom, Lens, Reinhard, Ten, scale_length

Array = np.ndarray
EDGE = cv2.BORDER_REPLICATE
FAST = bool(os.environ.get("OPENCV_FAST"))


def exact(a: Array, sigma: float) -> Array:
    """A Gaussian blur out to four sigma."""
    side = 2 * math.ceil(4.0 * sigma) + 1
    return cv2.GaussianBlur(a, (side, side), sigma, sigmaY=sigma, borderType=EDGE)


def blur(a: Array, sigma: float) -> Array:
    """A Gaussian blur, of a smaller picture if it is to be fast."""
    factor = 1
    while FAST and sigma / factor > 6.0:
        factor *= 2
    if factor == 1:
        return exact(a, sigma)
    height, width = a.shape[:2]
    small = cv2.resize(a, (-(-width // factor), -(-height // factor)), interpolation=cv2.INTER_AREA)
    rest = math.sqrt(max(sigma**2 - (factor**2 - 1) / 12.0 - factor**2 / 6.0, 1.0)) / factor
    return cv2.resize(exact(small, rest), (width, height), interpolation=cv2.INTER_LINEAR)


def bloom(a: Array) -> Array:
    """T2."""
    bright = np.maximum(a - Bloom.threshold, 0.0)
    total = blur(bright, Bloom.sigmas[0])
    for sigma in Bloom.sigmas[1:]:
        total = cv2.add(total, blur(bright, sigma))
    return cv2.addWeighted(a, 1.0, total, Bloom.strength / 3.0, 0.0)


def tone_map(a: Array) -> Array:
    """T3."""
    light = cv2.transform(a, np.array([[*LUMINANCE, 0.0]], np.float32))
    factor = Reinhard.key / math.exp(cv2.mean(cv2.log(cv2.max(light, 0.0) + Reinhard.delta))[0])
    keyed = light * factor
    scale = cv2.divide(1.0 + keyed * (1.0 / Reinhard.white**2), 1.0 + keyed, scale=factor)
    return cv2.multiply(a, cv2.merge([scale, scale, scale, np.ones_like(scale)]))


def edges(a: Array) -> Array:
    """T4."""
    across, down = (cv2.Sobel(a, cv2.CV_32F, *way, ksize=3, borderType=EDGE) for way in ((1, 0), (0, 1)))
    flat = a.shape[0], -1
    found = cv2.magnitude(across.reshape(flat), down.reshape(flat)).reshape(a.shape)
    found[..., 3] = a[..., 3]
    return found


def colors(matrix: Array, offset: Array) -> Array:
    """What `cv2.transform` takes to change colors and keep alpha."""
    made = np.zeros((4, 5), np.float32)
    made[:3, :3], made[:3, 4], made[3, 3] = matrix, offset, 1.0
    return made


def ten(a: Array, b: Array) -> Array:
    """T5."""
    zero = np.zeros(3)
    color = cv2.transform(a, colors(np.eye(3) * Ten.exposure, zero))
    color = cv2.transform(color, colors(np.diag(Ten.gain), np.array(Ten.lift)))
    alpha = color[..., 3].copy()
    color = cv2.pow(cv2.max(color, 0.0), 1.0 / Ten.gamma)
    gray = np.tile(LUMINANCE, (3, 1))
    color = cv2.max(cv2.transform(color, colors(gray + Ten.saturation * (np.eye(3) - gray), zero)), 0.0)
    color = cv2.divide(color, cv2.add(color, (Ten.curve[1],) * 4), scale=Ten.curve[0])
    color[..., 3] = alpha
    soft = cv2.addWeighted(color, 1.0 - Ten.mix, blur(color, Ten.sigma), Ten.mix, 0.0)
    lines = edges(color)
    lines[..., 3] = 0.0
    drawn = cv2.scaleAdd(lines, Ten.edges, soft)
    return cv2.add(drawn, cv2.multiply(b, cv2.merge([1.0 - drawn[..., 3]] * 4)))


def displace(a: Array, noise: Array) -> Array:
    """T6."""
    height, width = a.shape[:2]
    x, y = np.meshgrid(np.arange(width, dtype=np.float32), np.arange(height, dtype=np.float32))
    push = scale_length(PUSH, width)
    across, down = cv2.scaleAdd(noise[..., 0], push, x), cv2.scaleAdd(noise[..., 1], push, y)
    return cv2.remap(a, across, down, cv2.INTER_LINEAR, borderMode=EDGE)


def blur_by_depth(a: Array, depth: Array) -> Array:
    """T8, as far as OpenCV goes: levels of blur mixed by the circle of confusion, without occlusion."""
    far, width = depth[..., 0], a.shape[1]
    circle = np.minimum(
        np.abs(far - Lens.focus) / far * scale_length(Lens.aperture, width), scale_length(Lens.largest, width)
    )
    levels = [a, *(exact(a, scale_length(sigma, width)) for sigma in (2.0, 4.0, 8.0))]
    place = np.clip(np.log2(np.maximum(circle, 1.0)), 0.0, 2.999)
    number = place.astype(np.int32)
    part, made = cv2.merge([place - number] * 4).astype(np.float32), np.empty_like(a)
    for level in range(3):
        here = number == level
        made[here] = levels[level][here] * (1.0 - part[here]) + levels[level + 1][here] * part[here]
    return made


WORKS = {name: lambda a, sigma=sigma: blur(a, sigma) for name, sigma in SIGMAS.items()}
WORKS |= {"T5": ten, "T10": ten}
if FAST:
    WORKS = {name: WORKS[name] for name in ("T1s10", "T5", "T10")}
else:
    WORKS |= {"copy": lambda a: a, "T2": bloom, "T3": tone_map, "T4": edges, "T6": displace, "T8": blur_by_depth}

if __name__ == "__main__":
    main(WORKS)
