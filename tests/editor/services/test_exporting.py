"""Exports: real processes that write real files, fail with a sentence, and stop when told."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from exr_files import write_exr
from halation.app.editor.services.exporting import Exports, Options
from halation.app.errors import UsageError
from halation.app.graph import Graph, Group, Input, Output, Port
from halation.app.media import read
from halation.nodes import Kind, catalogue

LEVEL = 0.5


@pytest.fixture
def folder(tmp_path):
    """A project with one picture, away from the current folder."""
    made = tmp_path / "project"
    made.mkdir()
    write_exr(made / "a.exr", {"Combined": np.full((16, 24, 4), LEVEL, np.float32)}, {"Combined": "half"})
    return made


@pytest.fixture
def exports():
    made = Exports()
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
    assert one.wait(60) and (one.state, one.sentence) == ("done", ""), one.sentence
    assert one.written == (out, tmp_path / "out.png") and one.done == one.total > 1 and one.node == "n2"
    assert any("OpenGL" in note for note in one.notes)
    np.testing.assert_allclose(read(str(out), "", Kind.IMAGE, 4).array, LEVEL, rtol=1e-3)
    exports.clear()
    assert exports.all == ()


def test_bindings_options_and_groups(exports, folder, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_exr(Path("b.exr"), {"Combined": np.full((8, 12, 4), 0.25, np.float32)}, {"Combined": "half"})
    body = brighter(folder)
    graph = Graph(folder=str(folder)).add_input("beauty", Input(file="a.exr")).add_output("image", Output())
    graph = graph.add("group", Group(body)).connect(Port("inputs", "beauty"), Port("group", "beauty"))
    graph = graph.connect(Port("group", "image"), Port("outputs", "image"))
    options = Options(size=(8, 6), scale=0.5, precision="float", compression="none")
    one = exports.start(graph, [("", Path("b out.exr"))], {"beauty": "b.exr:Combined"}, options)
    one.wait()
    assert one.state == "done", one.sentence
    array = read(str(tmp_path / "b out.exr"), "", Kind.IMAGE, 4).array
    assert array.shape == (3, 4, 4)
    np.testing.assert_allclose(array[..., 0], 0.5)


def test_failures_are_sentences(exports, folder, tmp_path):
    out = tmp_path / "out.exr"
    out.write_bytes(b"precious")
    broken = brighter(folder).add("lost", catalogue()["read_image"](path="gone.exr"))
    broken = broken.connect(Port("lost", "out"), Port("n0", "image"))
    unlinked = brighter(folder).disconnect(Port("n0", "image"))
    cases = [
        (broken, out, "gone.exr"), (unlinked, out, "n0"),
        (brighter(folder), tmp_path / "no" / "out.exr", "no such folder"),
        (brighter(folder), folder / "a.exr", "is read by 'beauty'"), (brighter(folder), tmp_path / "out.xyz", ".xyz"),
    ]
    running = [(exports.start(graph, [("", path)]), words) for graph, path, words in cases]
    for one, words in running:
        one.wait()
        assert one.state == "failed" and words in one.sentence and one.written == (), one.sentence
        assert not one.sentence.startswith(("-", "halation")) and "Traceback" not in one.sentence
    assert out.read_bytes() == b"precious" and not list(tmp_path.rglob(".halation-*"))


def test_what_makes_no_sense_is_refused_at_once(exports, folder):
    with pytest.raises(UsageError, match="choose a file"):
        exports.start(brighter(folder), [])
    with pytest.raises(UsageError, match="'beauty' is filled from memory"):
        exports.start(brighter(folder), [("", folder / "x.exr")], {"beauty": np.zeros((2, 2, 4))})
    assert exports.all == ()


@pytest.mark.parametrize("passes", [0, 1, 5])
def test_cancelling_leaves_nothing(exports, folder, tmp_path, passes):
    out = tmp_path / "out.exr"
    out.write_bytes(b"precious")
    one = exports.start(brighter(folder, 200, sigma=30.0), [("", out)], options=Options(size=(1600, 1200)))
    while one.done < passes:
        assert one.state == "running", one.sentence
        time.sleep(0.01)
    one.cancel()
    one.cancel()
    assert one.wait(5) and one.state == "cancelled" and one.written == ()
    assert out.read_bytes() == b"precious" and list(tmp_path.glob(".*")) == []


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_one_that_does_not_listen_is_killed_and_its_part_removed(exports, folder, tmp_path, monkeypatch):
    """A render that is stuck while it writes."""
    code = (
        "import os, signal, sys, time; from pathlib import Path; from halation.app.media.store import part_prefix;"
        "signal.signal(signal.SIGINT, signal.SIG_IGN); Path(part_prefix(os.getpid()) + 'x.exr').touch();"
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
    assert one.wait(5) and one.state == "cancelled"
    assert [path.name for path in folder.glob(".halation-*")] == [".halation-1-other.exr"]


def test_one_that_dies_says_so(exports, folder):
    one = exports.start(brighter(folder, 100, sigma=30.0), [("", folder / "out.exr")], options=Options(size=(900, 900)))
    one._process.kill()
    one.wait()
    assert one.state == "failed" and "signal 9" in one.sentence


def test_closing_cancels_or_waits(folder, tmp_path):
    waited, cancelled = Exports(), Exports()
    one = waited.start(brighter(folder), [("", tmp_path / "one.exr")])
    waited.close(wait=True)
    long = brighter(folder, 200, sigma=30.0)
    two = cancelled.start(long, [("", tmp_path / "two.exr")], options=Options(size=(900, 900)))
    cancelled.close()
    assert (one.state, two.state) == ("done", "cancelled")
    assert [path.name for path in tmp_path.glob("*.exr")] == ["one.exr"]


def test_modules_beside_a_graph_are_not_run(exports, folder, tmp_path):
    (folder / "json.py").write_text("raise SystemExit('run')")
    (folder / "numpy.py").write_text("raise SystemExit('run')")
    one = exports.start(brighter(folder), [("", tmp_path / "out.exr")])
    one.wait()
    assert one.state == "done", one.sentence
