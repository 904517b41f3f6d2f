"""A person who works fast, files that come and go, little memory: pictures stay right, nothing runs twice or leaks."""

from __future__ import annotations

import math
import random
import threading
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from exr_files import write_exr
from halation.authoring.preview import Preview
from halation.errors import GraphError
from halation.graph import Graph, Group, Output, Port, Settings
from halation.nodes import Kind, catalogue
from previews import IMAGE, PICTURE, chain, count_passes, pixels, render_port, request_preview, settle

NODES = catalogue()
FLOAT = {"Combined": "float"}
TEN = (
    "exposure",
    "saturation",
    "grade",
    "gaussian_blur",
    "vignette",
    "exposure",
    "clip",
    "saturation",
    "bloom",
    "exposure",
)


def ten() -> Graph:
    graph, source = Graph(settings=Settings((160, 90))).add("noise", NODES["noise"]()), Port("noise", "out")
    for number, name in enumerate(TEN):
        first, out = next(iter(NODES[name].inputs)), next(iter(NODES[name].outputs))
        graph = graph.add(f"n{number}", NODES[name]()).connect(source, Port(f"n{number}", first))
        source = Port(f"n{number}", out)
    return graph.add_output("image", Output(Kind.IMAGE)).connect(source, IMAGE)


def test_going_back_and_forth_finds_what_was_computed(preview, engine):
    steps = [chain(), chain(saturation=0.7), chain(sigma=3.0), chain(stops=2.0)]
    for graph in steps:
        request_preview(preview, graph)
        settle(preview)
    before = count_passes(engine)
    for graph in (*reversed(steps), *steps):  # undo, redo
        request_preview(preview, graph)
        settle(preview)
        np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, graph))
    assert count_passes(engine) == before


def test_dragging_the_end_of_a_long_chain_runs_its_end_only(preview, engine):
    graph = ten()
    request_preview(preview, graph, bindings={})
    settle(preview)
    for count in range(1, 9):
        before = count_passes(engine)
        request_preview(preview, graph.set(Port("n9", "stops"), count / 4), bindings={})
        settle(preview)
        assert count_passes(engine) == before + 1


def test_another_pass_begins_only_while_there_is_time(preview, engine):
    request_preview(preview, ten(), bindings={})
    while preview.work(0.0):
        before = count_passes(engine)
        request_preview(preview, ten().set(Port("n9", "stops"), 1.0), bindings={})
        preview.work(0.0)
        assert count_passes(engine) <= before + 1
    assert preview.find_whole_image("A") is not None


def test_a_picture_that_is_removed_broken_and_replaced_while_it_is_edited(preview, engine, tmp_path: Path):
    file = tmp_path / "shot.exr"
    write_exr(file, {"Combined": PICTURE}, FLOAT)
    bound = {"image": file}
    request_preview(preview, chain(), bindings=bound)
    settle(preview)
    shown, whole = preview.find_whole_image("A"), file.read_bytes()
    np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, chain()))

    def spoil_by(act) -> None:
        act()
        preview.refresh()
        settle(preview)
        assert set(preview.faults) == {"inputs.image"} and "shot.exr" in preview.faults["inputs.image"]
        assert preview.find_whole_image("A") is shown and not preview.busy

    spoil_by(file.unlink)
    spoil_by(lambda: file.write_bytes(whole[: len(whole) // 2]))
    spoil_by(lambda: file.write_bytes(b""))
    spoil_by(lambda: file.write_text("this is no picture"))
    write_exr(file, {"Combined": np.zeros((5, 9, 4), np.float32)}, FLOAT)
    preview.refresh()
    settle(preview)
    assert preview.faults == {} and preview.find_whole_image("A").size == (9, 5) and not pixels(preview, engine).any()


def test_a_picture_that_changes_size_between_planning_and_reading(preview, engine, tmp_path: Path):
    file = tmp_path / "shot.exr"
    write_exr(file, {"Combined": PICTURE}, FLOAT)
    load = engine.runner._load

    def slow(picture):
        if picture.path == str(file) and len(seen) == 0:
            seen.append(1)
            write_exr(file, {"Combined": PICTURE[:4, :6]}, FLOAT)
        return load(picture)

    seen: list[int] = []
    engine.runner._load = slow
    request_preview(preview, chain(), bindings={"image": file})
    settle(preview)
    assert "render again" in preview.faults["inputs.image"]
    preview.refresh()  # what the watcher asks for
    settle(preview)
    assert preview.faults == {} and preview.find_whole_image("A").size == (6, 4)


def test_a_panel_whose_port_is_broken_does_not_stop_the_other(preview, engine):
    graph = chain().add("lonely", NODES["exposure"](stops=1.0))
    for stops in (1.0, 2.0, 3.0):
        request_preview(preview, graph.set(Port("light", "stops"), stops), {"A": IMAGE, "B": Port("lonely", "out")})
        settle(preview)
        np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, chain(stops=stops)))
        assert preview.fault("B") and preview.fault("A") is None


def test_with_no_memory_to_spare_pictures_are_right_and_nothing_piles_up(preview, engine):
    engine.runner.textures.budget = 0
    sizes = []
    for count in range(6):
        graph = chain(stops=float(count))
        request_preview(preview, graph)
        settle(preview)
        np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, graph))
        sizes.append(preview.memory[0])
    assert sizes[-1] == sizes[2]


def grouped(depth: int) -> Graph:
    """A chain in a group in a group ..."""
    graph = chain()
    for _ in range(depth):
        outer = Graph(inputs=graph.inputs, outputs=graph.outputs).add("inner", Group(graph))
        graph = outer.connect(Port("inputs", "image"), Port("inner", "image")).connect(Port("inner", "image"), IMAGE)
    return graph


def test_what_is_seen_inside_of_a_group_follows_edits_of_it(preview, engine):
    ports = {"A": Port("inner/inner/blur", "out"), "B": Port("inner/inputs", "image")}
    request_preview(preview, grouped(2), ports)
    settle(preview)
    np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, chain(), Port("blur", "out")))
    np.testing.assert_array_equal(pixels(preview, engine, "B"), PICTURE)
    body = grouped(1)
    inner = body.nodes["inner"]
    changed = replace(inner, graph=inner.graph.set(Port("light", "stops"), 3.0))
    outer = grouped(2)
    graph = outer.replace("inner", replace(outer.nodes["inner"], graph=body.replace("inner", changed)))
    request_preview(preview, graph, ports)
    settle(preview)
    np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, chain(stops=3.0), Port("blur", "out")))
    request_preview(preview, chain(), {"A": Port("light", "out")})  # out of the group again
    settle(preview)
    np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, chain(), Port("light", "out")))


def test_hundreds_of_edits_leave_nothing_behind(preview: Preview, engine):
    rng = random.Random(11)
    types = ("exposure", "grade", "saturation", "gaussian_blur", "clip", "vignette", "edge_detect", "merge")
    graph, step = ten(), 0

    def edited(graph: Graph) -> Graph:
        ids = [id for id in graph.nodes if id != "noise"]
        id, kind = rng.choice(ids), NODES[rng.choice(types)]
        match rng.randrange(5):
            case 0:
                new = graph.fresh_id("more")
                first, out = next(iter(kind.inputs)), next(iter(kind.outputs))
                target = rng.choice(sorted(graph.links, key=str))
                source = graph.links[target]
                return graph.add(new, kind()).connect(source, Port(new, first)).connect(Port(new, out), target)
            case 1:
                return graph.remove(id) if len(ids) > 6 else graph
            case 2:
                return graph.mute(id)
            case 3:
                return graph.disconnect(rng.choice(sorted(graph.links, key=str)))
            case _:
                item = graph.nodes[id]
                name = next((name for name, value in type(item).values.items() if value.type == "float"), "")
                return graph.set(Port(id, name), rng.random()) if name else graph

    marks: list[tuple[int, int]] = []
    while step < 500:
        step += 1
        try:
            graph = edited(graph) if len(graph.nodes) < 20 and len(graph.links) > 4 else ten()
        except GraphError:
            continue
        ports = {"A": IMAGE, "B": Port(rng.choice(list(graph.nodes)), "out")}
        request_preview(preview, graph, ports, bindings={}, scale=rng.choice((1.0, 0.5)))
        for _ in range(rng.randrange(6)):
            preview.work(0.0)
        if step % 100 == 0:
            request_preview(preview, ten(), bindings={})
            settle(preview)
            assert not preview.faults and not engine.device.take_error()
            preview.clear()
            request_preview(preview, ten(), bindings={})
            settle(preview)
            marks.append((preview.memory[0], len(engine.runner.textures._leases)))
    assert len(set(marks)) == 1, marks


def test_a_slow_file_lets_frames_go_on_and_edits_through(preview, engine, tmp_path: Path):
    load, loads, disk = engine.runner._load, [], threading.Event()

    def slow(picture):
        assert disk.wait(60.0)
        loads.append(picture)
        return load(picture)

    engine.runner._load = slow
    frames = 0
    for count in range(1, 5):
        request_preview(preview, chain(stops=float(count)))
        for _ in range(3):
            frames += 1
            preview.work(0.001)
    assert frames == 12 and not loads, "no frame waited"
    disk.set()
    settle(preview)
    assert len(loads) == 1, "what is being read is still wanted after an edit"
    np.testing.assert_array_equal(pixels(preview, engine), render_port(engine, chain(stops=4.0)))


def test_an_urgent_picture_is_complete_at_once(preview):
    """Who cannot wait for the next frame of the window gives it more time; without that, it takes a step."""
    request_preview(preview, chain(stops=3.0))
    while preview.busy and not preview.find_whole_image("A"):  # programs are built beside
        preview.work(0.0, 60.0)
    for stops, urgent in ((4.0, 0.0), (5.0, 60.0)):
        request_preview(preview, chain(stops=stops, sigma=stops))
        preview.work(0.0, urgent)
        assert preview.busy is (urgent == 0.0)


def test_a_run_that_may_go_on_ends_though_the_graph_changes_each_time(preview):
    """Else a picture that takes longer than the patience would never be shown while a stroke is drawn."""
    clock = iter(range(0, 10**9, 100))
    preview.clock, preview.patience = lambda: float(next(clock)), math.inf
    first = preview.find_whole_image("A")
    for count in range(1, 200):
        request_preview(preview, chain(stops=1.0 + 0.001 * count))
        preview.work(0.0)
        time.sleep(0.001)
        if preview.find_whole_image("A") is not first:
            return
    raise AssertionError("no picture was ever shown")
