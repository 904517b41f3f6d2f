"""A blueprint of a picture of low contrast has the lines of the picture itself."""

from __future__ import annotations

import numpy as np
from halation import document, media
from halation.nodes import Kind
from halation.presets import paths
from halation.renderer import FrameRenderer, Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED
from scipy.ndimage import maximum_filter

BLUEPRINT = next(path for path in paths() if path.stem == "blueprint")
SAMPLE = BLUEPRINT.parent / "samples" / "neon.exr"


def find_lines(renderer: Renderer, picture: np.ndarray) -> np.ndarray:
    """Where the blueprint of a picture is white."""
    graph = document.load(BLUEPRINT, sandbox=UNRESTRICTED)
    frames = FrameRenderer(renderer, graph, RenderRequest({"beauty": picture}))
    try:
        return frames.render_frame(1)["image"][..., 0] > 0.4
    finally:
        frames.close()


def test_a_blueprint_of_a_soft_picture_has_its_lines(renderer: Renderer) -> None:
    """The sample with 0.3 of its contrast keeps three quarters of its lines, where fixed thresholds keep 0.57."""
    read = media.read_layer(SAMPLE, "Combined", Kind.IMAGE, 4, sandbox=UNRESTRICTED)
    picture = np.asarray(read.array, np.float32)
    soft = picture.copy()
    soft[..., :3] = 0.25 * (np.maximum(picture[..., :3], 0.0) / 0.25) ** 0.3
    lines, soft_lines = find_lines(renderer, picture), find_lines(renderer, soft)
    near, soft_near = (maximum_filter(where, 3) for where in (lines, soft_lines))
    assert soft_near[lines].mean() > 0.75
    assert near[soft_lines].mean() > 0.95
