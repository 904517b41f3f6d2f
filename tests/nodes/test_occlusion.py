"""Functions that all nodes of occlusion share, called alone, against numpy."""

from __future__ import annotations

import numpy as np
import pytest
from geometry import CAMERA, rays
from halation.compiler import load_library
from halation.glsl import parse
from halation.nodes import look_at
from halation.nodes.color.exposure import Exposure


@pytest.mark.parametrize("size", [(160, 90), (90, 160), (64, 64)])
@pytest.mark.parametrize(
    "camera", [CAMERA, look_at((0.0, -9.0, 0.0), (0.0, 0.0, 0.0), (0.4, 0.4))], ids=["wide", "narrow"]
)
def test_the_pitch_is_the_way_from_pixel_to_pixel(run, renderer, monkeypatch, camera, size):
    """Along a row, at a depth: by the inverse of the camera's matrix, whatever the height of the picture is."""
    width, height = size
    rows = ", ".join(f"vec4({', '.join(map(repr, camera.inverse[at : at + 4]))})" for at in (0, 4, 8))
    text = f"""#include "lib/occlusion.glsl"
vec4 exposure(vec4 image, float stops) {{
    return vec4(pixel_pitch(vec4[3]({rows}), image.r, image.gb), 0.0, 0.0, 1.0);
}}
"""
    texts = {**load_library().texts, "color/exposure": parse("color/exposure", text)}
    monkeypatch.setattr(renderer, "library", type(load_library())(texts))
    ray = rays(camera, width, height)
    for depth in (0.5, 7.0):
        image = np.full((1, 1, 4), (depth, width, height, 1.0), np.float32)
        expected = np.linalg.norm(depth * (ray[0, 1] - ray[0, 0]))
        assert run(Exposure(stops=1.0), {"image": image})[0, 0, 0] == pytest.approx(expected, rel=1e-5)
