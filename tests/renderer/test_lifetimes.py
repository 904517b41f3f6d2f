"""Textures, programs and pixels live as long as somebody needs them, whatever goes wrong in between."""

from __future__ import annotations

import gc
import os
import threading
import time
from itertools import zip_longest

import numpy as np
import pytest
from conftest import graph_of
from halation.errors import DeviceError, InputError, UsageError
from halation.graph import Graph, Input, Output, Port, Settings
from halation.nodes import Kind, catalogue
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.nodes.color.saturation import Saturation
from halation.renderer import Renderer, RenderRequest, open_device
from halation.renderer.execution.decoding import MAX_LOOKAHEAD
from halation.resources.machine import resident_memory
from halation.resources.sandbox import UNRESTRICTED

PICTURE = np.random.default_rng(5).random((23, 37, 4), np.float32)


def chain(stops: float = 1.0, sigma: float = 2.0) -> Graph:
    graph = Graph(inputs={"image": Input(Kind.IMAGE)}, outputs={"image": Output()})
    last = Port("inputs", "image")
    nodes = {"light": Exposure(stops=stops), "blur": GaussianBlur(sigma=sigma), "color": Saturation(saturation=0.5)}
    for name, node in nodes.items():
        graph = graph.add(name, node).connect(last, Port(name, "image"))
        last = Port(name, "out")
    return graph.connect(last, Port("outputs", "image"))


def merged(count: int) -> Graph:
    """The sum of `count` pictures."""
    merge = catalogue()["merge"](mode="plus")
    graph = Graph(inputs={f"i{number:02}": Input() for number in range(count)}, outputs={"image": Output()})
    last = Port("inputs", "i00")
    for number in range(1, count):
        graph = graph.add(f"m{number:02}", merge).connect(last, Port(f"m{number:02}", "b"))
        graph = graph.connect(Port("inputs", f"i{number:02}"), Port(f"m{number:02}", "a"))
        last = Port(f"m{number:02}", "out")
    return graph.connect(last, Port("outputs", "image"))


def wanted(picture=PICTURE, **rest) -> RenderRequest:
    return RenderRequest({"image": picture}, precision="float", **rest)


@pytest.fixture
def engine():
    made = Renderer(sandbox=UNRESTRICTED)
    yield made
    made.close()


@pytest.fixture
def forgetful():
    made = Renderer(budget=0, sandbox=UNRESTRICTED)
    yield made
    made.close()


def held(engine: Renderer) -> int:
    """Bytes of all textures that the pool can name."""
    textures = engine.runner.textures
    waiting = [one for kind in textures._free.values() for one in kind]
    return sum(one.nbytes for one in (*textures._results.values(), *waiting))


def test_pictures_of_ever_other_sizes_do_not_pile_up():
    engine = Renderer(budget=2**20, sandbox=UNRESTRICTED)
    for width in range(64, 160):
        engine.render(chain(), wanted(np.zeros((width // 2, width, 4), np.float32)))
    textures, largest = engine.runner.textures, 80 * 160 * 16
    assert textures.allocated == held(engine)
    # The budget, and what this round and the one before did not want any more: five surfaces each.
    assert textures.allocated <= 2**20 + 2 * 5 * largest
    assert not textures._leases
    engine.close()
    assert textures.allocated == 0


def test_two_plans_made_before_either_runs_keep_their_pictures(engine):
    graph = graph_of(Exposure(stops=1.0), {"image": PICTURE})
    plans = [engine.compile(graph, wanted(PICTURE * factor)) for factor in (1.0, 3.0)]
    for plan, factor in zip(plans, (1.0, 3.0), strict=True):
        found = engine.runner.run(plan)["out"]
        np.testing.assert_allclose(found[..., :3], 2.0 * factor * PICTURE[..., :3], rtol=1e-6)


@pytest.mark.parametrize("first", [1, 2, 3])
def test_two_runs_of_a_plan_may_take_turns(renderer, forgetful, first):
    plan = forgetful.compile(chain(), wanted())
    kept = [forgetful.runner.create_lease(), forgetful.runner.create_lease()]
    one, other = (forgetful.runner.start_run(plan, lease) for lease in kept)
    for _ in range(first):
        next(one)
    for _ in zip_longest(other, one):
        pass
    expected = renderer.render(chain(), wanted())["image"]
    for lease in kept:
        np.testing.assert_array_equal(forgetful.runner.download(plan)["image"], expected)
        lease.close()
    assert forgetful.runner.textures.allocated == held(forgetful)
    assert not forgetful.runner.textures._leases


def test_dropping_a_run_does_not_disturb_the_next(renderer, forgetful):
    plan, kept = forgetful.compile(chain(), wanted()), forgetful.runner.create_lease()
    old, new = forgetful.runner.start_run(plan, forgetful.runner.create_lease()), forgetful.runner.start_run(plan, kept)
    next(old), next(old), next(new)
    old.close()
    for _ in new:
        pass
    expected = renderer.render(chain(), wanted())["image"]
    np.testing.assert_array_equal(forgetful.runner.download(plan)["image"], expected)
    kept.close()


def test_outputs_stay_on_the_device_as_long_as_they_are_leased(forgetful):
    plan, kept = forgetful.compile(chain(), wanted()), forgetful.runner.create_lease()
    key = plan.surfaces[plan.outputs["image"]].key
    for _ in forgetful.runner.start_run(plan, kept):
        pass
    texture = forgetful.runner.textures.find(key)
    assert texture is not None and texture.handle.size == (37, 23)
    for stops in (2.0, 3.0):
        forgetful.render(chain(stops), wanted())
    assert forgetful.runner.textures.find(key) is texture
    np.testing.assert_array_equal(
        forgetful.runner.download(plan)["image"], forgetful.render(chain(), wanted())["image"]
    )
    kept.close()
    assert forgetful.runner.textures.find(key) is None


def test_passes_are_timed_on_request(forgetful):
    plan, timings = forgetful.compile(chain(), wanted()), []
    with forgetful.runner.start_run(plan, forgetful.runner.create_lease(), timings=timings) as steps:
        passes = list(steps)
        assert (steps.passes_done, steps.total) == (len(passes), len(plan.passes))
    assert [one for one, _ in timings] == passes == list(plan.passes)
    assert all(seconds > 0.0 for _, seconds in timings)


def test_a_run_says_whether_it_would_wait_for_a_file(forgetful):
    load, gate = forgetful.runner._load, threading.Event()

    def slow(picture):
        gate.wait(10.0)
        return load(picture)

    forgetful.runner._load = slow
    plan = forgetful.compile(chain(), wanted())
    with forgetful.runner.start_run(plan, forgetful.runner.create_lease()) as steps:
        assert not steps.is_ready
        gate.set()
        next(steps)
        assert steps.is_ready
        assert len(list(steps)) == len(plan.passes) - 1
        assert steps.is_ready


def test_two_devices_may_take_turns(renderer):
    engines = [
        Renderer(open_device(form, sandbox=UNRESTRICTED), budget=0, sandbox=UNRESTRICTED)
        for form in ("compute", "fragment")
    ]
    plans = [engine.compile(chain(sigma=9.0), wanted()) for engine in engines]
    pairs = list(zip(engines, plans, strict=True))
    for _ in zip_longest(*(engine.runner.start_run(plan, engine.runner.create_lease()) for engine, plan in pairs)):
        pass
    expected = renderer.render(chain(sigma=9.0), wanted())["image"]
    for engine, plan in pairs:
        np.testing.assert_allclose(engine.runner.download(plan)["image"], expected, rtol=1e-6, atol=1e-6)
        engine.close()
        engine.device.close()


def test_a_device_ends_with_the_last_reference_to_it():
    """Six devices with a texture of 64 MiB each."""
    sizes = []
    for _ in range(6):
        texture = open_device(sandbox=UNRESTRICTED).create_texture((2048, 2048), 4, "f4")
        sizes.append(resident_memory(os.getpid()))
        del texture
        gc.collect()
    assert sizes[-1] < sizes[0] + 2 * 64 * 2**20


def test_every_thread_needs_a_device_of_its_own(renderer, engine):
    found: list[np.ndarray | UsageError] = []

    def borrowed() -> None:
        try:
            engine.render(chain(1.3), wanted())
        except UsageError as fault:
            found.append(fault)

    def own() -> None:
        mine = Renderer(sandbox=UNRESTRICTED)
        found.append(mine.render(chain(1.3), wanted())["image"])
        mine.close()

    for work in (borrowed, own):
        thread = threading.Thread(target=work, name="helper")
        thread.start()
        thread.join()
    assert "thread 'helper' did not open this device" in str(found[0])
    assert not engine.runner.textures._results and not engine.runner.textures._leases
    for one in (renderer, engine):
        np.testing.assert_array_equal(found[1], one.render(chain(1.3), wanted())["image"])


def test_a_picture_that_changed_its_size_spoils_nothing(engine):
    load, graph = engine.runner._load, graph_of(Exposure(stops=1.0), {"image": PICTURE})
    engine.runner._load = lambda picture: load(picture)[:-2]
    with pytest.raises(InputError, match="it was 37x23 pixels when the rendering began, and is 37x21 now"):
        engine.render(graph, wanted())
    engine.runner._load = load
    np.testing.assert_allclose(engine.render(graph, wanted())["out"][..., :3], 2.0 * PICTURE[..., :3], rtol=1e-6)


def test_an_upload_that_is_interrupted_spoils_nothing(engine, monkeypatch):
    from halation.renderer.execution import executor

    def interrupt(*_):
        raise KeyboardInterrupt

    graph, convert = graph_of(Exposure(stops=1.0), {"image": PICTURE}), executor._convert
    monkeypatch.setattr(executor, "_convert", interrupt)
    with pytest.raises(KeyboardInterrupt):
        engine.render(graph, wanted())
    monkeypatch.setattr(executor, "_convert", convert)
    np.testing.assert_allclose(engine.render(graph, wanted())["out"][..., :3], 2.0 * PICTURE[..., :3], rtol=1e-6)


def test_a_pass_without_room_for_all_its_outputs_leaves_none(engine, monkeypatch):
    graph = Graph(outputs={"image": Output(), "mask": Output(Kind.FIELD)}, settings=Settings((16, 9)))
    graph = graph.add("c", catalogue()["checker"](size=4.0)).connect(Port("c", "out"), Port("outputs", "image"))
    graph = graph.connect(Port("c", "value"), Port("outputs", "mask"))
    textures, calls = engine.runner.textures, []
    allocate = textures._allocate

    def second_fails(*arguments):
        calls.append(arguments)
        if len(calls) == 2:
            raise DeviceError("no room")
        return allocate(*arguments)

    monkeypatch.setattr(textures, "_allocate", second_fails)
    with pytest.raises(DeviceError, match="no room"):
        engine.render(graph)
    assert not textures._results and not textures._leases
    assert set(np.unique(engine.render(graph)["mask"])) == {0.0, 1.0}


def test_results_make_room_before_an_allocation_fails(engine, monkeypatch):
    """The budget is a wish: what the device can hold is less."""
    textures = engine.runner.textures
    real, room = textures._try_create, 16 * PICTURE.nbytes

    def limited(kind):
        width, height, components, _ = kind
        return real(kind) if textures.allocated + width * height * components * 4 <= room else None

    monkeypatch.setattr(textures, "_try_create", limited)
    for stops in range(12):
        picture = PICTURE + np.float32(stops)
        engine.render(chain(stops + 0.5), wanted(picture))
    assert textures.allocated <= room


def test_only_a_few_pictures_are_decoded_ahead(forgetful):
    count, loaded = 8 + 2 * MAX_LOOKAHEAD, []
    load = forgetful.runner._load

    def watched(picture):
        loaded.append(picture.path)
        return load(picture)

    forgetful.runner._load = watched
    pictures = {f"i{number:02}": PICTURE * (number + 1) for number in range(count)}
    plan = forgetful.compile(merged(count), RenderRequest(pictures, precision="float"))
    kept = forgetful.runner.create_lease()
    steps = forgetful.runner.start_run(plan, kept)
    next(steps)
    taken = len(plan.passes[0].textures)
    time.sleep(0.1)
    assert len(loaded) <= taken + MAX_LOOKAHEAD < count
    for _ in steps:
        pass
    assert sorted(loaded) == sorted(pictures)
    result = forgetful.runner.download(plan)
    kept.close()
    np.testing.assert_allclose(result["image"][..., :3], PICTURE[..., :3] * count * (count + 1) / 2, rtol=1e-5)


def test_a_loader_that_fails_on_its_thread_is_heard(forgetful):
    load, calls = forgetful.runner._load, []

    def second_fails(picture):
        calls.append(picture)
        if len(calls) == 2:
            raise InputError("broken.exr: it ends too soon")
        return load(picture)

    forgetful.runner._load = second_fails
    pictures = RenderRequest({"i00": PICTURE, "i01": PICTURE, "i02": PICTURE}, precision="float")
    with pytest.raises(InputError, match="ends too soon"):
        forgetful.render(merged(3), pictures)
    assert not forgetful.runner.textures._leases
    found = forgetful.render(merged(3), pictures)["image"]
    np.testing.assert_allclose(found[..., :3], 3.0 * PICTURE[..., :3], rtol=1e-6)


def test_a_picture_that_was_begun_for_a_dropped_run_is_not_decoded_again(forgetful):
    load, loaded, gate = forgetful.runner._load, [], threading.Event()

    def slow(picture):
        loaded.append(picture.path)
        gate.wait(10.0)
        return load(picture)

    forgetful.runner._load = slow
    for stops in (1.0, 2.0, 3.0):
        dropped = forgetful.runner.start_run(forgetful.compile(chain(stops), wanted()), forgetful.runner.create_lease())
        while not loaded:
            time.sleep(0.001)
        dropped.close()
    gate.set()
    forgetful.render(chain(4.0), wanted())
    assert loaded == ["image"] and not forgetful.runner._leftovers


def test_programs_that_were_not_used_for_long_go(renderer, engine, monkeypatch):
    monkeypatch.setattr(engine.runner.programs._programs, "_limit", 2)
    for _ in range(2):
        for sigma in (2.0, 9.0):
            found = engine.render(chain(sigma=sigma), wanted(PICTURE * (1 + engine.runner.counters.passes)))["image"]
            assert np.isfinite(found).all()
    assert len(engine.runner.programs._programs._resources) == 2
    assert engine.runner.programs.compiled > 6
    np.testing.assert_array_equal(
        engine.render(chain(), wanted())["image"], renderer.render(chain(), wanted())["image"]
    )


def test_closing_gives_everything_back():
    threads = threading.active_count()
    for _ in range(4):
        engine = Renderer(sandbox=UNRESTRICTED)
        engine.render(chain(sigma=9.0), wanted())
        engine.close()
        assert (engine.runner.textures.allocated, engine.runner._executor._weights._resources) == (0, {})
    assert threading.active_count() == threads


def test_a_closed_renderer_says_so():
    engine = Renderer(sandbox=UNRESTRICTED)
    kept = engine.runner.create_lease()
    steps = engine.runner.start_run(engine.compile(chain(), wanted()), kept)
    next(steps)
    engine.close()
    steps.close()
    kept.close()
    engine.close()
    with pytest.raises(UsageError, match="renderer is closed"):
        engine.render(chain(), wanted())


@pytest.mark.parametrize("budget", [0, PICTURE.nbytes])
def test_a_tiny_budget_changes_no_pixel(renderer, budget):
    engine = Renderer(budget=budget, sandbox=UNRESTRICTED)
    for stops, sigma in ((1.0, 2.0), (2.0, 9.0), (1.0, 2.0), (1.0, 9.0), (2.0, 9.0)):
        found = engine.render(chain(stops, sigma), wanted())["image"]
        np.testing.assert_array_equal(found, renderer.render(chain(stops, sigma), wanted())["image"])
    engine.close()
