"""What the tasks are to compute, in float64 with scipy. `references.py TASK FOLDER FILE` compares a file with that."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from scipy import ndimage

sys.path.append(str(Path(__file__).parents[1]))

from bench.exr import read
from bench.tasks import (
    FRAMES,
    GOLDEN_ANGLE,
    LUMINANCE,
    PUSH,
    SEQUENCE,
    SIGMAS,
    STEPS,
    TASKS,
    Bloom,
    Lens,
    Occlusion,
    Reinhard,
    Ten,
    picture_path,
    scale_length,
)

Array = np.ndarray


def blur(image: Array, sigma: float) -> Array:
    """A Gaussian blur; the border goes on outside."""
    across = ndimage.gaussian_filter1d(image, sigma, 1, mode="nearest", truncate=6.0)
    return ndimage.gaussian_filter1d(across, sigma, 0, mode="nearest", truncate=6.0)


def edges(color: Array) -> Array:
    """The length of Sobel's gradient, channel by channel."""
    change = [
        ndimage.correlate1d(
            ndimage.correlate1d(color, [-1, 0, 1], axis, mode="nearest"), [1, 2, 1], 1 - axis, mode="nearest"
        )
        for axis in (0, 1)
    ]
    return np.hypot(*change)


def bloom(a: Array) -> Array:
    """T2."""
    bright = np.maximum(a - Bloom.threshold, 0.0)
    return a + Bloom.strength / 3.0 * sum(blur(bright, sigma) for sigma in Bloom.sigmas)


def tone_map(a: Array) -> Array:
    """T3."""
    light = np.maximum(a[..., :3] @ np.array(LUMINANCE), 0.0)
    factor = Reinhard.key / np.exp(np.mean(np.log(Reinhard.delta + light)))
    keyed = factor * light
    scale = factor * (1.0 + keyed / Reinhard.white**2) / (1.0 + keyed)
    return np.dstack([a[..., :3] * scale[..., None], a[..., 3]])


def ten(a: Array, b: Array) -> Array:
    """T5."""
    color = Ten.exposure * a[..., :3] * np.array(Ten.gain) + np.array(Ten.lift)
    color = np.maximum(color, 0.0) ** (1.0 / Ten.gamma)
    gray = (color @ np.array(LUMINANCE))[..., None]
    color = np.maximum(gray + Ten.saturation * (color - gray), 0.0)
    color = Ten.curve[0] * color / (color + Ten.curve[1])
    graded = np.dstack([color, a[..., 3]])
    soft = graded + Ten.mix * (blur(graded, Ten.sigma) - graded)
    soft[..., :3] += Ten.edges * edges(color)
    return soft + (1.0 - soft[..., 3:]) * b


def displace(a: Array, noise: Array) -> Array:
    """T6."""
    height, width = a.shape[:2]
    y, x = np.mgrid[0:height, 0:width] + scale_length(PUSH, width) * np.moveaxis(noise[..., ::-1], 2, 0)
    return np.dstack([ndimage.map_coordinates(a[..., i], [y, x], order=1, mode="nearest") for i in range(4)])


def occlusion(depth: Array, normal: Array) -> Array:
    """T7."""
    depth, (height, width) = depth.reshape(depth.shape[:2]), depth.shape[:2]
    view = np.array([width / height, 1.0]) / Occlusion.focal
    y, x = np.mgrid[0:height, 0:width]
    turn = ((x * 73 ^ y * 151) & 255) * (np.pi / 128.0)

    def place(at: Array, down: Array) -> Array:
        far = depth[down, at]
        return np.dstack(
            [
                ((at + 0.5) / width * 2.0 - 1.0) * view[0] * far,
                (1.0 - (down + 0.5) / height * 2.0) * view[1] * far,
                -far,
            ]
        )

    center, hidden = place(x, y), np.zeros(depth.shape)
    for i in range(Occlusion.samples):
        part = (i + 0.5) / Occlusion.samples
        away = scale_length(Occlusion.radius, width) * part * np.exp(1j * (turn + i * GOLDEN_ANGLE))
        at = np.clip(x + np.trunc(away.real).astype(int), 0, width - 1)
        apart = place(at, np.clip(y + np.trunc(away.imag).astype(int), 0, height - 1)) - center
        square = (apart * apart).sum(2)
        rise = np.maximum((apart * normal).sum(2) - Occlusion.bias * depth, 0.0)
        hidden += np.where(square < Occlusion.reach**2, rise / (square + 1e-3), 0.0)
    return np.maximum(1.0 - 2.0 * hidden * Occlusion.reach / Occlusion.samples, 0.0)[..., None]


def blur_by_depth(a: Array, depth: Array) -> Array:
    """T8."""
    height, width = a.shape[:2]
    depth, largest = depth.reshape(height, width, 1), scale_length(Lens.largest, width)
    circles = np.minimum(np.abs(depth - Lens.focus) / depth * scale_length(Lens.aperture, width), largest)
    y, x = np.mgrid[0:height, 0:width]
    total, weights = a.copy(), np.ones_like(depth)
    for i in range(1, Lens.samples):
        radius = np.sqrt(i / Lens.samples) * largest
        away = radius * np.exp(1j * i * GOLDEN_ANGLE)
        there = np.clip(y + int(away.imag), 0, height - 1), np.clip(x + int(away.real), 0, width - 1)
        circle = np.where(depth[there] > depth, np.minimum(circles[there], 2.0 * circles), circles[there])
        weight = np.clip(circle - radius + 0.5, 0.0, 1.0)
        total, weights = total + weight * a[there], weights + weight
    return total / weights


def blur_by_motion(a: Array, velocity: Array) -> Array:
    """T9."""
    height, width = a.shape[:2]
    y, x = np.mgrid[0:height, 0:width]
    total = np.zeros_like(a)
    for i in range(STEPS):
        away = np.round(velocity[..., 2:] * ((i + 0.5) / STEPS - 0.5)).astype(int)
        total += a[np.clip(y + away[..., 1], 0, height - 1), np.clip(x + away[..., 0], 0, width - 1)]
    return total / STEPS


def render_reference(task: str, pictures: Mapping[str, Array]) -> Array:
    """What a task makes of its pictures [height, width, channels], in float64."""
    arrays = [pictures[name].astype(np.float64) for name in TASKS[task].inputs]
    if task in SIGMAS:
        return blur(arrays[0], SIGMAS[task])
    functions = {
        "copy": lambda a: a,
        "T2": bloom,
        "T3": tone_map,
        "T4": lambda a: np.dstack([edges(a[..., :3]), a[..., 3]]),
        "T5": ten,
        "T5_catalogue": ten,
        "T10": ten,
        "T6": displace,
        "T7": occlusion,
        "T8": blur_by_depth,
        "T9": blur_by_motion,
    }
    return functions[task](*arrays)


def compare_pictures(pixels: Array, expected: Array) -> dict[str, float]:
    """How far off: RMS as a part of the reference's, and the largest difference as a part of its largest number."""
    apart = pixels[..., : expected.shape[2]].astype(np.float64) - expected
    return {
        "rms": float(np.sqrt(np.mean(apart**2) / np.mean(expected**2))),
        "peak": float(np.abs(apart).max() / np.abs(expected).max()),
    }


def main() -> None:
    """Print how far a file is off as JSON. Of T10 it is the last frame."""
    task, folder, file = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
    arrays = {name: read(picture_path(folder, name)) for name in TASKS[task].inputs}
    if task == "T10":
        arrays["a"] = read(folder / SEQUENCE.format(FRAMES))
    print(json.dumps(compare_pictures(read(file), render_reference(task, arrays))))


if __name__ == "__main__":
    main()
