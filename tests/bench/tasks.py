"""The tasks of the benchmark: what each one computes, of which pictures, and with which numbers.

Every program that is measured takes its numbers from here. It imports the standard library alone, since what starts
the programs has to stay small: the memory that a process had when it started another one counts as that one's.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from random import Random
from types import MappingProxyType
from typing import Any

SIZES: Mapping[str, tuple[int, int]] = MappingProxyType(
    {
        "tiny": (96, 54),
        "small": (480, 270),
        "hd720": (1280, 720),
        "hd": (1920, 1080),
        "qhd": (2560, 1440),
        "uhd": (3840, 2160),
    }
)
FRAMES = 24
PICTURES = 1
"""The version of the pictures: goes up when they change."""
LUMINANCE = (0.2126, 0.7152, 0.0722)
GOLDEN_ANGLE = 2.399963

SEED = "HALATION_BENCH_SEED"
"""The environment variable that all programs inherit: with a seed, some numbers are others than those below."""
_SPREAD = 0.25
"""By how many powers of two a number differs at most. With more, the tasks would no longer be as much work."""


def vary(name: str, number: float) -> float:
    """The number itself, or with a seed one near it, which depends on the seed and the name alone."""
    seed = os.environ.get(SEED)
    return round(number * 2.0 ** Random(f"{seed} {name}").uniform(-_SPREAD, _SPREAD), 3) if seed else number


SIGMAS: Mapping[str, float] = MappingProxyType(
    {"T1s3": vary("T1s3", 3.0), "T1s10": vary("T1s10", 10.0), "T1s50": vary("T1s50", 50.0)}
)


@dataclass(frozen=True)
class Bloom:
    """T2: `image + strength / 3 * (the sum of three blurs of max(image - threshold, 0))`."""

    threshold: float = 1.0
    sigmas: tuple[float, float, float] = (vary("narrow", 4.0), vary("middle", 16.0), vary("wide", 64.0))
    strength: float = 0.5


@dataclass(frozen=True)
class Reinhard:
    """T3: luminance `l` becomes `k (1 + k / white^2) / (1 + k)` with `k = key l / exp(mean(log(delta + l)))`."""

    key: float = 0.18
    white: float = 4.0
    delta: float = 1e-4


@dataclass(frozen=True)
class Ten:
    """T5: ten nodes on the numbers of `a`, alpha left alone, then over `b`.

    Exposure, gain and lift, gamma (`x^(1/gamma)`), saturation, the curve `c x / (x + d)`; of that a blur, their mix
    and the Sobel edges, which are added; over.
    """

    exposure: float = 2.0 ** vary("stops", 0.5)
    gain: tuple[float, float, float] = (1.1, 1.0, 0.9)
    lift: tuple[float, float, float] = (0.01, 0.005, 0.02)
    gamma: float = 1.2
    saturation: float = vary("saturation", 1.3)
    curve: tuple[float, float] = (1.6, 0.6)
    sigma: float = vary("T5", 10.0)
    mix: float = vary("mix", 0.35)
    edges: float = 0.25


@dataclass(frozen=True)
class Occlusion:
    """T7: obscurance from 16 points of a spiral, lengths in pixels of a picture 1920 wide."""

    samples: int = 16
    radius: float = vary("radius", 24.0)
    reach: float = 0.6
    bias: float = 0.02
    focal: float = 1.4


@dataclass(frozen=True)
class Lens:
    """T8: depth of field gathered from 47 points of a disc, lengths in pixels of a picture 1920 wide."""

    focus: float = 6.0
    aperture: float = vary("aperture", 40.0)
    largest: float = vary("largest", 16.0)
    samples: int = 48


PUSH = vary("push", 20.0)
"""T6: how many pixels the noise pushes the picture, of one 1920 wide."""
STEPS = 16
"""T9: how many pixels along the motion are averaged."""


def scale_length(length: float, width: int) -> float:
    """A length in pixels of a picture 1920 wide, in one of this width."""
    return length * width / 1920.0


@dataclass(frozen=True)
class Task:
    """A task: its title, the pictures it takes, the graph that does it, and the values that depend on the width."""

    name: str
    title: str
    inputs: tuple[str, ...]
    graph: str = ""
    values: Callable[[int], Mapping[str, Any]] = lambda width: {}

    @property
    def path(self) -> Path:
        """Where the graph lies."""
        return Path(__file__).parent / "graphs" / f"{self.graph or self.name}.json"

    @property
    def has_code(self) -> bool:
        """True if a node of the graph is written in it."""
        return '"type": "glsl"' in self.path.read_text("utf-8")


def _sigma(name: str) -> Callable[[int], Mapping[str, Any]]:
    return lambda width: {"blur.sigma": SIGMAS[name]} if os.environ.get(SEED) else {}


def _glow(width: int) -> Mapping[str, Any]:
    names = ("narrow", "middle", "wide")
    sigmas = zip(names, Bloom.sigmas, strict=True)
    return {f"{name}.sigma": sigma for name, sigma in sigmas} if os.environ.get(SEED) else {}


def _ten(width: int) -> Mapping[str, Any]:
    if not os.environ.get(SEED):
        return {}
    return {
        "exposure.stops": math.log2(Ten.exposure),
        "saturation.saturation": Ten.saturation,
        "blur.sigma": Ten.sigma,
        "soft.factor": Ten.mix,
    }


def _push(width: int) -> Mapping[str, Any]:
    return {"move.amount": (scale_length(PUSH, width), scale_length(PUSH, width))}


def _spiral(width: int) -> Mapping[str, Any]:
    return {"occlusion.radius": scale_length(Occlusion.radius, width)}


def _disc(width: int) -> Mapping[str, Any]:
    return {"lens.aperture": scale_length(Lens.aperture, width), "lens.largest": scale_length(Lens.largest, width)}


_ALL = (
    Task("copy", "a picture in, the same out", ("a",)),
    Task("T1s3", "Gaussian blur, sigma 3", ("a",), values=_sigma("T1s3")),
    Task("T1s10", "Gaussian blur, sigma 10", ("a",), values=_sigma("T1s10")),
    Task("T1s50", "Gaussian blur, sigma 50", ("a",), values=_sigma("T1s50")),
    Task("T2", "bloom: threshold, three blurs", ("a",), values=_glow),
    Task("T3", "Reinhard's tone mapping, measured", ("a",)),
    Task("T4", "Sobel edges", ("a",)),
    Task("T5", "ten nodes", ("a", "b"), values=_ten),
    Task("T5_catalogue", "the same of nodes of the catalogue alone", ("a", "b"), values=_ten),
    Task("T6", "displacement by noise", ("a", "noise"), values=_push),
    Task("T7", "ambient occlusion, 16 points", ("depth", "normal"), values=_spiral),
    Task("T8", "depth of field, 47 points", ("a", "depth"), values=_disc),
    Task("T9", "motion blur, 16 points", ("a", "velocity")),
    Task("T10", "24 frames of T5", ("a", "b"), "T5", _ten),
)
TASKS: Mapping[str, Task] = MappingProxyType({task.name: task for task in _ALL})

SEQUENCE = "frames/a.{:04d}.exr"
"""The file of a frame of T10, beside the other pictures."""


def picture_path(folder: Path, name: str) -> Path:
    """The file of a picture that tasks take."""
    return folder / f"{name}.exr"
