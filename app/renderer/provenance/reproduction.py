"""Renders a picture again from its header, and compares the two."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from msgspec import Struct

from ...color.management import get_color_manager
from ...errors import DeviceError, UsageError
from ...graph import Graph, color_settings, find_node_output
from ...media.comparison.metrics import EIGHT_BIT_STEP, PictureDifference, compare_pictures
from ...media.pictures.stored import read_stored_codes
from ...resources.sandbox import Sandbox
from ...version import VERSION
from ..device import Device
from ..engine import Renderer, RenderRequest
from ..execution.decoding import Array
from ..jobs.destinations import OutputSettings
from ..jobs.job import run_job
from ..opening import open_device
from ..pinned_device import open_pinned
from .file_finder import LocatedFile, relink_files
from .recipe import Recipe

OTHER_DEVICE_TOLERANCE = EIGHT_BIT_STEP
"""How far pictures of different renderers may differ: one step of 8 bits, relative to light over 1. It is the smallest
difference that an 8-bit display can show; drivers differ in the last bits of functions such as pow and exp."""

_PINNED_SUFFIX = "128 bits)"
"""The end of the name of the software rasterizer if it is pinned: see `pinned_device`."""
_DEFAULT_COLOR = "linear Rec.709, built in"


class EnvironmentDifference(Struct, frozen=True):
    """A part of the environment that differs from the recorded one."""

    name: str
    recorded: str
    current: str


class LayerDifference(Struct, frozen=True):
    """The difference of a layer. `farthest` is the largest difference of a number, relative to numbers over 1."""

    name: str
    farthest: float
    compared: PictureDifference


class Reproduction(Struct, frozen=True):
    """The result of rendering a picture again."""

    differences: tuple[EnvironmentDifference, ...]
    layers: tuple[LayerDifference, ...]
    tolerance: float
    written: tuple[Path, ...]

    @property
    def is_same(self) -> bool:
        """True if the pixels are the same, within the tolerance."""
        return all(layer.farthest <= self.tolerance for layer in self.layers)


def open_matching_device(recipe: Recipe, sandbox: Sandbox) -> Device:
    """A device like that of the recipe, if there is one. Raises DeviceError without usable OpenGL."""
    if recipe.settings.form == "fragment" and recipe.renderer.endswith(_PINNED_SUFFIX):
        return open_pinned(sandbox=sandbox)
    try:
        return open_device(recipe.settings.form, sandbox=sandbox)
    except DeviceError:
        return open_device(sandbox=sandbox)


def reproduce(
    renderer: Renderer,
    recipe: Recipe,
    located_files: Sequence[LocatedFile],
    files: Sequence[Path] = (),
    tolerance: float | None = None,
) -> Reproduction:
    """Render a recipe with the files that were found, and compare; the result is also written to `files`.

    Without a tolerance, pictures of the same renderer must be equal, and others within `OTHER_DEVICE_TOLERANCE`. Raises
    the errors of `app.errors`.
    """
    graph, targets, recorded = _relink_graph(recipe, located_files), {}, recipe.settings
    if recorded.node:
        targets = {recorded.node: find_node_output(graph, recorded.node)}
    names = recorded.outputs or (recorded.node,)  # "" is all of them
    request = RenderRequest({}, targets, recorded.size, recorded.scale, recorded.frame, recorded.intermediates)
    for file in files:
        if file.resolve() == recipe.path.resolve():
            raise UsageError(f"-o {file}: this is the picture to compare with; write to another file")
    with tempfile.TemporaryDirectory(prefix="halation-", dir=renderer.sandbox.root or None) as folder:
        rendered_file = Path(folder, recipe.path.name)
        pairs = [(name, file) for file in (rendered_file, *files) for name in names]
        output_settings = OutputSettings(
            pairs,
            recorded.view,
            recorded.compression,
            recorded.precision or "half",
            recorded.display,
            recorded.look,
            recorded.colorspace,
            dither=recorded.dither,
        )
        run_job(renderer, graph, request, output_settings, (recorded.frame,))
        layers = compare_layers(*(read_stored_codes(path, renderer.sandbox) for path in (rendered_file, recipe.path)))
    differences = tuple(
        _find_differences(recipe, renderer.device, get_color_manager(color_settings(graph), renderer.sandbox).digest)
    )
    is_other_device = any(item.name in ("renderer", "driver", "passes") for item in differences)
    allowed = (OTHER_DEVICE_TOLERANCE if is_other_device else 0.0) if tolerance is None else tolerance
    return Reproduction(differences, layers, allowed, tuple(files))


def compare_layers(actual: Mapping[str, Array], expected: Mapping[str, Array]) -> tuple[LayerDifference, ...]:
    """The differences of two files by layer; a layer that only one of them has differs infinitely."""
    layers: list[LayerDifference] = []
    for name in dict.fromkeys((*expected, *actual)):
        if name not in actual or name not in expected:
            fault = "it was not made again" if name in expected else "it was not there before"
            layers.append(LayerDifference(name, np.inf, PictureDifference(fault=fault)))
            continue
        actual_pixels, expected_pixels = actual[name], expected[name]
        if actual_pixels.dtype != expected_pixels.dtype:
            layers.append(
                LayerDifference(
                    name,
                    np.inf,
                    PictureDifference(fault=f"it is {actual_pixels.dtype} now, and was {expected_pixels.dtype}"),
                )
            )
            continue
        difference = compare_pictures(actual_pixels, expected_pixels, perceptual=False, threshold=0.0)
        layers.append(
            LayerDifference(
                name, np.inf if difference.fault else _measure_distance(actual_pixels, expected_pixels), difference
            )
        )
    return tuple(layers)


def _measure_distance(actual: Array, expected: Array) -> float:
    if actual.dtype.kind in "ui":
        actual, expected = (item / float(np.iinfo(item.dtype).max) for item in (actual, expected))
    first, second = actual.astype(np.float64), expected.astype(np.float64)
    is_equal = (first == second) | (np.isnan(first) & np.isnan(second))
    with np.errstate(invalid="ignore"):
        distances = np.abs(first - second) / np.maximum(1.0, np.abs(second))
    distances = np.where(is_equal, 0.0, np.where(np.isfinite(distances), distances, np.inf))
    return float(distances.max(initial=0.0))


def _relink_graph(recipe: Recipe, located_files: Sequence[LocatedFile]) -> Graph:
    graph = relink_files(recipe.graph, located_files)
    if recipe.settings.frames:  # the sequence may have other frames now
        return replace(graph, settings=replace(graph.settings, frames=recipe.settings.frames))
    return graph


def _find_differences(recipe: Recipe, device: Device, color: str) -> list[EnvironmentDifference]:
    """The recorded parts of the environment that differ now."""
    facts = {
        "version": (recipe.version, VERSION),
        "renderer": (recipe.renderer, device.target.renderer),
        "driver": (recipe.driver, device.driver),
        "passes": (recipe.settings.form or "", device.target.form),
    }
    differences = [
        EnvironmentDifference(name, recorded, current)
        for name, (recorded, current) in facts.items()
        if recorded and recorded != current
    ]
    if color != recipe.color:
        differences.append(EnvironmentDifference("color", recipe.color or _DEFAULT_COLOR, color or _DEFAULT_COLOR))
    return differences
