"""Frames and histories in the preview: each frame's picture is its own, whatever was shown before."""

from __future__ import annotations

import numpy as np
import pytest
from halation.graph import Expression, Graph, Keys, Port
from halation.nodes.color.exposure import Exposure
from halation.nodes.time.light_trails import LightTrails
from halation.renderer import FrameRenderer, RenderRequest
from halation.renderer.execution.texture_pool import MIN_TEXTURE_BYTES
from previews import pixels, settle
from sequences import noise_graph

PORTS = {"A": Port("outputs", "out")}


def moving(frames: tuple[int, int] = (1, 20), **nodes: object) -> Graph:
    """Noise that is new in every frame, brighter from frame to frame."""
    graph = noise_graph(Exposure(), frames)
    return graph.animate(Port("node", "stops"), Keys().set(1, 0.0).set(20, 2.0))


def trails(frames: tuple[int, int] = (1, 20)) -> Graph:
    return noise_graph(LightTrails(), frames)


def look(preview, graph: Graph, frame: int) -> np.ndarray:
    preview.want(graph, PORTS, frame=frame)
    settle(preview)
    assert preview.find_whole_image("A").frame == frame
    return pixels(preview, preview.renderer).copy()


def by_reel(engine, graph: Graph, frame: int) -> np.ndarray:
    reel = FrameRenderer(engine, graph, RenderRequest(targets=PORTS))
    try:
        return reel.render_frame(frame)["A"].copy()
    finally:
        reel.close()


@pytest.mark.parametrize("make", [moving, trails])
def test_a_frame_is_the_same_whatever_was_shown_before(preview, engine, make):
    graph = make()
    found = {frame: look(preview, graph, frame) for frame in (9, 1, 20, 10, 3)}
    for frame, seen in found.items():
        np.testing.assert_array_equal(seen, by_reel(engine, graph, frame))
    for frame in (20, 3, 9):
        np.testing.assert_array_equal(look(preview, graph, frame), found[frame])
    assert len({seen.tobytes() for seen in found.values()}) >= 4
    assert preview.frames == (1, 3, 9, 10, 20)
    assert preview.remembers is (make is trails)


def test_frames_that_are_ready_need_no_pass_and_no_plan(preview, engine):
    graph = trails()
    for frame in (5, 6):
        look(preview, graph, frame)
    before, compiled = engine.runner.counters.passes, engine.compile
    engine.compile = None
    preview.skims = True
    look(preview, graph, 5)
    assert engine.runner.counters.passes == before
    engine.compile = compiled
    preview.skims = False
    preview.work(0.0)
    settle(preview)
    assert engine.runner.counters.passes == before, "what was only shown is looked at when there is time"


def test_a_long_history_is_planned_and_run_in_steps(preview, engine, monkeypatch):
    graph, seen, plans = trails((1, 60)), set(), []
    plan = FrameRenderer._plan_from

    def count_plans(reel: FrameRenderer, begin: int, frame: int):
        plans.append((begin, frame) not in reel._plans)
        return plan(reel, begin, frame)

    monkeypatch.setattr(FrameRenderer, "_plan_from", count_plans)
    preview.want(graph, PORTS, frame=50)
    while preview.busy:
        passes, planned = engine.runner.counters.passes, sum(plans)
        preview.work(0.0)
        assert engine.runner.counters.passes - passes <= 1 and sum(plans) - planned <= 2, "a plan or a pass"
        if preview.lead:
            seen.add(preview.lead)
    assert ("plan", 20, 50) in seen and ("pre-roll", 12, 49) in seen
    np.testing.assert_array_equal(pixels(preview, engine), by_reel(engine, graph, 50))


def test_the_next_frame_of_a_history_is_one_step(preview, engine):
    graph = trails()
    look(preview, graph, 8)
    preview.want(graph, PORTS, frame=9)
    while preview.busy:
        preview.work(0.0)
        assert preview.lead is None, "what frame 8 remembered is there"


def test_another_graph_has_other_frames(preview, engine):
    graph = moving()
    look(preview, graph, 1)
    look(preview, graph, 2)
    other = graph.animate(Port("node", "stops"), Expression("frame / 9"))
    look(preview, other, 2)
    assert preview.frames == (2,)
    preview.refresh()
    settle(preview)
    assert preview.frames == (2,)


def test_a_frame_for_later_is_computed_but_not_shown(preview, engine):
    graph = moving()
    now = look(preview, graph, 3)
    preview.ahead = 4
    while preview.work(0.0):
        assert not preview.busy
    assert preview.frames == (3, 4) and preview.find_whole_image("A").frame == 3
    np.testing.assert_array_equal(pixels(preview, engine), now)
    before = engine.runner.counters.passes
    preview.ahead = None
    np.testing.assert_array_equal(look(preview, graph, 4), by_reel(engine, graph, 4))
    assert engine.runner.counters.passes == before


def test_a_frame_for_later_that_is_wanted_now_goes_on(preview, engine):
    graph = trails()
    look(preview, graph, 3)
    preview.ahead = 7
    while preview.under_way is None:
        preview.work(0.0)
    preview.want(graph, PORTS, frame=7)
    preview.work(0.0)
    assert preview.under_way == 7 and preview.busy
    np.testing.assert_array_equal(look(preview, graph, 7), by_reel(engine, graph, 7))


def test_frames_keep_to_their_share_of_the_budget(preview, engine):
    graph = moving((1, 200))
    one = MIN_TEXTURE_BYTES  # which 13 x 7 pixels do not fill
    engine.runner.textures.budget = 40 * one
    for frame in range(1, 60):
        look(preview, graph, frame)
    assert preview.frames_bytes <= 20 * one
    assert 59 in preview.frames and len(preview.frames) >= 19
    preview.clear()
    assert not engine.runner.textures._leases


def test_nothing_stays_leased(preview, engine):
    for make in (moving, trails):
        for frame in (4, 5, 2):
            look(preview, make(), frame)
    preview.want(trails(), {}, frame=2)
    settle(preview)
    preview.close()
    assert not engine.runner.textures._leases
