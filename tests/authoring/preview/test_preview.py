"""What panels show while a graph is edited: never nothing where there was something, never work done twice."""

from __future__ import annotations

import threading
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from exr_files import write_exr
from halation.compiler import Library, load_library
from halation.compiler.library import parse
from halation.graph import Graph, Group, Input, Output, Port, Settings
from halation.nodes import Kind, catalogue
from halation.nodes.color.exposure import Exposure
from halation.renderer import RenderRequest
from previews import OUT, PICTURE, chain, count_passes, pixels, render_port, request_preview, settle

NODES = catalogue()


# --- pictures --------------------------------------------------------------------------------------------------------


def test_a_picture_comes_pass_by_pass(preview, engine):
    request_preview(preview, chain())
    assert preview.busy and preview.find_whole_image("A") is None and count_passes(engine) == 0
    calls, done = 0, []
    while preview.work(0.0):
        calls += 1
        done.append(count_passes(engine))
        time.sleep(0.0005)
    total = len(engine.compile(chain(), RenderRequest({"image": PICTURE})).passes)
    assert set(range(1, total + 1)) <= set(done), "one pass a call, when there is no time for more"
    assert not preview.busy and preview.progress == (total, total)
    shown = preview.find_whole_image("A")
    assert (shown.port, shown.size, shown.full_size, shown.kind, shown.channels) == (
        OUT["A"],
        (37, 23),
        (37, 23),
        Kind.IMAGE,
        4,
    )
    np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, chain()))


def test_with_time_enough_one_call_does_it_all(preview, engine):
    request_preview(preview, chain())
    while preview.work(60.0):
        time.sleep(0.0005)  # the picture is decoded on another thread
    np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, chain()))


def test_wanting_the_same_again_costs_nothing(preview, engine):
    graph = chain()
    request_preview(preview, graph)
    settle(preview)
    before, shown, compiled = count_passes(engine), preview.find_whole_image("A"), engine.compile
    engine.compile = None  # nobody asks
    moved = replace(graph, ui={"nodes": {"blur": {"x": 1.0, "y": 2.0}}})
    for same in (graph, chain(), moved, moved):
        request_preview(preview, same)
        assert not preview.busy and not preview.work(0.0)
    engine.compile = compiled
    assert count_passes(engine) == before and preview.find_whole_image("A") == shown


def test_only_what_depends_on_a_change_runs_again(preview, engine):
    request_preview(preview, chain())
    settle(preview)
    before = count_passes(engine)
    request_preview(preview, chain(saturation=0.7))
    settle(preview)
    assert count_passes(engine) == before + 1
    np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, chain(saturation=0.7)))
    request_preview(preview, chain())  # undo
    settle(preview)
    assert count_passes(engine) <= before + 2
    np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, chain()))


def test_the_last_good_picture_stays_until_the_new_one_is_ready(preview, engine):
    request_preview(preview, chain())
    settle(preview)
    old, old_pixels = preview.find_whole_image("A"), pixels(preview, engine).copy()
    engine.runner.textures.budget = 0
    request_preview(preview, chain(stops=3.0, sigma=4.0))
    while preview.work(0.0) and preview.find_whole_image("A") is old:
        np.testing.assert_array_equal(pixels(preview, engine), old_pixels)
    settle(preview)
    new = preview.find_whole_image("A")
    assert new.revision > old.revision and new.key != old.key
    np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, chain(stops=3.0, sigma=4.0)))


def test_a_change_in_the_middle_starts_again(preview, engine):
    request_preview(preview, chain())
    while count_passes(engine) < 2:
        preview.work(0.0)
    request_preview(preview, chain(stops=2.0))
    settle(preview)
    np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, chain(stops=2.0)))


def test_a_long_drag_still_shows_pictures(preview, engine):
    preview.patience = 1e9
    request_preview(preview, chain(stops=0.5))
    settle(preview)
    revisions = set()
    for number in range(40):
        request_preview(preview, chain(stops=1.0 + 0.01 * number))
        preview.work(0.0)
        revisions.add(preview.find_whole_image("A").revision)
    assert len(revisions) > 3
    settle(preview)
    np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, chain(stops=1.0 + 0.01 * 39)))


def test_another_port_does_not_wait_for_the_one_before(preview, engine):
    preview.patience = 1e9
    request_preview(preview, chain())
    preview.work(0.0)
    request_preview(preview, chain(), {"A": Port("inputs", "image")})
    settle(preview)
    assert count_passes(engine) <= 1
    np.testing.assert_array_equal(pixels(preview, engine), PICTURE)


def test_several_panels(preview, engine):
    ports = {"A": Port("blur", "out"), "B": Port("inputs", "image"), "C": Port("outputs", "image")}
    request_preview(preview, chain(), ports)
    settle(preview)
    for name, port in ports.items():
        np.testing.assert_array_equal(pixels(preview, engine, name), render_port(engine, chain(), port))
    request_preview(preview, chain(), OUT)
    assert preview.find_whole_image("B") is None and preview.find_whole_image("A") is not None
    settle(preview)
    assert len(engine.runner.textures._leases) == 1


def test_nothing_wanted_is_nothing_to_do(preview, engine):
    assert not preview.work(0.0) and not preview.busy
    request_preview(preview, chain(), {})
    assert not preview.work(0.0) and not preview.busy and count_passes(engine) == 0


def test_inside_of_groups(preview, engine):
    graph = Graph(inputs={"image": Input()}, outputs={"image": Output()}).add("g", Group(chain()))
    graph = graph.connect(Port("inputs", "image"), Port("g", "image"))
    graph = graph.connect(Port("g", "image"), Port("outputs", "image"))
    ports = {"A": Port("g/blur", "out"), "B": Port("g/inputs", "image"), "C": Port("g", "image")}
    request_preview(preview, graph, ports)
    settle(preview)
    assert not preview.faults
    np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, chain(), Port("blur", "out")))
    np.testing.assert_array_equal(pixels(preview, engine, "B"), PICTURE)
    np.testing.assert_array_equal(pixels(preview, engine, "C"), render_port(engine, chain()))


def test_kinds_of_data(preview, engine):
    graph = Graph(settings=Settings((16, 9))).add("c", NODES["checker"](size=4.0))
    request_preview(preview, graph, {"A": Port("c", "value"), "B": Port("c", "out")}, bindings={})
    settle(preview)
    assert (preview.find_whole_image("A").kind, preview.find_whole_image("A").channels) == (Kind.FIELD, 1)
    assert (preview.find_whole_image("B").kind, preview.find_whole_image("B").channels) == (Kind.IMAGE, 4)


@pytest.mark.parametrize("scale", [0.5, 0.33, 0.1])
def test_a_proxy_knows_its_full_size(preview, engine, scale):
    request_preview(preview, chain(), scale=scale)
    settle(preview)
    shown = preview.find_whole_image("A")
    assert shown.full_size == (37, 23) and shown.scale == scale
    assert shown.size == (round(37 * scale), round(23 * scale))
    np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, chain(), scale=scale))


def test_files_that_change_are_read_again(preview, engine, tmp_path):
    path = tmp_path / "a.exr"
    write_exr(path, {"beauty": np.full((4, 6, 4), 0.5, np.float32)}, {"beauty": "float"})
    request_preview(preview, chain(), {"A": Port("inputs", "image")}, bindings={"image": path})
    settle(preview)
    write_exr(path, {"beauty": np.full((4, 8, 4), 0.75, np.float32)}, {"beauty": "float"})
    preview.work(0.0)
    assert preview.find_whole_image("A").size == (6, 4)
    preview.refresh()
    settle(preview)
    np.testing.assert_array_equal(pixels(preview, engine), np.full((4, 8, 4), 0.75, np.float32))


# --- waiting ---------------------------------------------------------------------------------------------------------


def test_decoding_does_not_hold_up_the_window(preview, engine):
    load, gate = engine.runner._load, threading.Event()

    def slow(picture):
        gate.wait(10.0)
        return load(picture)

    engine.runner._load = slow
    request_preview(preview, chain())
    for _ in range(5):
        assert preview.work(60.0)
    assert count_passes(engine) == 0 and preview.busy
    gate.set()
    settle(preview)
    assert preview.find_whole_image("A") is not None


def test_while_paused_nothing_is_computed(preview, engine):
    request_preview(preview, chain())
    settle(preview)
    before, shown = count_passes(engine), preview.find_whole_image("A")
    preview.paused = True
    request_preview(preview, chain(stops=3.0))
    assert not preview.work(60.0) and count_passes(engine) == before and preview.find_whole_image("A") is shown
    preview.paused = False
    settle(preview)
    np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, chain(stops=3.0)))


# --- what goes wrong -------------------------------------------------------------------------------------------------


def test_a_fault_is_said_where_it_is_and_hides_nothing_else(preview, engine):
    good = {"A": Port("outputs", "image")}
    request_preview(preview, chain(), good)
    settle(preview)
    broken = chain(stops=2.0).add("lonely", Exposure(stops=1.0))
    request_preview(preview, broken, {**good, "B": Port("lonely", "out"), "C": Port("blur", "out")})
    settle(preview)
    assert preview.faults == {"lonely": "node 'lonely': input 'image' is not linked: link a picture to it"}
    assert "not linked" in preview.fault("B") and preview.fault("A") is None and preview.find_whole_image("B") is None
    np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, chain(stops=2.0)))
    np.testing.assert_array_equal(
        pixels(preview, engine, "C"), render_port(engine, chain(stops=2.0), Port("blur", "out"))
    )
    request_preview(preview, broken, good)
    settle(preview)
    assert preview.faults == {}


def test_a_fault_leaves_the_last_good_picture(preview, engine):
    request_preview(preview, chain())
    settle(preview)
    shown = preview.find_whole_image("A")
    request_preview(preview, chain().disconnect(Port("blur", "image")))
    settle(preview)
    assert preview.find_whole_image("A") is shown and set(preview.faults) == {"blur"}
    assert not preview.busy


def test_an_input_without_a_picture(preview):
    request_preview(preview, chain(), bindings={"image": Path("nowhere.exr")})
    settle(preview)
    assert set(preview.faults) == {"inputs.image"} and "nowhere.exr" in preview.faults["inputs.image"]


def test_a_file_that_breaks_while_it_is_read(preview, engine):
    from halation.errors import InputError

    def broken(_):
        raise InputError("a.exr: it ends too soon")

    load, engine.runner._load = engine.runner._load, broken
    request_preview(preview, chain())
    settle(preview)
    assert preview.faults == {"inputs.image": "a.exr: it ends too soon"}
    engine.runner._load = load
    preview.refresh()
    settle(preview)
    assert preview.faults == {} and preview.find_whole_image("A") is not None


def test_shaders_are_loaded_again_while_the_picture_stays(preview, engine):
    def library(text: str) -> Library:
        return Library({**load_library().texts, "color/saturation": parse("color/saturation", text)})

    request_preview(preview, chain())
    settle(preview)
    shown, before = preview.find_whole_image("A"), count_passes(engine)
    preview.reload(library("vec4 saturation(vec4 image, float saturation) { return image + oops; }\n"))
    settle(preview)
    assert preview.find_whole_image("A") is shown and count_passes(engine) == before
    assert "shaders/color/saturation.glsl, line 1" in preview.faults["color"]
    preview.reload(library("vec4 saturation(vec4 image, float saturation) { return image * 0.0; }\n"))
    settle(preview)
    assert preview.faults == {} and count_passes(engine) == before + 1
    assert not pixels(preview, engine).any()
