"""What is measured on a card: which graphs, at which size, over which pictures, and how few bytes could do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np
from bench.inputs import make_light
from bench.tasks import TASKS
from halation.compiler import Plan
from halation.presets import paths
from halation.renderer.bench import PassTiming

Array = np.ndarray
Size = tuple[int, int]

UHD: Size = (3840, 2160)
UHD2: Size = (7680, 4320)
DRY: Size = (96, 54)
"""Where nothing is a GPU, and to see whether all of it works."""

TILE: Size = (1920, 1080)
"""Larger pictures repeat one of this size: what they show does not matter."""

FITTING = frozenset({"fit", "fit_nearest"})
"""Passes that only bring a sample to the size that is measured: they do not count."""


@dataclass(frozen=True)
class Work:
    """A graph at a size. `inputs` names what takes the picture; without any the graph reads its own samples."""

    name: str
    title: str
    path: Path
    size: Size
    inputs: tuple[str, ...] = ("a",)


def _own(name: str) -> Path:
    return Path(__file__).parent / "graphs" / f"{name}.json"


_STACK = next(path for path in paths() if path.stem == "post_stack")
WORK: Mapping[str, Work] = MappingProxyType(
    {
        work.name: work
        for work in (
            Work("chain", "ten nodes, fused", _own("chain"), UHD2),
            *(Work(name, TASKS[name].title, TASKS[name].path, UHD) for name in ("T1s3", "T1s10", "T1s50")),
            Work("bloom", "the node bloom", _own("bloom"), UHD),
            Work("T2", TASKS["T2"].title, TASKS["T2"].path, UHD),
            Work("stack", "the preset post_stack", _STACK, UHD, ()),
        )
    }
)


def make_picture(size: Size) -> Array:
    """A picture of half floats, [height, width, 4]."""
    tile = make_light(min(size[0], TILE[0]), min(size[1], TILE[1]), 1)
    down, across = (-(-side // tile.shape[axis]) for axis, side in ((0, size[1]), (1, size[0])))
    return np.ascontiguousarray(np.tile(tile, (down, across, 1))[: size[1], : size[0]].astype(np.float16))


def least_bytes(plan: Plan) -> int:
    """Bytes of reading every picture that comes from outside once, and writing every output once.

    In the formats of the plan; pictures that are fitted first count with the size that they are fitted to.
    """
    fitted = {one.textures[0]: one.targets[0] for one in plan.passes if FITTING.issuperset(one.functions)}
    read = {fitted.get(item.surface, item.surface) for item in plan.uploads}
    return sum(plan.surfaces[number].nbytes for number in (*read, *set(plan.outputs.values())))


def select_measured(passes: tuple[PassTiming, ...]) -> tuple[PassTiming, ...]:
    """The passes that count."""
    return tuple(one for one in passes if not FITTING.issuperset(one.functions))
