"""Turns of rendering: what begins one, what ends one early, and what is said of it."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace

import pytest
from halation.compiler import load_library
from halation.errors import GraphError, RenderError
from halation.graph import Graph, Input
from halation.renderer.jobs.job import JobReport
from halation.resources.sandbox import UNRESTRICTED
from halation.watch import rerendering
from halation.watch.rerendering import ContinuousRenderer

FAULT = "nodes/blur/some.py, line 3: it is broken; all nodes stay as they were"
DONE = JobReport((), 1, 0, 0, {})


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A graph, a picture, and folders of shaders and nodes that are nobody else's."""
    for name in ("shaders", "nodes"):
        (tmp_path / name).mkdir()
    (tmp_path / "graph.json").touch()
    monkeypatch.setattr(rerendering, "shader_folder", lambda: tmp_path / "shaders")
    nodes = SimpleNamespace(folder=tmp_path / "nodes", reload=lambda: FAULT)
    monkeypatch.setattr(rerendering, "NodeFiles", lambda: nodes)
    return tmp_path


@pytest.fixture
def turning(folder: Path) -> Iterator:
    made: list[ContinuousRenderer] = []

    def turns(load=lambda: Graph(), render=lambda graph, progress: DONE):
        made.append(ContinuousRenderer(folder / "graph.json", lambda graph: {}, load, render, sandbox=UNRESTRICTED))
        return iter(made[-1])

    yield turns
    for one in made:
        one.close()


@contextmanager
def written_on(path: Path) -> Iterator[None]:
    """Somebody writes a file again and again: folders are first looked at a moment after they are watched."""
    ended = threading.Event()

    def write() -> None:
        count = 0
        while not ended.wait(0.3):
            count += 1
            path.write_text(str(count))

    thread = threading.Thread(target=write)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def test_a_shader_that_changes_is_read_again(turning, folder: Path) -> None:
    shader = folder / "shaders" / "one.glsl"
    shader.write_text("before")
    turns = turning()
    assert next(turns).changed == ()
    known = load_library()
    with written_on(shader):
        turn = next(turns)
    assert turn.changed == (shader,) and turn.report is DONE and load_library() is not known


def test_a_file_of_a_node_that_is_broken_is_a_turn(turning, folder: Path) -> None:
    turns = turning()
    next(turns)
    node = folder / "nodes" / "some.py"
    with written_on(node):
        turn = next(turns)
    assert turn.changed == (node,) and str(turn.fault) == FAULT
    with written_on(folder / "graph.json"):
        assert any(turn.report is DONE for turn in turns), "it is said once for every change"


def test_pictures_that_are_not_there_yet(turning, folder: Path) -> None:
    graph = Graph(folder=str(folder)).add_input("a", Input(file="new.exr"))
    turns = turning(lambda: graph)
    next(turns)
    (folder / "new.exr").write_bytes(b"1")
    assert next(turns).changed == (folder / "new.exr",)


def test_a_rendering_that_is_outdated_begins_again(turning, folder: Path) -> None:
    """The first one would never end: a change ends it, and the second one has the new graph."""
    begun: list[Graph] = []

    def render(graph: Graph, progress) -> JobReport:
        begun.append(graph)
        if len(begun) == 1:
            (folder / "graph.json").write_text("1")
            end = time.monotonic() + 60.0
            while time.monotonic() < end:
                progress.report_pass(1, 1, 2, None)
                time.sleep(0.01)
        return DONE

    turn = next(turning(render=render))
    assert len(begun) == 2 and turn.changed == (folder / "graph.json",) and turn.report is DONE


def test_faults_are_turns_and_are_waited_for(turning, folder: Path) -> None:
    faults: list[Exception] = [GraphError("broken"), RenderError("no")]

    def load() -> Graph:
        if len(faults) == 2:
            raise faults.pop(0)
        return Graph()

    def render(graph: Graph, progress) -> JobReport:
        if faults:
            raise faults.pop()
        return DONE

    turns = turning(load, render)
    for expected in ("broken", "no", None):
        turn = next(turns)
        assert (str(turn.fault) if turn.fault else None) == expected and (turn.report is None) == (expected is not None)
        (folder / "graph.json").write_text(repr(expected))


def test_files_that_a_broken_document_names_are_watched(turning, folder: Path) -> None:
    """A group inside a group is missing: nothing could be loaded, so nobody knows of it but the text."""
    (folder / "graph.json").write_text('{"nodes": {"a": {"type": "group", "path": "body.json"}}}')
    (folder / "body.json").write_text('{"nodes": {"b": {"type": "group", "path": "deep/er.json"}}}')
    (folder / "deep").mkdir()

    def load() -> Graph:
        if not (folder / "deep" / "er.json").exists():
            raise GraphError("er.json: there is no such file")
        return Graph()

    turns = turning(load)
    assert next(turns).report is None
    (folder / "deep" / "er.json").write_text("{}")
    turn = next(turns)
    assert turn.changed == (folder / "deep" / "er.json",) and turn.report is DONE
