"""Temporal nodes: history goes from frame to frame, and nowhere else."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Annotated

import numpy as np
import pytest
from halation.compiler import Library, load_library
from halation.compiler.library import parse
from halation.errors import GraphError, UsageError
from halation.graph import Graph, Input, Output, Port, Settings
from halation.nodes import Draw, Drawn, Image, Kind, Slider, Temporal
from halation.nodes.color.exposure import Exposure
from halation.nodes.time.time_offset import TimeOffset
from halation.renderer import FrameRenderer, Renderer, RenderRequest, open_device
from halation.resources.sandbox import UNRESTRICTED


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
    library = Library({**load_library().texts, shader: parse(shader, source)})
    made = Renderer(open_device(sandbox=UNRESTRICTED), budget=0, library=library, sandbox=UNRESTRICTED)
    yield made
    made.close()


SHOWN = Input(Kind.IMAGE, default=0.0)
WHOLE = range(1, 9)


def trail(keep: float = 0.75, **settings) -> Graph:
    """Blends what is bound to its input."""
    graph = Graph(settings=Settings((7, 5), **settings)).add_input("image", SHOWN).add("trail", Trail(keep=keep))
    graph = graph.add_output("out", Output()).connect(Port("inputs", "image"), Port("trail", "image"))
    return graph.connect(Port("trail", "out"), Port("outputs", "out"))


def frame(number: int) -> np.ndarray:
    return np.full((5, 7, 4), float(number), np.float32)


def reel(engine: Renderer, graph: Graph, **wanted) -> FrameRenderer:
    return FrameRenderer(engine, graph, RenderRequest({"image": frame}, **{"precision": "float", **wanted}))


def rendered(one: FrameRenderer, frames: Iterable[int]) -> list[float]:
    return [float(one.render_frame(number)["out"][2, 3, 0]) for number in frames]


def closed_form(keep: float, begin: int, number: int) -> float:
    """y_n = sum of (1 - a) a^k x_{n - k}, with the first frame standing for all before it."""
    terms = [(1 - keep) * keep**back * (number - back) for back in range(number - begin)]
    return sum(terms) + keep ** (number - begin) * begin


def test_frames_blend_by_the_closed_form(engine):
    found = rendered(reel(engine, trail(0.75, frames=(1, 8))), WHOLE)
    np.testing.assert_allclose(found, [closed_form(0.75, 1, number) for number in WHOLE], rtol=1e-6)


def test_a_frame_before_the_range_remembers_nothing(engine):
    one = reel(engine, trail(frames=(5, 9)))
    assert rendered(one, (3, 5)) == [3.0, 5.0]


def test_frames_are_the_same_in_any_order_and_in_parts(engine):
    graph = trail(frames=(1, 8))
    whole = rendered(reel(engine, graph), WHOLE)
    assert rendered(reel(engine, graph), range(5, 9)) == whole[4:]
    order = (8, 2, 3, 7, 1, 5)
    assert rendered(reel(engine, graph), order) == [whole[number - 1] for number in order]


def test_what_was_shown_before_does_not_matter(engine):
    """Another graph, another time, the same engine."""
    alone = rendered(reel(engine, trail(0.5, frames=(1, 8))), (6,))
    rendered(reel(engine, trail(0.9, frames=(1, 8))), WHOLE)
    assert rendered(reel(engine, trail(0.5, frames=(1, 8))), (6,)) == alone


@pytest.mark.parametrize("preroll", [0, 1, 3])
def test_preroll_says_where_history_begins(engine, preroll):
    graph = trail(0.75, frames=(1, 8), preroll=preroll)
    expected = [closed_form(0.75, max(1, number - preroll), number) for number in WHOLE]
    np.testing.assert_allclose(rendered(reel(engine, graph), WHOLE), expected, rtol=1e-6)


def test_history_on_the_device_is_not_computed_again(engine):
    one = reel(engine, trail(frames=(1, 8)))
    before = engine.runner.counters.passes
    rendered(one, WHOLE)
    passes = engine.runner.counters.passes - before
    assert passes == 8
    rendered(one, (8,))
    assert engine.runner.counters.passes - before <= 9


def test_memory_does_not_grow_with_frames(engine):
    one = reel(engine, trail(frames=(1, 60)))
    rendered(one, range(1, 4))
    early = engine.runner.textures.allocated
    rendered(one, range(4, 40))
    assert engine.runner.textures.allocated == early


def test_a_memory_of_another_size_is_of_another_picture(engine):
    grown = RenderRequest(
        {"image": lambda number: np.full((5 + number, 7, 4), 1.0 * number, np.float32)}, precision="float"
    )
    one = FrameRenderer(engine, replace(trail(frames=(1, 8)), settings=Settings(frames=(1, 8))), grown)
    assert rendered(one, (1, 2, 3)) == [1.0, 2.0, 3.0]


def test_a_memory_of_halves_stays_one(engine):
    """3, 5, 7 ... are exact in half floats, and so is what they blend to here."""
    assert rendered(reel(engine, trail(0.5, frames=(1, 3)), precision="half"), (1, 2, 3)) == [1.0, 1.5, 2.25]


def test_looking_at_another_frame_of_a_memory_is_refused(engine):
    graph = trail(frames=(1, 8)).add("offset", TimeOffset(frames=-1)).disconnect(Port("outputs", "out"))
    graph = graph.connect(Port("trail", "out"), Port("offset", "image"))
    graph = graph.connect(Port("offset", "out"), Port("outputs", "out"))
    with pytest.raises(GraphError, match="'trail' remembers the frame before"):
        reel(engine, graph).render_frame(3)


def test_a_picture_that_is_there_needs_no_history(engine):
    """Its memory may have gone from the device meanwhile, and all before it."""
    graph = trail(0.5, frames=(1, 8)).add("light", Exposure(stops=1.0))
    graph = graph.connect(Port("trail", "out"), Port("light", "image"))
    graph = graph.connect(Port("light", "out"), Port("outputs", "out"))
    one = reel(engine, graph)
    made, shown = engine.runner.create_lease(), engine.runner.create_lease()
    for run in one.start_runs(6, made):
        list(run)
    plan = one.plan_frame(6)
    shown.add(plan.surfaces[plan.outputs["out"]].key)
    made.close()
    one.close()
    engine.runner.textures.release_idle()
    before = engine.runner.counters.passes
    assert all(plan.surfaces[number].key not in engine.runner.textures for number in plan.remembered)
    expected = [2.0 * closed_form(0.5, 1, 6)]
    assert rendered(one, (6,)) == pytest.approx(expected) and engine.runner.counters.passes == before
    shown.close()


class CountedLookups(dict):
    """What is known of frames, and how often somebody asked. A billion questions take minutes."""

    count = 0

    def __contains__(self, key: object) -> bool:
        self.count += 1
        return super().__contains__(key)


@pytest.mark.parametrize("number", [999_999_999, -999_999_999])
def test_a_frame_far_away_is_not_walked_to(engine, number):
    graph = Graph(settings=Settings((7, 5))).add_input("image", SHOWN).add("light", Exposure(stops=1.0))
    graph = graph.add_output("out", Output()).connect(Port("inputs", "image"), Port("light", "image"))
    frames = reel(engine, graph.connect(Port("light", "out"), Port("outputs", "out")))
    frames._memories = CountedLookups()
    assert frames.plan_next(number) is not None
    assert rendered(frames, [number]) == [2.0 * np.float32(number)]
    assert frames._memories.count < 20 and len(frames._memories) <= 2


def test_too_many_frames_of_history_are_refused(engine):
    frames = reel(engine, trail())
    frames._memories = CountedLookups()
    with pytest.raises(UsageError, match="remembers earlier frames, so 999,999,998 frames come before it"):
        frames.render_frame(999_999_999)
    assert frames._memories.count < 20
    assert rendered(reel(engine, trail(preroll=2)), [999_999_999]) == [np.float32(1e9)]
