"""What plans ask of a device, checked on one without pixels: order, lifetimes, and nothing done twice."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from halation import document
from halation.compiler import NULL, Plan
from halation.graph import Graph
from halation.presets import paths
from halation.renderer import Device, FrameRenderer, Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED
from msgspec.structs import replace
from null_device import NullDevice

PRESETS = {path.stem: path for path in paths()}
MOVING = ("feedback_tunnel", "heartbeat", "light_painting", "long_exposure", "turntable")
LARGE = ("soft_bloom", "cinematic_grade", "night_street", "post_stack")
TILED = ("soft_bloom", "cinematic_grade", "dreamy_glow", "neon_edges")
SMALL = RenderRequest(scale=0.25)


@pytest.fixture(params=["compute", "fragment"])
def device(request: pytest.FixtureRequest) -> NullDevice:
    return NullDevice(replace(NULL, form=request.param))


@pytest.fixture
def renderer(device: NullDevice) -> Iterator[Renderer]:
    """Keeps no result that nobody leases."""
    protocol: Device = device
    engine = Renderer(protocol, budget=0, sandbox=UNRESTRICTED)
    yield engine
    engine.close()
    assert not device.live, "not everything was released"


def leased(renderer: Renderer) -> set[str]:
    return set(renderer.runner.textures._leases)


def needed_later(plan: Plan, done: int) -> set[str]:
    """The keys of surfaces that are there after so many passes and read later, or outputs."""
    there = {number for render_pass in plan.passes[:done] for number in (*render_pass.textures, *render_pass.targets)}
    later = {number for render_pass in plan.passes[done:] for number in render_pass.textures}
    return {plan.surfaces[number].key for number in there & (later | {*plan.outputs.values()})}


@pytest.mark.parametrize("name", PRESETS)
def test_every_preset_runs_as_it_was_planned(renderer: Renderer, device: NullDevice, name: str):
    graph = document.load(PRESETS[name], sandbox=UNRESTRICTED)
    plan = renderer.compile(graph, replace(SMALL, frame=renderer.find_frames(graph)[0]))
    lease = renderer.runner.create_lease()
    with renderer.runner.start_run(plan, lease) as run:
        for done, render_pass in enumerate(run, 1):
            assert render_pass == plan.passes[done - 1]
            assert needed_later(plan, done) <= leased(renderer)
            unread = {plan.surfaces[number].key for each in plan.passes[:done] for number in each.targets}
            unread -= {plan.surfaces[number].key for each in plan.passes for number in each.textures}
            assert leased(renderer) <= needed_later(plan, done) | unread, "it stays after its last reader"
    assert leased(renderer) == {plan.surfaces[number].key for number in plan.outputs.values()}
    renderer.runner.download(plan)
    lease.close()
    assert [command.source for command in device.commands] == [each.shader.source for each in plan.passes]
    assert [len(command.targets) for command in device.commands] == [len(each.targets) for each in plan.passes]
    assert len(device.writes) == len(plan.uploads) and len(device.reads) == len(plan.outputs)
    assert device.created_textures <= len(plan.surfaces)
    assert not leased(renderer)


@pytest.mark.parametrize("name", LARGE)
def test_results_that_stay_are_not_made_again(device: NullDevice, name: str):
    graph, engine = document.load(PRESETS[name], sandbox=UNRESTRICTED), Renderer(device, sandbox=UNRESTRICTED)
    for _ in range(2):
        engine.render(graph, SMALL)
    plan = engine.compile(graph, SMALL)
    assert len(device.commands) == len(plan.passes) and len(device.writes) == len(plan.uploads)
    assert len(device.reads) == 2 * len(plan.outputs)
    engine.close()
    assert not device.live


@pytest.mark.parametrize("name", MOVING)
def test_frames_in_order_run_each_plan_once(renderer: Renderer, device: NullDevice, name: str):
    graph = document.load(PRESETS[name], sandbox=UNRESTRICTED)
    frames = FrameRenderer(renderer, graph, SMALL)
    first = frames.frames[0]
    for frame in range(first, first + 3):
        before = len(device.commands)
        assert not frames.find_lead_frames(frame), "what the frame before remembered is on the device"
        frames.render_frame(frame)
        assert len(device.commands) - before <= len(frames.plan_frame(frame).passes)
    frames.close()
    assert not leased(renderer)


def test_a_frame_alone_is_led_up_to(renderer: Renderer, device: NullDevice):
    graph = document.load(PRESETS["light_painting"], sandbox=UNRESTRICTED)
    frames = FrameRenderer(renderer, graph, SMALL)
    first = frames.frames[0]
    assert list(frames.find_lead_frames(first + 3)) == [first, first + 1, first + 2]
    frames.render_frame(first + 3)
    assert len(device.reads) == len(frames.plan_frame(first + 3).outputs), "frames on the way are not read back"
    frames.close()
    assert not leased(renderer)


def tiled(graph: Graph, device: NullDevice) -> Plan:
    """A plan for less memory than it needs; the device is told."""
    engine = Renderer(device, budget=0, sandbox=UNRESTRICTED)
    needed = engine.compile(graph, SMALL).held_bytes
    engine.close()
    device.with_target(replace(device.target, memory=needed * 2 // 3))
    engine = Renderer(device, budget=0, sandbox=UNRESTRICTED)
    plan = engine.compile(graph, SMALL)
    engine.close()
    return plan


@pytest.mark.parametrize("name", TILED)
def test_tiles_stay_within_their_memory(device: NullDevice, name: str):
    graph = document.load(PRESETS[name], sandbox=UNRESTRICTED)
    plan = tiled(graph, device)
    assert plan.tiling is not None
    engine = Renderer(device, budget=0, sandbox=UNRESTRICTED)
    lease = engine.runner.create_lease()
    with engine.runner.start_run(plan, lease) as run:
        passes = sum(1 for _ in run)
        assert passes == run.passes_done <= run.total
    pixels = engine.runner.download(plan)
    sizes = {name: plan.surfaces[number].size for name, number in plan.outputs.items()}
    assert {name: array.shape[1::-1] for name, array in pixels.items()} == sizes
    assert engine.runner.textures.peak <= device.target.memory
    lease.close()
    assert not leased(engine)
    engine.close()
    assert not device.live
