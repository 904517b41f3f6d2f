"""The pictures that the tasks take: the same on every machine. `inputs.py FOLDER WIDTHxHEIGHT [--still]` writes them.

`a`, `b`: half RGBA, premultiplied, with highlights up to 500 and soft holes. `depth`, `normal`, `velocity`: of balls on
a floor, seen from above it. `noise`: two channels of -1 to 1. `mask`: how much defocused, 0 to 1. Beside them the
frames of the sequence, unless only what stands still is wanted.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parents[1]))

from bench.exr import write
from bench.tasks import FRAMES, SEQUENCE, Lens, Occlusion, picture_path

Array = np.ndarray


def pixel_positions(width: int, height: int) -> tuple[Array, Array]:
    """Where the pixels are: across from 0 to the aspect ratio, down from 0 to 1."""
    down, across = np.mgrid[0:height, 0:width].astype(np.float32) + np.float32(0.5)
    return across / height, down / height


def make_noise(width: int, height: int, period: float, octaves: int, seed: int) -> Array:
    """Smooth value noise of -1 to 1; `period` is in pixels of a picture 1920 wide."""
    rng, total, weight = np.random.default_rng(seed), np.zeros((height, width), np.float32), 0.0
    for octave in range(octaves):
        cells = 2.0**octave * 1920.0 / period / width
        x, y = np.arange(width) * cells, np.arange(height) * cells
        grid = rng.uniform(-1.0, 1.0, (int(y[-1]) + 2, int(x[-1]) + 2)).astype(np.float32)
        i, j = x.astype(int), y.astype(int)
        s, t = ((part * part * (3.0 - 2.0 * part)).astype(np.float32) for part in (x - i, y - j))
        rows = grid[:, i] * (1.0 - s) + grid[:, i + 1] * s
        total += (rows[j] * (1.0 - t)[:, None] + rows[j + 1] * t[:, None]) * 0.5**octave
        weight += 0.5**octave
    return total / weight


def make_light(width: int, height: int, seed: int, shift: float = 0.0) -> Array:
    """A picture: a sky behind tiles and thin stripes, 160 lights, holes in its alpha. `shift` moves all but the sky."""
    x, y = pixel_positions(width, height)
    x, aspect = x + np.float32(shift), width / height
    rng = np.random.default_rng(seed)
    color = np.stack([0.15 + 0.5 * y, 0.25 + 0.35 * y, 0.55 - 0.25 * y], 2)
    color *= 0.75 + 0.25 * make_noise(width, height, 96.0, 5, seed + 7)[..., None]
    color *= np.where((np.floor(x * 14.0) + np.floor(y * 14.0)) % 2.0 == 0.0, 1.0, 0.45).astype(np.float32)[..., None]
    color += 0.6 * (np.abs(np.sin(x * 100.0 + y * 9.0)) > 0.985)[..., None]
    for _ in range(160):
        across, down, radius = rng.uniform(0.0, aspect), rng.uniform(), rng.uniform(0.0008, 0.006) * aspect
        tint = rng.uniform(0.3, 1.0, 3) * 10.0 ** rng.uniform(0.5, 2.7)
        _draw_disc(color, (across + shift) % aspect, down, radius, tint.astype(np.float32))
    alpha = np.ones((height, width), np.float32)
    for _ in range(12):
        across, down, radius = rng.uniform(0.0, aspect), rng.uniform(), rng.uniform(0.03, 0.12) * aspect
        apart = np.hypot(x - shift - across, y - down) / radius
        alpha *= np.clip(4.0 * (apart - 0.8), 0.0, 1.0)
    return np.dstack([color * alpha[..., None], alpha]).astype(np.float16)


def _draw_disc(color: Array, across: float, down: float, radius: float, tint: Array) -> None:
    """A small round light with a soft rim."""
    height, width = color.shape[:2]
    reach = 1.5 * radius
    left, right = max(0, int((across - reach) * height)), min(width, int((across + reach) * height) + 2)
    top, bottom = max(0, int((down - reach) * height)), min(height, int((down + reach) * height) + 2)
    y, x = np.mgrid[top:bottom, left:right].astype(np.float32) + np.float32(0.5)
    cover = np.clip(1.5 - np.hypot(x / height - across, y / height - down) / radius, 0.0, 1.0)[..., None]
    color[top:bottom, left:right] += cover * (tint - color[top:bottom, left:right])


def make_geometry(width: int, height: int) -> tuple[Array, Array, Array]:
    """Depth [h, w], normals [h, w, 3] and motion [h, w, 4], in pixels to the frame before and to the next one."""
    x, y = pixel_positions(width, height)
    rays = np.stack([2.0 * x - width / height, 1.0 - 2.0 * y, np.full_like(x, -Occlusion.focal)], 2) / Occlusion.focal
    near = np.where(rays[..., 1] < 0.0, -1.0 / np.minimum(rays[..., 1], -1e-4), 60.0)
    depth, normal = np.minimum(near, 60.0), np.zeros_like(rays)
    normal[..., 1] = 1.0
    motion, rng = np.zeros((height, width, 2)), np.random.default_rng(3)
    for _ in range(14):
        radius = rng.uniform(0.35, 1.0)
        center = np.array([rng.uniform(-4.0, 4.0), radius - 1.0, -rng.uniform(3.5, 12.0)])
        square, along = (rays * rays).sum(2), rays @ center
        inside = along * along - square * (center @ center - radius * radius)
        hit = (along - np.sqrt(np.maximum(inside, 0.0))) / square
        seen = ((inside > 0.0) & (hit > 0.0) & (hit < depth))[..., None]
        normal = np.where(seen, (rays * hit[..., None] - center) / radius, normal)
        depth = np.where(seen[..., 0], hit, depth)
        turn, speed = rng.uniform(0.0, 2.0 * np.pi), rng.uniform(5.0, 60.0) * width / 1920.0 * 4.0 / -center[2]
        motion = np.where(seen, speed * np.array([np.cos(turn), np.sin(turn)]), motion)
    return depth.astype(np.float32), normal.astype(np.float32), np.dstack([-motion, motion]).astype(np.float32)


def make_pictures(width: int, height: int) -> dict[str, Array]:
    """All that tasks take but the frames of the sequence, by name, as [height, width] or [height, width, channels]."""
    depth, normal, velocity = make_geometry(width, height)
    mask = np.clip(np.abs(depth - Lens.focus) / Lens.focus, 0.0, 1.0)
    return {
        "a": make_light(width, height, 1),
        "b": make_light(width, height, 42),
        "depth": depth,
        "normal": normal,
        "velocity": velocity,
        "mask": np.repeat(mask[..., None], 4, 2).astype(np.float16),
        "noise": np.dstack([make_noise(width, height, 128.0, 3, seed) for seed in (11, 12)]),
    }


def main() -> None:
    """Write the pictures and the frames into a folder that is there when all of them are."""
    folder, (width, height) = Path(sys.argv[1]), (int(side) for side in sys.argv[2].split("x"))
    unfinished = folder.with_name(f"{folder.name}.part")
    (unfinished / SEQUENCE).parent.mkdir(parents=True, exist_ok=True)
    for name, pixels in make_pictures(width, height).items():
        write(picture_path(unfinished, name), pixels)
    for frame in range(1, FRAMES + 1) if "--still" not in sys.argv else ():
        write(unfinished / SEQUENCE.format(frame), make_light(width, height, 1, 0.004 * frame))
    unfinished.rename(folder)


if __name__ == "__main__":
    main()
