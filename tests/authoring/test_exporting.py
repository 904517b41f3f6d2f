"""Exports: real processes that write real files, fail with a sentence, and stop when told."""

from __future__ import annotations

import os
import sys
import time
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from exr_files import write_exr
from halation.authoring.render_queue.queue import RenderJob, RenderQueue
from halation.errors import UsageError
from halation.graph import Expression, Graph, Group, Input, Output, Port, Settings
from halation.media import read_layer
from halation.nodes import Kind, catalogue
from halation.resources.sandbox import UNRESTRICTED

LEVEL = 0.5
make_job = partial(RenderJob, sandbox=UNRESTRICTED)


@pytest.fixture
def folder(tmp_path):
    """A project with one picture, away from the current folder."""
    made = tmp_path / "project"
    made.mkdir()
    write_exr(made / "a.exr", {"Combined": np.full((16, 24, 4), LEVEL, np.float32)}, {"Combined": "half"})
    return made


@pytest.fixture
def exports():
    made = RenderQueue(sandbox=UNRESTRICTED)
    yield made
    made.close()


def brighter(folder, count=1, sigma=0.0):
    """A graph that doubles its picture, or blurs it `count` times."""
    graph = Graph(folder=str(folder)).add_input("beauty", Input(file="a.exr")).add_output("image", Output())
    source = Port("inputs", "beauty")
    for number in range(count):
        node = catalogue()["gaussian_blur"](sigma=sigma + number) if sigma else catalogue()["exposure"](stops=1.0)
        graph = graph.add(f"n{number}", node).connect(source, Port(f"n{number}", "image"))
        source = Port(f"n{number}", "out")
    return graph.connect(source, Port("outputs", "image"))


def test_an_unsaved_graph_is_written_with_progress(exports, folder, tmp_path):
    out = tmp_path / "out.exr"
    one = exports.start(brighter(folder, 3, sigma=1.0), [("image", out), ("", tmp_path / "out.png")])
    assert one.state == "running" and exports.running == (one,)
    assert one.wait(60) and (one.state, one.failure) == ("done", ""), one.failure
    assert one.written_files == (out, tmp_path / "out.png") and (one.done, one.total, one.node) == (1, 1, "n2")
    assert one.fraction == 1.0 and one.seconds > 0.0 and one.seconds_left is None
    assert any("OpenGL" in note for note in one.notes)
    np.testing.assert_allclose(read_layer(str(out), "", Kind.IMAGE, 4, sandbox=UNRESTRICTED).array, LEVEL, rtol=1e-3)
    exports.clear()
    assert exports.all == ()


def test_bindings_options_and_groups(exports, folder, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_exr(Path("b.exr"), {"Combined": np.full((8, 12, 4), 0.25, np.float32)}, {"Combined": "half"})
    body = brighter(folder)
    graph = Graph(folder=str(folder)).add_input("beauty", Input(file="a.exr")).add_output("image", Output())
    graph = graph.add("group", Group(body)).connect(Port("inputs", "beauty"), Port("group", "beauty"))
    graph = graph.connect(Port("group", "image"), Port("outputs", "image"))
    options = make_job(size=(8, 6), scale=0.5, precision="float", compression="none")
    one = exports.start(graph, [("", Path("b out.exr"))], {"beauty": "b.exr:Combined"}, options)
    one.wait()
    assert one.state == "done", one.failure
    array = read_layer(str(tmp_path / "b out.exr"), "", Kind.IMAGE, 4, sandbox=UNRESTRICTED).array
    assert array.shape == (3, 4, 4)
    np.testing.assert_allclose(array[..., 0], 0.5)


def test_failures_are_sentences(exports, folder, tmp_path):
    out = tmp_path / "out.exr"
    out.write_bytes(b"precious")
    broken = brighter(folder).add("lost", catalogue()["read_image"](path="gone.exr"))
    broken = broken.connect(Port("lost", "out"), Port("n0", "image"))
    unlinked = brighter(folder).disconnect(Port("n0", "image"))
    cases = [
        (broken, out, "gone.exr"),
        (unlinked, out, "n0"),
        (brighter(folder), tmp_path / "no" / "out.exr", "no such folder"),
        (brighter(folder), folder / "a.exr", "is read by 'beauty'"),
        (brighter(folder), tmp_path / "out.xyz", ".xyz"),
    ]
    running = [(exports.start(graph, [("", path)]), words) for graph, path, words in cases]
    for one, words in running:
        one.wait()
        assert one.state == "failed" and words in one.failure and one.written_files == (), one.failure
        assert not one.failure.startswith(("-", "halation")) and "Traceback" not in one.failure
    assert out.read_bytes() == b"precious" and not list(tmp_path.rglob(".halation-*"))


def test_what_makes_no_sense_is_refused_at_once(exports, folder):
    with pytest.raises(UsageError, match="choose a file"):
        exports.start(brighter(folder), [])
    with pytest.raises(UsageError, match="'beauty' is a picture in memory"):
        exports.start(brighter(folder), [("", folder / "x.exr")], {"beauty": np.zeros((2, 2, 4))})
    assert exports.all == ()


@pytest.mark.parametrize("passes", [0, 1, 5])
def test_cancelling_leaves_nothing(exports, folder, tmp_path, passes):
    out = tmp_path / "out.exr"
    out.write_bytes(b"precious")
    one = exports.start(brighter(folder, 200, sigma=30.0), [("", out)], options=make_job(size=(1600, 1200)))
    while one.passes[0] < passes:
        assert one.state == "running", one.failure
        time.sleep(0.01)
    one.cancel()
    one.cancel()
    assert one.wait(60) and one.state == "cancelled" and one.written_files == ()
    assert out.read_bytes() == b"precious" and list(tmp_path.glob(".*")) == []


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_one_that_does_not_listen_is_killed_and_its_part_removed(exports, folder, tmp_path, monkeypatch):
    """A render that is stuck while it writes."""
    code = (
        "import os, signal, sys, time; from pathlib import Path; from halation.resources.atomic_write import "
        "temporary_prefix;"
        "[signal.signal(each, signal.SIG_IGN) for each in (signal.SIGINT, signal.SIGTERM)];"
        "Path(temporary_prefix(os.getpid()) + 'x.exr').touch();"
        "print('ready', file=sys.stderr, flush=True); time.sleep(60)"
    )
    script = tmp_path / "stuck"
    script.write_text(f"#!/bin/sh\nexec '{sys.executable}' -c \"{code}\"\n")
    script.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(script))
    (folder / ".halation-1-other.exr").touch()
    one = exports.start(brighter(folder), [("", folder / "out.exr")])
    while "ready" not in one.notes:
        assert one.state == "running", one.notes
        time.sleep(0.01)
    assert len(list(folder.glob(".halation-*"))) == 2
    one.cancel()
    assert one.wait(30) and one.state == "cancelled", "it would sleep for a minute"
    assert [path.name for path in folder.glob(".halation-*")] == [".halation-1-other.exr"]


def test_one_that_dies_says_so(exports, folder):
    one = exports.start(
        brighter(folder, 100, sigma=30.0),
        [("", folder / "out.exr")],
        options=make_job(size=(900, 900)),
    )
    one._process.kill()
    one.wait()
    assert one.state == "failed" and "signal 9" in one.failure


def test_closing_cancels_or_waits(folder, tmp_path):
    waited, cancelled = RenderQueue(sandbox=UNRESTRICTED), RenderQueue(sandbox=UNRESTRICTED)
    one = waited.start(brighter(folder), [("", tmp_path / "one.exr")])
    waited.close(wait=True)
    long = brighter(folder, 200, sigma=30.0)
    two = cancelled.start(long, [("", tmp_path / "two.exr")], options=make_job(size=(900, 900)))
    cancelled.close()
    assert (one.state, two.state) == ("done", "cancelled")
    assert [path.name for path in tmp_path.glob("*.exr")] == ["one.exr"]


def test_modules_beside_a_graph_are_not_run(exports, folder, tmp_path):
    (folder / "json.py").write_text("raise SystemExit('run')")
    (folder / "numpy.py").write_text("raise SystemExit('run')")
    one = exports.start(brighter(folder), [("", tmp_path / "out.exr")])
    one.wait()
    assert one.state == "done", one.failure


def shot(folder, count=3, sigma=0.0):
    """A graph whose frames differ."""
    graph = brighter(folder, 1, sigma)
    port = Port("n0", "sigma" if sigma else "stops")
    graph = graph.animate(port, Expression(f"frame * {0.5 if not sigma else 3.0}"))
    return replace(graph, settings=Settings(frames=(1, count)))


def names(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("jobs", [1, 2])
def test_many_frames_are_counted_and_shared(exports, folder, tmp_path, jobs):
    out = tmp_path / "out"
    out.mkdir()
    one = exports.start(
        shot(folder),
        [("", out / "s.####.exr")],
        options=make_job(frames=(1, 2, 5), processes=jobs),
    )
    assert (one.done, one.total) == (0, 3)
    assert one.wait(90) and one.state == "done", one.failure
    assert names(out) == ["s.0001.exr", "s.0002.exr", "s.0005.exr"]
    assert [path.name for path in one.written_files] == names(out) and (one.done, one.reused) == (3, 0)
    np.testing.assert_allclose(
        read_layer(str(out / "s.0002.exr"), "", Kind.IMAGE, 4, sandbox=UNRESTRICTED).array[..., 0], 1.0
    )


def test_renders_wait_for_each_other_in_an_order_that_can_change(exports, folder, tmp_path):
    long = exports.start(
        brighter(folder, 200, sigma=30.0),
        [("", tmp_path / "0.exr")],
        options=make_job(size=(1600, 1200)),
    )
    rest = [exports.start(brighter(folder), [("", tmp_path / f"{number}.exr")]) for number in (1, 2, 3)]
    assert [one.state for one in exports.all] == ["running", "waiting", "waiting", "waiting"]
    exports.move(rest[2], -5)
    exports.move(long, 1)
    assert exports.waiting == (rest[2], rest[0], rest[1]) and exports.all[0] is long
    rest[1].cancel()
    assert rest[1].wait(1) and rest[1].state == "cancelled"
    long.cancel()
    assert rest[0].wait(60) and rest[2].wait(1)
    assert rest[2].ended_at <= rest[0].started_at and exports.unfinished == ()
    assert names(tmp_path)[:2] == ["1.exr", "3.exr"]
    exports.clear()
    assert exports.all == ()


@pytest.mark.parametrize("jobs", [1, 2])
def test_what_was_stopped_goes_on_where_it_was(exports, folder, tmp_path, jobs):
    out = tmp_path / "out"
    out.mkdir()
    options = make_job(frames=tuple(range(1, 31)), processes=jobs, size=(1200, 900))
    one = exports.start(shot(folder, 30, sigma=20.0), [("", out / "s.####.exr")], options=options)
    while one.done < 2:
        assert one.state == "running", one.failure
        time.sleep(0.01)
    assert one.seconds_left is not None and 0.0 < one.fraction < 1.0
    one.cancel()
    assert one.wait(60)
    assert one.state == "cancelled" and 2 <= len(names(out)) < 30
    assert not [name for name in names(out) if name.startswith(".")]
    kept = set(names(out))
    again = exports.resume(one)
    assert exports.all == (again,) and exports.resume(again) is again
    assert again.wait(120) and again.state == "done", again.failure
    assert len(names(out)) == 30 and again.reused == len(kept) and again.done == again.total == 30


def test_one_that_cannot_be_started_says_so_and_the_next_one_has_its_turn(exports, folder, tmp_path):
    lost = exports.start(Graph(folder=str(tmp_path / "gone")), [("", tmp_path / "x.exr")])
    assert lost.wait(60) and lost.state == "failed" and "cannot be started" in lost.failure
    one = exports.start(brighter(folder), [("", tmp_path / "y.exr")])
    assert one.wait(60) and one.state == "done"


def test_closing_forgets_what_waits(folder, tmp_path):
    exports = RenderQueue(sandbox=UNRESTRICTED)
    long = exports.start(
        brighter(folder, 200, sigma=30.0),
        [("", tmp_path / "0.exr")],
        options=make_job(size=(900, 900)),
    )
    other = exports.start(brighter(folder), [("", tmp_path / "1.exr")])
    exports.close()
    assert (long.state, other.state) == ("cancelled", "cancelled") and list(tmp_path.glob("*.exr")) == []
