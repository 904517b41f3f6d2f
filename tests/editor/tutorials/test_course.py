"""The lessons of the course: each opens unsolved, its own commands solve it, and its numbers are those of its graph."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from halation import document, presets
from halation.authoring.edits.ports import is_viewable
from halation.authoring.session import Session
from halation.compiler.lowering.gaussian import plan_axis
from halation.editor.shared.window_commands import PanelTitle
from halation.editor.tutorials.conditions import AllHold, GraphCondition, IsChosen, IsLinked, IsUpstream, IsWithin
from halation.editor.tutorials.course import COURSE
from halation.editor.tutorials.lesson import Lesson
from halation.graph import Graph, Port, signature
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.nodes.glow.bloom import Bloom
from halation.renderer import Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED
from scipy.ndimage import gaussian_filter

LUMINANCE = (0.2126, 0.7152, 0.0722)
LESSONS = {lesson.id: lesson for lesson in COURSE}


def open_session(lesson: Lesson) -> Session:
    session = Session(sandbox=UNRESTRICTED)
    session.files.open_copy(lesson.start_file)
    return session


def solve(lesson: Lesson) -> Graph:
    session = open_session(lesson)
    for task in lesson.tasks:
        for command in task.solution:
            session.apply(command)
    return session.graph


def render(renderer: Renderer, graph: Graph, *ports: str) -> list[np.ndarray]:
    pictures = renderer.render(graph, RenderRequest(targets={port: Port.parse(port) for port in ports}))
    return [pictures[port].astype(np.float64) for port in ports]


@pytest.mark.parametrize("lesson", COURSE, ids=lambda lesson: lesson.id)
def test_a_lesson_opens_unsolved_and_its_commands_solve_one_task_after_the_other(lesson: Lesson) -> None:
    session = open_session(lesson)
    assert lesson.tasks and not lesson.is_solved(session.graph)
    for task in lesson.tasks:
        assert isinstance(task.is_done, GraphCondition) and task.solution
        assert not task.is_done.holds(session.graph), task.sentence
        for command in task.solution:
            session.apply(command)
        assert task.is_done.holds(session.graph), task.sentence
    assert lesson.is_solved(session.graph)
    while session.history.position:
        session.undo()
    assert not lesson.is_solved(session.graph)


@pytest.mark.parametrize("lesson", COURSE, ids=lambda lesson: lesson.id)
def test_a_step_is_about_what_the_graph_has(lesson: Lesson) -> None:
    session = open_session(lesson)
    for step in lesson.steps:
        assert not step.show or is_viewable(session.graph, Port.parse(step.show)), step.show
        kind, _, place = step.widget.rpartition(" ")
        if kind == "title":
            assert place in session.graph.nodes, step.widget
        elif kind == "pin in":
            port = Port.parse(place)
            sockets = signature(session.graph.nodes[port.node])
            assert port.socket in {**sockets.inputs, **sockets.values}, step.widget
        else:
            assert step.widget in set(PanelTitle), step.widget
        for command in step.solution:
            session.apply(command)
        assert len(step.sentence) < 300 and re.search(r"[.?]$", step.sentence), step.sentence


@pytest.mark.parametrize("lesson", COURSE, ids=lambda lesson: lesson.id)
def test_both_graphs_can_be_planned(lesson: Lesson, renderer: Renderer) -> None:
    assert renderer.compile(document.load(lesson.start_file, sandbox=UNRESTRICTED)).outputs
    assert renderer.compile(solve(lesson)).outputs


def test_each_graph_belongs_to_a_lesson() -> None:
    files = {path.stem for path in (presets.sample().parents[1] / "lessons").glob("*.json")}
    assert files == LESSONS.keys() and len(COURSE) == 12


def test_conditions_read_links_values_and_order() -> None:
    graph = Graph().add("glow", Bloom()).add("light", Exposure()).add("soft", GaussianBlur(sigma=3.0))
    assert not IsUpstream("bloom", of="gaussian_blur").holds(graph)
    for source, target in (("glow.out", "light.image"), ("light.out", "soft.image")):
        graph = graph.connect(Port.parse(source), Port.parse(target))
    assert IsUpstream("bloom", of="gaussian_blur").holds(graph), "through another node"
    assert not IsUpstream("gaussian_blur", of="bloom").holds(graph)
    assert IsLinked("light.image", "glow.out").holds(graph) and not IsLinked("light.image", "soft.out").holds(graph)
    assert IsWithin("soft.sigma", 3.0, 3.0).holds(graph) and not IsWithin("soft.sigma", 3.1, 9.0).holds(graph)
    assert not IsWithin("gone.sigma", 0.0, 9.0).holds(graph), "a node that was deleted"
    assert IsChosen("glow.mode", "mix").holds(graph) and not IsChosen("glow.mode", "add").holds(graph)
    assert not AllHold((IsChosen("glow.mode", "mix"), IsWithin("soft.sigma", 4.0, 9.0))).holds(graph)


def test_the_numbers_of_buffers_and_motion(renderer: Renderer) -> None:
    (depth,) = render(renderer, solve(LESSONS["buffers"]), "scene.depth")
    assert ((depth > 7.0) & (depth < 9.5)).mean() == pytest.approx(0.19, abs=0.005)
    (velocity,) = render(renderer, solve(LESSONS["motion_blur"]), "scene.velocity")
    assert np.hypot(velocity[..., 0], velocity[..., 1]).max() == pytest.approx(23.0, abs=0.5)
    plan = renderer.compile(solve(LESSONS["motion_blur"]))
    assert (22, 13) in {plan.surfaces[number].size for item in plan.passes for number in item.targets}, "480 / 22 tiles"


def test_two_passes_of_a_blur_are_the_whole_one(renderer: Renderer) -> None:
    graph = solve(LESSONS["separable_blur"])
    color, twice, whole = render(renderer, graph, "scene.color", "outputs.image", "whole.out")
    np.testing.assert_allclose(twice, whole, rtol=1e-3, atol=1e-3)
    expected = gaussian_filter(color, (4.0, 4.0, 0.0), mode="nearest", truncate=4.0)
    assert np.sqrt(np.mean((twice - expected) ** 2)) < 1e-3 * np.sqrt(np.mean(expected**2))
    assert plan_axis(4.0).factor == 1 and len(plan_axis(4.0).weights) == 2 * 16 + 1


def test_a_pyramid_has_a_third_more_pixels_and_large_ones_at_its_end(renderer: Renderer) -> None:
    graph = document.load(LESSONS["bloom_pyramid"].start_file, sandbox=UNRESTRICTED)
    plan = renderer.compile(graph, RenderRequest(targets={"glow": Port("pyramid", "glow")}))
    shrunk = [plan.surfaces[item.targets[0]].size for item in plan.passes if "bloom_shrink" in item.functions]
    assert sum(width * height for width, height in shrunk) / (480 * 270) == pytest.approx(1.0 / 3.0, abs=0.01)
    assert 480 / shrunk[-1][0] == 32
    assert graph.value(Port("box", "radius")) * 270 / 1080 == 40.0, "2 * 40 + 1 pixels"


def test_the_kernel_of_ones_is_nine_times_too_bright(renderer: Renderer) -> None:
    graph = document.load(LESSONS["convolution"].start_file, sandbox=UNRESTRICTED)
    (bright,) = render(renderer, graph, "kernel.out")
    (even,) = render(renderer, solve(LESSONS["convolution"]), "kernel.out")
    np.testing.assert_allclose(bright[..., :3], 9.0 * even[..., :3], rtol=1e-3)
    assert np.log2(9.0) == pytest.approx(3.17, abs=0.005)


def test_a_glow_before_tone_mapping_is_three_times_as_strong_over_the_dark(renderer: Renderer) -> None:
    lesson = LESSONS["tone_mapping"]
    before = document.load(lesson.start_file, sandbox=UNRESTRICTED)
    color, weak = (part[..., :3] @ LUMINANCE for part in render(renderer, before, "scene.color", "glow.glow"))
    (strong,) = (part[..., :3] @ LUMINANCE for part in render(renderer, solve(lesson), "glow.glow"))
    assert color.max() == pytest.approx(1784, abs=1) and (color > 1.0).mean() == pytest.approx(0.06, abs=0.005)
    assert strong[color < 0.5].mean() / weak[color < 0.5].mean() == pytest.approx(3.0, abs=0.1)


def test_the_log_average_is_1_9_stops_below_the_mean(renderer: Renderer) -> None:
    graph = solve(LESSONS["adaptation"])
    color, mean, log_mean, out = render(
        renderer, graph, "scene.color", "measure.average", "measure.log_average", "eye.out"
    )
    luminance = color[..., :3] @ LUMINANCE
    assert mean.item() == pytest.approx(luminance.mean(), rel=1e-3) and mean.item() == pytest.approx(0.98, abs=0.005)
    assert log_mean.item() == pytest.approx(np.exp(np.log(luminance + 1e-5).mean()), rel=1e-2)
    assert log_mean.item() == pytest.approx(0.27, abs=0.005)
    assert np.log2(mean / log_mean).item() == pytest.approx(1.9, abs=0.05)
    np.testing.assert_allclose(out[..., :3], color[..., :3] * 0.18 / log_mean.item(), rtol=0.01, atol=1e-3)


def test_the_head_is_where_the_lesson_on_focus_says(renderer: Renderer) -> None:
    (depth,) = render(renderer, solve(LESSONS["depth_of_field"]), "scene.depth")
    assert depth[103, 221] == pytest.approx(7.7, abs=0.05)


def test_half_resolution_measures_a_quarter_of_the_pixels(renderer: Renderer) -> None:
    graph = solve(LESSONS["ambient_occlusion"])
    plan = renderer.compile(graph, RenderRequest(targets={"out": Port("occlusion", "out")}))
    sizes = {name: plan.surfaces[item.targets[0]].size for item in plan.passes for name in item.functions}
    assert sizes["ambient_occlusion_horizons"] == (240, 135)
    makers = {number: index for index, item in enumerate(plan.passes) for number in item.targets}
    enlarging = [item for item in plan.passes if any(name.endswith("enlarge") for name in item.functions)]
    files = {upload.surface for upload in plan.uploads}
    assert enlarging and all(set(item.textures) & (files | makers.keys()) for item in enlarging)


def test_the_page_lists_every_lesson_with_its_idea() -> None:
    page = (Path(__file__).parents[3] / "docs" / "lessons.md").read_text(encoding="utf-8")
    rows = dict(re.findall(r"^\| `(\w+)` \| (.+) \|$", page, re.MULTILINE))
    assert list(rows.items()) == [(lesson.id, lesson.doc) for lesson in COURSE]
