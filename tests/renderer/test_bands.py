"""Slow passes are run in bands, between which a window is drawn: the pixels are those of a pass in one piece."""

from __future__ import annotations

import numpy as np
import pytest
from clocks import FakeClock
from halation.custom_nodes import Code, node_type
from halation.errors import RenderError
from halation.graph import Graph, Output, Port, Settings
from halation.nodes.input.noise import Noise
from halation.renderer import Renderer, RenderRequest, open_device
from halation.renderer.execution import executor
from halation.renderer.execution.executor import Executor
from halation.resources.sandbox import UNRESTRICTED
from random_graphs import pictures, random_graph
from selection import list_seeds

SIZE = (96, 64)
GLSL = (
    "vec4 f(vec4 image) {\n float s = image.r;\n for (int i = 0; i < 40; ++i) s = sin(s + 1.3);\n return image + s;\n}"
)
ISF = """/*{"INPUTS": [{"NAME": "inputImage", "TYPE": "image"}]}*/
void main() {
    if (isf_FragNormCoord.y < 0.3) discard;
    gl_FragColor = IMG_NORM_PIXEL(inputImage, isf_FragNormCoord) + vec4(isf_FragNormCoord, gl_FragCoord.y, 0.5);
}"""


@pytest.fixture(params=["compute", "fragment"])
def engine(request):
    engine = Renderer(open_device(request.param, sandbox=UNRESTRICTED), budget=0, sandbox=UNRESTRICTED)
    yield engine
    engine.close()


def slow_graph(language: str = "glsl") -> Graph:
    code = node_type(Code(language, GLSL if language == "glsl" else ISF))()
    socket = next(iter(code.inputs))
    graph = Graph(settings=Settings(SIZE)).add("noise", Noise()).add("code", code).add_output("image", Output())
    graph = graph.connect(Port("noise", "out"), Port("code", socket))
    return graph.connect(Port("code", next(iter(code.outputs))), Port("outputs", "image"))


def run_in_bands(engine: Renderer, graph: Graph, request: RenderRequest, seconds: float) -> tuple[dict, int]:
    """The pixels, and the number of steps."""
    plan, lease, steps = engine.compile(graph, request), engine.runner.create_lease(), 1
    with engine.runner.start_run(plan, lease) as run:
        while run.step(seconds):
            steps += 1
    pixels = engine.runner.download(plan)
    lease.close()
    return pixels, steps


def same_bits(one: dict[str, np.ndarray], other: dict[str, np.ndarray]) -> None:
    assert one.keys() == other.keys()
    for name in one:
        np.testing.assert_array_equal(one[name].view(np.uint8), other[name].view(np.uint8), name)


@pytest.mark.parametrize("seed", list_seeds(4, 40))
def test_single_rows_equal_one_piece(engine, seed):
    graph, request = random_graph(seed), RenderRequest(pictures(seed), precision="float")
    banded, steps = run_in_bands(engine, graph, request, 0.0)
    same_bits(banded, engine.render(graph, request))
    assert steps > len(engine.compile(graph, request).passes)


@pytest.mark.parametrize("language", ["glsl", "isf"])
def test_bands_of_code_equal_one_piece(engine, language):
    request = RenderRequest(precision="float")
    banded, steps = run_in_bands(engine, slow_graph(language), request, 0.0)
    same_bits(banded, engine.render(slow_graph(language), request))
    assert steps > SIZE[1] / 2


def test_code_that_takes_seconds_stops_after_every_row(engine, monkeypatch):
    clock = FakeClock(monkeypatch, executor)
    clock.slow_down(Executor, "_run_pass", 0.75)
    _, steps = run_in_bands(engine, slow_graph(), RenderRequest(), 0.04)
    plan = engine.compile(slow_graph(), RenderRequest())
    rows = [item.groups[1] if item.shader.form == "compute" else SIZE[1] for item in plan.passes if item.writers]
    assert steps >= sum(rows)


def test_quick_code_takes_few_steps(engine, monkeypatch):
    clock = FakeClock(monkeypatch, executor)
    clock.slow_down(Executor, "_run_pass", 1e-4)
    assert run_in_bands(engine, slow_graph(), RenderRequest(), 0.04)[1] < 8


def test_a_picture_in_part_is_not_taken_for_a_whole_one(engine):
    request = RenderRequest(precision="float")
    plan, lease = engine.compile(slow_graph(), request), engine.runner.create_lease()
    with engine.runner.start_run(plan, lease) as run:
        for _ in range(12):
            assert run.step(0.0)
        whole = engine.render(slow_graph(), request)
        while run.step(0.0):
            pass
    same_bits(engine.runner.download(plan), whole)
    lease.close()
    assert whole["image"][-1].any() and whole["image"][0].any()


def test_a_run_that_is_dropped_leaves_nothing(engine):
    plan, lease = engine.compile(slow_graph(), RenderRequest()), engine.runner.create_lease()
    run = engine.runner.start_run(plan, lease)
    for _ in range(12):
        assert run.step(0.0)
    run.close()
    lease.close()
    engine.runner.release_idle()
    assert not run.step(0.0) and engine.runner.textures.allocated == 0


@pytest.mark.parametrize("first", [1, 12])
def test_of_two_runs_that_make_one_picture_one_copy_stays(engine, first):
    """The slower one drops its own as soon as the other is done: one lease alone keeps what a run of its own keeps."""
    request = RenderRequest(precision="float")
    plan, whole = engine.compile(slow_graph(), request), engine.render(slow_graph(), request)
    engine.runner.release_idle()
    leases = [engine.runner.create_lease() for _ in range(2)]
    one, other = (engine.runner.start_run(plan, lease) for lease in leases)
    for _ in range(first):
        assert one.step(0.0)
    while other.step(0.0):
        one.step(0.0)
    while one.step(0.0):
        pass
    one.close(), other.close()
    textures = engine.runner.textures
    kept = {plan.surfaces[number].key for number in plan.outputs.values()}
    assert {*textures._results} == kept and {*textures._leases.values()} == {2}
    leases[1].close()
    assert {*textures._leases.values()} == {1}
    same_bits(engine.runner.download(plan), whole)
    leases[0].close()
    engine.runner.release_idle()
    assert textures.allocated == 0 and not textures._leases


def test_a_pass_that_fails_leaves_nothing_half_drawn(engine, monkeypatch):
    """A fault of the driver, in the middle of a pass or at its end, names the node; the next run draws all of it."""
    request = RenderRequest(precision="float")
    plan, whole = engine.compile(slow_graph(), request), engine.render(slow_graph(), request)
    run_pass, calls = Executor._run_pass, iter(range(99))

    def run_few_bands(*words):
        if next(calls) == 3:
            raise RenderError("the device is lost", node="code")
        return run_pass(*words)

    for owner, name, stand_in, says in (
        (Executor, "_run_pass", run_few_bands, "the device is lost"),
        (type(engine.device), "take_error", lambda _: "GL_OUT_OF_MEMORY", "code.*reports GL_OUT_OF_MEMORY"),
    ):
        engine.runner.release_idle()
        lease = engine.runner.create_lease()
        with monkeypatch.context() as patch, engine.runner.start_run(plan, lease) as run:
            patch.setattr(owner, name, stand_in)
            with pytest.raises(RenderError, match=says) as caught:
                while run.step(0.0):
                    pass
        assert caught.value.node == "code"
        assert not [key for key in engine.runner.textures._results if key.startswith("draft")]
        lease.close()
        same_bits(engine.render(slow_graph(), request), whole)
