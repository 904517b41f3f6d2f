"""Temporal nodes: history goes from frame to frame, and nowhere else."""

from __future__ import annotations

from typing import Annotated

import numpy as np
import pytest
from conftest import graph_of
from halation.app.compiler import Library, installed
from halation.app.compiler.library import parse
from halation.app.renderer import Renderer, Wanted, open_device
from halation.nodes import Draw, Drawn, Image, Slider, Temporal


class Trail(Temporal):
    """Exponential blending with the frame before."""

    image = Image()
    keep: Annotated[float, Slider(0.0, 1.0, unit="ratio")] = 0.75

    def passes(self, draw: Draw) -> Drawn:
        before = draw.history(self.image)
        blended = draw.point("trail", self.image, before=before, keep=self.keep)
        draw.remember(blended)
        return blended


@pytest.fixture
def engine():
    source = "vec4 trail(vec4 image, vec4 before, float keep) { return mix(image, before, keep); }\n"
    shader = f"{Trail.category}/{Trail.id}"
    library = Library({**installed().texts, shader: parse(shader, source)})
    made = Renderer(open_device(), budget=0, library=library)
    yield made
    made.close()


def frame(number: int) -> np.ndarray:
    return np.full((5, 7, 4), float(number), np.float32)


def rendered(engine: Renderer, numbers: range, node: Trail, *, follows: bool = False) -> list[float]:
    found = []
    for number in numbers:
        picture = {"image": frame(number)}
        wanted = Wanted(picture, precision="float", frame=number, follows=follows or number != numbers.start)
        found.append(float(engine.render(graph_of(node, picture), wanted)["out"][2, 3, 0]))
    return found


def test_frames_blend_by_the_closed_form(engine):
    """y_n = sum of (1 - a) a^k x_{n - k}, with the first frame standing for all before it."""
    a, numbers = 0.75, range(1, 9)
    expected = []
    for number in numbers:
        terms = [(1 - a) * a**back * (number - back) for back in range(number - 1)]
        expected.append(sum(terms) + a ** (number - 1) * 1.0)
    np.testing.assert_allclose(rendered(engine, numbers, Trail(keep=a)), expected, rtol=1e-6)


def test_a_frame_that_follows_no_other_has_no_history(engine):
    rendered(engine, range(1, 5), Trail())
    assert rendered(engine, range(9, 10), Trail()) == [9.0]


def test_two_runs_in_a_row_equal_one(engine):
    whole = rendered(engine, range(1, 9), Trail())
    parts = rendered(engine, range(1, 5), Trail()) + rendered(engine, range(5, 9), Trail(), follows=True)
    assert parts == whole


def test_history_of_another_size_is_not_used(engine):
    rendered(engine, range(1, 3), Trail())
    other = np.full((9, 9, 4), 5.0, np.float32)
    wanted = Wanted({"image": other}, precision="float", follows=True)
    assert engine.render(graph_of(Trail(), {"image": other}), wanted)["out"][0, 0, 0] == 5.0


def test_memory_does_not_grow_with_frames(engine):
    rendered(engine, range(1, 4), Trail())
    early = engine.runner.textures.allocated
    rendered(engine, range(4, 40), Trail(), follows=True)
    assert engine.runner.textures.allocated == early


@pytest.mark.parametrize("precisions", [("float", "half"), ("half", "float")])
def test_history_keeps_the_precision_that_it_was_made_with(engine, precisions):
    """The next frame may be rendered with another: 3 remembered three quarters, 5 new one."""
    for number, precision in zip((3, 5), precisions, strict=True):
        picture = {"image": frame(number)}
        wanted = Wanted(picture, precision=precision, frame=number, follows=number == 5)
        found = engine.render(graph_of(Trail(), picture), wanted)["out"]
    np.testing.assert_array_equal(found, np.full_like(found, 0.75 * 3.0 + 0.25 * 5.0))


def test_history_belongs_to_what_ran_last_however_it_was_run(engine):
    """A frame rendered pass by pass in between, without history, leaves none."""
    rendered(engine, range(1, 5), Trail())
    between = graph_of(Trail(), {"image": frame(7)})
    plan = engine.compile(between, Wanted({"image": frame(7)}, precision="float"))
    for _ in engine.runner.steps(plan, engine.runner.lease()):
        pass
    assert rendered(engine, range(7, 8), Trail(), follows=True) == [7.0]
