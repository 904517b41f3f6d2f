"""Measured seconds, by a clock that goes on only in what is measured."""

from __future__ import annotations

from contextlib import contextmanager
from types import SimpleNamespace

import numpy as np
import pytest
from clocks import FakeClock
from conftest import graph_of
from halation import media
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import Kind
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.nodes.input.noise import Noise
from halation.renderer import FrameRenderer, Renderer, RenderRequest, bench, calibration
from halation.renderer.bench import measure_graph
from halation.renderer.calibration import measure_forms
from halation.renderer.execution import decoding, executor
from halation.renderer.execution.costs import PassCosts
from halation.renderer.execution.executor import Executor
from halation.renderer.execution.runner import Runner
from halation.renderer.jobs import pipeline
from halation.renderer.jobs.job import OutputSettings, run_job
from halation.renderer.jobs.video_writers import VideoWriters
from halation.renderer.opengl import device as opengl_device
from halation.resources.sandbox import UNRESTRICTED
from msgspec.structs import replace


@pytest.fixture
def engine(renderer):
    """A renderer that keeps no results, on the device that all tests share."""
    engine = Renderer(renderer.device, budget=0, sandbox=UNRESTRICTED)
    yield engine
    engine.close()


def blurred() -> Graph:
    graph = Graph(settings=Settings((32, 32), (1, 3))).add("noise", Noise()).add("blur", GaussianBlur(sigma=3.0))
    graph = graph.connect(Port("noise", "out"), Port("blur", "image")).add_output("image", Output(Kind.IMAGE))
    return graph.connect(Port("blur", "out"), Port("outputs", "image"))


def test_a_device_measures_the_work_alone(renderer, monkeypatch):
    """On the software rasterizer by the clock; on others by a timer of the device, which counts nanoseconds."""
    clock, device = FakeClock(monkeypatch, opengl_device), renderer.device
    software = device.with_target(replace(device.target, software=True))
    assert software.time(lambda: clock.spend(3.25)) == 3.25
    hardware = device.with_target(replace(device.target, software=False))
    ran = []

    @contextmanager
    def query():
        yield ran.append("begun")
        ran.append("ended")

    timer = query()
    timer.elapsed = 2_500_000_000
    monkeypatch.setattr(type(hardware), "_timer", timer)
    assert hardware.time(lambda: ran.append("work")) == 2.5
    assert ran == ["begun", "work", "ended"]


def test_a_pass_costs_what_it_took(engine, monkeypatch):
    clock = FakeClock(monkeypatch, executor)
    clock.slow_down(Executor, "_run_pass", 0.75)
    times = []
    monkeypatch.setattr(PassCosts, "record_time", lambda self, plan, render_pass, seconds: times.append(seconds))
    plan = engine.compile(blurred(), RenderRequest())
    engine.runner.run(plan)
    is_known = plan.passes[0].shader.form == "compute" and engine.device.target.software
    assert times == [0.75] * (len(plan.passes) if is_known else 0)


def test_a_picture_costs_decoding_and_writing(engine, monkeypatch):
    clock = FakeClock(monkeypatch, decoding, executor)
    engine = Renderer(engine.device, sandbox=UNRESTRICTED)
    clock.slow_down(engine.runner, "_load", 2.0)
    clock.slow_down(executor, "_convert", 0.5)
    pixels = {"image": np.ones((32, 32, 4), np.float32)}
    plan = engine.compile(graph_of(Exposure(stops=0.7), pixels), RenderRequest(pixels))
    engine.runner.run(plan)
    numbers = plan.uploads[0].surface, plan.outputs["out"]
    picture, result = (engine.runner.textures.find(plan.surfaces[number].key) for number in numbers)
    assert picture.cost == 2.5 and result.cost > 0.0
    engine.close()


def test_a_benchmark_tells_what_happens_once_from_what_repeats(engine, monkeypatch):
    clock = FakeClock(monkeypatch, bench)
    plans = clock.slow_down(FrameRenderer, "plan_frame", 1.0)
    compiles = clock.slow_down(Runner, "compile", 10.0)
    clock.slow_down(bench, "load_frame_inputs", 100.0)
    runs = clock.slow_down(Runner, "measure", 1000.0)
    found = measure_graph(engine, blurred(), RenderRequest(), (1, 2, 3), 2, 1)
    assert (found.planning, found.loading) == (3.0, 300.0 + len(plans) - 3)  # loading looks at the plans again
    assert found.compiling == 10.0 * len(compiles) and len(compiles) >= 3
    assert len(runs) == 9


def test_a_job_tells_planning_rendering_and_writing_apart(engine, monkeypatch, tmp_path):
    clock = FakeClock(monkeypatch, pipeline)
    plans = clock.slow_down(FrameRenderer, "plan_frame", 1.0)
    clock.slow_down(FrameRenderer, "start_runs", 10.0)
    clock.slow_down(Runner, "download", 20.0)
    clock.slow_down(media, "write_picture", 100.0)
    clock.slow_down(VideoWriters, "finish", 1000.0)
    report = run_job(engine, blurred(), RenderRequest(), OutputSettings((("", tmp_path / "out.exr"),)))
    assert report.seconds == {"compile": 1.0, "render": 30.0 + len(plans) - 1, "write": 1100.0}


@pytest.mark.parametrize(
    ("compute", "fragment", "fastest", "turns"),
    [
        ([0.001, 0.04, 0.03, 0.02], [0.002, 0.06, 0.07, 0.01], (0.03, 0.06), 3),  # 0.2 s are enough
        ([9.0, 0.02, 0.03], [9.0, 0.09, 0.01], (0.02, 0.09), 2),
        ([1.0, 0.01, 0.008, 0.009, 0.01, 0.007], [1.0, 0.005, 0.004, 0.006, 0.004, 0.005], (0.007, 0.004), 6),
    ],
    ids=["enough", "slow", "all"],
)
def test_the_faster_form_is_found_without_the_first_turn(renderer, monkeypatch, compute, fragment, fastest, turns):
    """The smallest of a few turns, which end when the passes have taken 0.1 s together."""
    seconds, counts = {"compute": iter(compute), "fragment": iter(fragment)}, []

    def make_runner(device, load, budget):
        def measure(plan):
            counts.append(device.target.form)
            spent = next(seconds[device.target.form])
            return [("noise", 0.25 * spent), ("blur", 0.75 * spent)]

        return SimpleNamespace(device=device, measure=measure, close=lambda: None)

    monkeypatch.setattr(calibration, "Runner", make_runner)
    found = measure_forms(renderer.device, (8, 8), 5)
    assert (found.compute, found.fragment) == pytest.approx(fastest)
    assert counts == ["compute", "fragment"] * turns or counts == ["fragment", "compute"] * turns
