"""Noise as numpy text is as far from the renderer as one rounding of its places to 32 bits moves it."""

from __future__ import annotations

import numpy as np
import pytest
from halation.export.python.functions import generate
from halation.graph import Graph, Output, Port
from halation.nodes.input.noise import Noise
from halation.renderer import Renderer, RenderRequest

SIZE = (37, 29)
ROUNDING = 2.0**-24
"""The largest error of rounding to 32 bits, relative to the number."""


def draw(values: dict[str, object], places_off: int = 0) -> np.ndarray:
    """The numpy text; with `places_off`, the places of pixels are off by one rounding, at random by that seed."""
    sound = generate.lattice_places

    def find_places(*words: object) -> tuple[np.ndarray, np.ndarray]:
        places, tiles = sound(*words)
        error = np.random.default_rng(places_off).uniform(-ROUNDING, ROUNDING, places.shape)
        return places * (1.0 + error * bool(places_off)), tiles

    generate.lattice_places = find_places
    try:
        return generate.noise(**values, width=SIZE[0], height=SIZE[1])[1][..., 0]
    finally:
        generate.lattice_places = sound


@pytest.mark.parametrize("fractal", ["fbm", "ridged", "turbulence", "warped"])
@pytest.mark.parametrize("kind", ["gradient", "value", "simplex"])
@pytest.mark.parametrize("layers", [(6, 3.0, 0.5), (10, 2.0, 1.0), (8, 3.0, 1.0)])
@pytest.mark.parametrize("period", [(0.0, 0.0), (31.0, 17.0)])
def test_fine_layers_differ_by_what_rounding_moves(
    renderer: Renderer, kind: str, fractal: str, layers: tuple[int, float, float], period: tuple[float, float]
) -> None:
    """Warped places are off by several cells of the finest layer times that: .3 of the picture at the worst."""
    octaves, lacunarity, gain = layers
    values = {
        "kind": kind, "size": 2.3, "octaves": octaves, "lacunarity": lacunarity, "gain": gain, "contrast": 2.0,
        "seed": 3, "evolution": 0.3, "fractal": fractal, "warp": 8.0, "offset": (5.0, 3.0), "period": period,
        "loop": 0.0,
    }  # fmt: skip
    links = {Port("outputs", "out"): Port("noise", "out")}
    graph = Graph(nodes={"noise": Noise(**values)}, outputs={"out": Output()}, links=links)
    exact = draw(values)
    moved = np.max([np.abs(draw(values, seed) - exact) for seed in (1, 2, 3)], axis=0)
    away = np.abs(renderer.render(graph, RenderRequest(size=SIZE))["out"][..., 0] - exact)
    assert away.max() <= 2e-6 + 4.0 * moved.max()
    assert np.sqrt(np.mean(away**2)) <= 1e-6 + 4.0 * np.sqrt(np.mean(moved**2))
