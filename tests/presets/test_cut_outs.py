"""Looks on a cut-out subject, as renderers write it with a transparent film: nothing half-covered is left beside it."""

from __future__ import annotations

import numpy as np
import pytest
from halation import document, media
from halation.graph import Graph, Input
from halation.nodes import Kind
from halation.presets import paths
from halation.renderer import FrameRenderer, Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED

Array = np.ndarray
GRAPHS: dict[str, Graph] = {path.stem: document.load(path, sandbox=UNRESTRICTED) for path in paths()}
FOLDERS = {path.stem: path.parent for path in paths()}
TEXTURED = sorted(
    name for name, graph in GRAPHS.items() if any(getattr(node, "clipped", False) for node in graph.nodes.values())
)
RELIT = ("late_sun", "night_relight")


def read_input(name: str, end: Input) -> Array:
    layer = media.read_layer(FOLDERS[name] / end.file, end.layer, end.kind, end.socket().channels, sandbox=UNRESTRICTED)
    return np.array(layer.array, np.float32)


def cut_out(name: str) -> tuple[dict[str, Array], Array]:
    """The inputs of a preset within an ellipse with soft rims, and how much of each pixel it covers.

    Colors are multiplied by coverage, and only the beauty has an alpha that says so; normals become shorter; depth and
    positions are those of the subject or of nothing: as Cycles writes them.
    """
    inputs = {key: read_input(name, end) for key, end in GRAPHS[name].inputs.items()}
    height, width = next(iter(inputs.values())).shape[:2]
    y, x = np.mgrid[:height, :width]
    distance = 1.0 - np.hypot((x - width / 2) / (0.3 * width), (y - height / 2) / (0.35 * height))
    cover = np.clip(0.5 + 0.3 * height * distance, 0.0, 1.0)[..., None].astype(np.float32)
    for key, array in inputs.items():
        kind = GRAPHS[name].inputs[key].kind
        if array.shape[:2] != (height, width):
            continue
        if kind is Kind.FIELD:
            array[...] = np.where(cover > 0.5, array, 1e10)
        elif key == "position":
            array[...] = np.where(cover > 0.5, array, 0.0)
        elif kind is Kind.IMAGE and key != "beauty":
            array[..., :3] *= cover
        else:
            array *= cover
    return inputs, cover[..., 0]


def render(renderer: Renderer, name: str, inputs: dict[str, Array]) -> Array:
    frames = FrameRenderer(renderer, GRAPHS[name], RenderRequest(inputs))
    try:
        return np.asarray(frames.render_frame((GRAPHS[name].settings.frames or (1, 1))[0])["image"])
    finally:
        frames.close()


@pytest.mark.parametrize("name", TEXTURED)
def test_paper_is_beside_a_cut_out_whole_or_not_at_all(renderer: Renderer, name: str) -> None:
    """Textures that were merged over nothing left clouds of half-transparent paper."""
    inputs, _ = cut_out(name)
    alpha = render(renderer, name, inputs)[..., 3]
    corners = np.stack([part[:20, :20] for part in (alpha, alpha[::-1], alpha[:, ::-1], alpha[::-1, ::-1])])
    assert corners.max() < 1 / 255 or corners.min() > 254 / 255


@pytest.mark.parametrize("name", RELIT)
def test_a_relit_cut_out_covers_what_it_covered(renderer: Renderer, name: str) -> None:
    inputs, cover = cut_out(name)
    np.testing.assert_allclose(render(renderer, name, inputs)[..., 3], cover, atol=2e-3)  # half floats


@pytest.mark.parametrize("name", RELIT)
def test_the_rim_of_a_relit_cut_out_is_no_brighter_than_beside_it(renderer: Renderer, name: str) -> None:
    """Black albedo counts as metal in these looks: premultiplied, that of a rim was nearly black, and shone in dots."""
    inputs, cover = cut_out(name)
    light = render(renderer, name, inputs)[..., :3].max(-1)
    rim, inside = (cover > 0.02) & (cover < 0.5), cover == 1.0
    # The same surfaces under the same lights. Before, 90 % of the rim were below 12 and 8 times the light inside.
    assert np.percentile(light[rim] / cover[rim], 90) < 1.5 * np.percentile(light[inside], 90)
