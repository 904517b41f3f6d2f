"""What becomes of textures: of those for pictures that no plan renders, and of those that a pass failed to fill."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from conftest import graph_of
from devices import open_renderer
from halation.errors import RenderError
from halation.graph import Port
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.renderer import Renderer, RenderRequest
from halation.renderer.execution.executor import Executor
from halation.renderer.viewing.plates import PlateTexture

RANDOM = np.random.default_rng(5)


def test_a_plate_shows_the_last_picture_whatever_its_size(renderer: Renderer) -> None:
    """Bytes come back as they were, in rows from the top, and a texture is made anew only for another size."""
    plate, before = PlateTexture(renderer.device), None
    for height, width in ((3, 5), (3, 5), (5, 3), (5, 3), (4, 3), (4, 7), (4, 7)):
        pixels = RANDOM.integers(0, 256, (height, width, 4), np.uint8)
        texture = plate.show(pixels)
        with renderer.device.make_current():
            found = renderer.device.read_region(texture, (0, 0, width, height))
        np.testing.assert_allclose(found.reshape(height, width, 4), pixels / 255.0, atol=1e-6)
        assert texture.size == (width, height)
        assert (texture is before) is (before is not None and before.size == (width, height))
        before = texture
    plate.close()
    plate.close()
    assert plate.show(np.zeros((2, 2, 4), np.uint8)) is not before
    plate.close()


@pytest.mark.parametrize("failing", [0, 1])
def test_a_pass_that_fails_leaves_no_picture(monkeypatch: pytest.MonkeyPatch, failing: int) -> None:
    """Neither its memory nor half of a result: the next run makes what the first one would have made."""
    picture = RANDOM.random((16, 16, 4)).astype(np.float32)
    graph = graph_of(Exposure(stops=1.0), {"image": picture}).add("blur", GaussianBlur(sigma=3.0))
    graph = graph.connect(Port("node", "out"), Port("blur", "image"))
    graph = graph.connect(Port("blur", "out"), Port("outputs", "out"))
    request = RenderRequest({"image": picture})
    engine = open_renderer()
    try:
        run, count = Executor._run_bands, iter(range(9))  # pyright: ignore[reportPrivateUsage]

        def run_some(runner: Any, *words: Any) -> Iterator[Any]:
            yield from run(runner, *words)
            if next(count) == failing:
                raise RenderError("an error")

        with monkeypatch.context() as patch, pytest.raises(RenderError, match="an error"):
            patch.setattr(Executor, "_run_bands", run_some)
            engine.render(graph, request)
        textures = engine.runner.textures
        assert not [key for key in textures._results if key.startswith("draft")]  # pyright: ignore[reportPrivateUsage]
        found = engine.render(graph, request)["out"]
        fresh = open_renderer()
        try:
            np.testing.assert_array_equal(found, fresh.render(graph, request)["out"])
            assert textures.allocated == fresh.runner.textures.allocated
        finally:
            fresh.close()
    finally:
        engine.close()
