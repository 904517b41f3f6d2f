"""What runs, what is kept, and what is said when something does not work."""

from __future__ import annotations

import signal

import numpy as np
import pytest
from conftest import graph_of
from halation.compiler import Library, Region, load_library
from halation.compiler.library import parse
from halation.errors import DeviceError, ShaderError, UsageError
from halation.graph import Graph, Input, Output, Port
from halation.nodes import Kind
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.nodes.color.saturation import Saturation
from halation.renderer import Renderer, RenderRequest, open_device
from halation.renderer.execution.texture_pool import TexturePool
from halation.renderer.opengl import program
from halation.resources.sandbox import UNRESTRICTED
from msgspec.structs import replace

PICTURE = np.random.default_rng(1).random((23, 37, 4), np.float32)


def chain(stops: float, sigma: float, saturation: float) -> Graph:
    graph = Graph(inputs={"image": Input(Kind.IMAGE)}, outputs={"image": Output()})
    graph = graph.add("light", Exposure(stops=stops)).add("blur", GaussianBlur(sigma=sigma))
    graph = graph.add("color", Saturation(saturation=saturation))
    for source, target in (
        ("inputs.image", "light.image"),
        ("light.out", "blur.image"),
        ("blur.out", "color.image"),
        ("color.out", "outputs.image"),
    ):
        graph = graph.connect(Port.parse(source), Port.parse(target))
    return graph


@pytest.fixture
def engine():
    made = Renderer(open_device(sandbox=UNRESTRICTED), sandbox=UNRESTRICTED)
    yield made
    made.close()


def test_a_second_render_executes_no_pass(engine):
    wanted = RenderRequest({"image": PICTURE})
    engine.render(chain(1.0, 2.0, 0.5), wanted)
    passes, uploads = engine.runner.counters.passes, engine.runner.counters.uploads
    assert passes == 4
    engine.render(chain(1.0, 2.0, 0.5), wanted)
    assert (engine.runner.counters.passes, engine.runner.counters.uploads) == (passes, uploads)


def test_changing_a_value_compiles_nothing(engine):
    wanted = RenderRequest({"image": PICTURE})
    engine.render(chain(1.0, 2.0, 0.5), wanted)
    compiled = engine.runner.programs.compiled
    for stops, sigma, saturation in ((2.0, 2.0, 0.5), (1.0, 1.8, 0.5), (1.0, 2.0, 1.5), (-3.0, 1.9, 0.0)):
        engine.render(chain(stops, sigma, saturation), wanted)
    assert engine.runner.programs.compiled == compiled


def test_radii_share_programs(engine):
    """Few taps are written out, in classes: all radii there are take a handful of programs."""
    wanted = RenderRequest({"image": PICTURE})
    for sigma in np.geomspace(0.3, 60.0, 150):
        engine.render(chain(1.0, float(sigma), 0.5), wanted)
    # Five lengths and two decimations, along both axes; an enlargement; all last steps with their reader as well.
    assert engine.runner.programs.compiled <= 20


def test_only_what_depends_on_a_value_runs_again(engine):
    wanted = RenderRequest({"image": PICTURE})
    engine.render(chain(1.0, 2.0, 0.5), wanted)
    before = engine.runner.counters.passes
    engine.render(chain(1.0, 2.0, 0.7), wanted)
    assert engine.runner.counters.passes == before + 1


def test_a_changed_array_is_not_taken_for_the_old_one(engine):
    graph, picture = graph_of(Exposure(stops=1.0), {"image": PICTURE}), PICTURE.copy()
    first = engine.render(graph, RenderRequest({"image": picture}))["out"]
    picture *= 0.5
    np.testing.assert_allclose(
        engine.render(graph, RenderRequest({"image": picture}))["out"][..., 0], first[..., 0] * 0.5
    )


def test_results_stay_within_the_budget():
    engine = Renderer(open_device(sandbox=UNRESTRICTED), budget=2 * PICTURE.nbytes, sandbox=UNRESTRICTED)
    for stops in range(1, 12):
        engine.render(chain(float(stops), 2.0, 0.5), RenderRequest({"image": PICTURE}))
    assert engine.runner.textures.allocated <= 2 * PICTURE.nbytes + 4 * PICTURE.nbytes
    engine.close()


def test_half_floats_are_rounded_not_truncated(run):
    picture = np.full((4, 64, 4), 1.0, np.float32)
    picture[..., :3] = np.linspace(0.1, 7.0, 64, dtype=np.float32)[None, :, None]
    result = run(Exposure(stops=0.3), {"image": picture}, precision="half")
    exact = picture[..., :3].astype(np.float64) * 2.0**0.3
    # Half an ulp: 11 significant bits.
    assert np.all(np.abs(result[..., :3] - exact) <= exact * 2.0**-11 * 1.0001)


def test_half_floats_saturate_instead_of_overflowing(run):
    picture = np.full((1, 1, 4), 60000.0, np.float32)
    assert np.all(run(Exposure(stops=5.0), {"image": picture}, precision="half")[..., :3] == 65504.0)


def test_a_broken_shader_names_node_file_and_line():
    texts = dict(load_library().texts)
    broken = "vec4 exposure(vec4 image, float stops) {\n    float unused = 1.0;\n    return image * stosp;\n}\n"
    texts["color/exposure"] = parse("color/exposure", broken)
    engine = Renderer(open_device(sandbox=UNRESTRICTED), library=Library(texts), sandbox=UNRESTRICTED)
    with pytest.raises(ShaderError) as caught:
        engine.render(graph_of(Exposure(stops=1.0), {"image": PICTURE}), RenderRequest({"image": PICTURE}))
    fault = caught.value
    assert (fault.node, fault.file, fault.line) == ("node", "shaders/color/exposure.glsl", 3)
    assert "stosp" in str(fault)
    engine.close()


def test_a_failed_allocation_is_one_sentence_with_numbers(engine, monkeypatch):
    monkeypatch.setattr(TexturePool, "_try_create", lambda *_: None)
    with pytest.raises(DeviceError, match=r"no room for .* MiB more .*--scale"):
        engine.render(graph_of(Exposure(stops=1.0), {"image": PICTURE}), RenderRequest({"image": PICTURE}))


def test_more_pixels_than_the_device_has_are_made_by_tiles(engine):
    limit = engine.device.target.max_size
    graph = Graph(inputs={"image": Input(Kind.IMAGE)}, outputs={"image": Output()})
    graph = graph.add("light", Exposure(stops=1.0)).connect(Port("inputs", "image"), Port("light", "image"))
    graph = graph.connect(Port("light", "out"), Port("outputs", "image"))
    wanted = RenderRequest({"image": PICTURE}, size=(limit + 1, 8))
    pixels = engine.render(graph, wanted)["image"]
    assert pixels.shape == (8, limit + 1, 4)
    middle = Region(limit // 2 - 100, 0, 200, 8)
    part = engine.render(graph, replace(wanted, region=middle))["image"]
    np.testing.assert_array_equal(part, pixels[:, middle.x : middle.x + 200])


def test_an_unknown_input_is_named_with_those_there_are(engine):
    with pytest.raises(UsageError, match="no input 'beuaty': its inputs are image"):
        engine.render(chain(1.0, 2.0, 0.5), RenderRequest({"beuaty": PICTURE}))


def test_stopping_between_passes_leaves_nothing_behind(engine):
    plan = engine.compile(chain(1.0, 2.0, 0.5), RenderRequest({"image": PICTURE}))
    steps = engine.runner.start_run(plan, engine.runner.create_lease())
    next(steps)
    steps.close()
    result = engine.render(chain(1.0, 2.0, 0.5), RenderRequest({"image": PICTURE}))["image"]
    fresh = Renderer(open_device(sandbox=UNRESTRICTED), sandbox=UNRESTRICTED)
    np.testing.assert_array_equal(
        result, fresh.render(chain(1.0, 2.0, 0.5), RenderRequest({"image": PICTURE}))["image"]
    )
    fresh.close()


@pytest.mark.parametrize("size", [(1, 1), (1, 7), (19, 12), (64, 40), (111, 70)])
def test_size_replaces_the_size_of_pictures(run, size):
    graph = graph_of(Exposure(stops=1.0), {"image": PICTURE})
    assert run(graph, {"image": PICTURE}, size=size).shape == (size[1], size[0], 4)


def test_shrinking_averages_like_openimageio(run):
    """The triangle filter of OpenImageIO's resize, away from the borders."""
    import OpenImageIO as oiio

    picture = np.random.default_rng(3).random((64, 96, 4), np.float32)
    spec = oiio.ImageSpec(48, 32, 4, "float")
    small = oiio.ImageBuf(spec)
    oiio.ImageBufAlgo.resize(small, oiio.ImageBuf(picture), filtername="triangle", filterwidth=2.0)
    ours = run(graph_of(Exposure(stops=1e-9), {"image": picture}), {"image": picture}, scale=0.5)
    np.testing.assert_allclose(ours[2:-2, 2:-2], small.get_pixels()[2:-2, 2:-2], atol=2e-6)


def test_an_interrupt_during_compilation_is_heard_after_it(engine, monkeypatch):
    """moderngl crashes the process if an exception is raised in the middle of it."""
    finish = program._bind_weights
    reached = []

    def interrupted(compiled):
        if not reached:
            signal.raise_signal(signal.SIGINT)
        reached.append(compiled)
        return finish(compiled)

    monkeypatch.setattr(program, "_bind_weights", interrupted)
    handler = signal.getsignal(signal.SIGINT)
    graph = graph_of(Exposure(stops=1.0), {"image": PICTURE})
    with pytest.raises(KeyboardInterrupt):
        engine.render(graph, RenderRequest({"image": PICTURE}))
    assert len(reached) == 1 and signal.getsignal(signal.SIGINT) is handler
    np.testing.assert_allclose(
        engine.render(graph, RenderRequest({"image": PICTURE}))["out"][..., 0], PICTURE[..., 0] * 2.0
    )
    assert len(reached) == 2


@pytest.mark.parametrize(
    ("log", "line", "fault"),
    [
        ("linking failed\n  error: too many uniforms \nmore\nerror: another", 1, "error: too many uniforms"),
        ("\n  the driver gave up  \n", 1, "the driver gave up"),
        ("ERROR: out of registers", 1, "ERROR: out of registers"),
    ],
)
def test_a_fault_without_a_line_is_of_the_whole_program(renderer, monkeypatch, log, line, fault):
    """The last file of the pass is the node's own; those before it are what it includes."""
    graph = chain(1.25, 2.0, 0.5)
    engine = Renderer(renderer.device, budget=0, sandbox=UNRESTRICTED)

    def refuse(*_):
        raise DeviceError(log)

    for name in ("create_program", "create_compute_program"):
        monkeypatch.setattr(type(renderer.device), name, refuse)
    plan = engine.compile(graph, RenderRequest({"image": PICTURE}))
    for render_pass in plan.passes:
        with pytest.raises(ShaderError) as caught:
            engine.runner.compile(render_pass)
        assert (caught.value.line, caught.value.fault) == (line, fault)
        assert caught.value.file == render_pass.shader.files[-1]
        assert f"{caught.value.node}" == ", ".join(render_pass.nodes)
    assert len(plan.passes[-1].shader.files) > 1 or len(plan.passes[0].shader.files) > 1
    engine.close()
