"""Changed files: told once, whoever changed them and however; never our own."""

from __future__ import annotations

import os
import threading
import time
from pathlib import Path

import pytest
import watchfiles
from halation import document
from halation.graph import Graph, Group, Input, Port
from halation.nodes import catalogue
from halation.resources.sandbox import UNRESTRICTED
from halation.watch import watching
from halation.watch.watching import FileChange, FileWatcher, find_pictures


@pytest.fixture(params=["told", "compared"])
def watcher(request, monkeypatch):
    """One that the system tells of changes, and one on a system that refuses to."""
    if request.param == "compared":

        def refuse(*paths, **options):
            raise OSError("OS file watch limit reached")

        monkeypatch.setattr(watchfiles, "watch", refuse)
        monkeypatch.setattr(watching, "_POLL_SECONDS", 0.1)
    made = FileWatcher(sandbox=UNRESTRICTED)
    yield made
    made.close()
    assert bool(made.fault) == (request.param == "compared") or not made._watched.files + made._watched.folders
    assert not made.fault or "OS file watch limit reached" in made.fault


def news(watcher, count=1):
    """The next changes."""
    found, end = [], time.monotonic() + 120.0
    while len(found) < count:
        assert time.monotonic() < end, found
        found += watcher.poll()
        time.sleep(0.005)
    return sorted(found, key=lambda change: str(change.path))


def quiet(watcher, path):
    """True if nothing more comes. Whatever happened to the graph is older than this mark, so it would come first."""
    mark = path.with_name("mark.json")
    mark.write_text("1")
    watcher.watch(path, groups=[mark])
    mark.write_text("22")
    return news(watcher) == [FileChange("group", mark)]


@pytest.fixture
def path(tmp_path):
    made = tmp_path / "graph.json"
    document.save(Graph(), made, sandbox=UNRESTRICTED)
    return made


def save(path, count):
    document.save(Graph(ui={"count": count}), path, sandbox=UNRESTRICTED)


def test_replacing_writing_removing_and_making_again(watcher, path):
    watcher.watch(path)
    assert watcher.poll() == ()
    save(path, 1)  # a rename over it
    assert news(watcher) == [FileChange("graph", path)]
    with path.open("a") as file:  # in place
        file.write("\n")
    assert news(watcher) == [FileChange("graph", path)]
    path.unlink()
    assert news(watcher) == [FileChange("graph", path, exists=False)]
    save(path, 2)
    assert news(watcher) == [FileChange("graph", path)]


def test_our_own_saves_are_no_news(watcher, path):
    watcher.watch(path)
    for count in range(3):
        save(path, count)
        watcher.expect(path)
    assert quiet(watcher, path)
    watcher.watch(path)
    save(path, 10)
    watcher.expect(path)
    save(path, 11)
    assert news(watcher) == [FileChange("graph", path)]
    save(path, 10)  # what we once wrote, by somebody else
    assert news(watcher) == [FileChange("graph", path)]


def test_before_a_save_one_can_ask_whether_somebody_else_was_quicker(watcher, path):
    assert not watcher.differs(path), "nobody has read it"
    watcher.watch(path)
    assert not watcher.differs(path)
    save(path, 1)
    assert watcher.differs(path), "at once, before it is told"
    news(watcher)
    assert not watcher.differs(path), "it was told"
    save(path, 2)
    watcher.expect(path)
    assert not watcher.differs(path)
    assert quiet(watcher, path) and not watcher.differs(path)
    path.unlink()
    assert not watcher.differs(path), "there is nothing to lose"


def test_what_was_touched_but_not_changed_is_no_news(watcher, path):
    watcher.watch(path)
    os.utime(path, (1, 1))
    path.rename(path.with_suffix(".away"))
    path.with_suffix(".away").rename(path)
    assert quiet(watcher, path)


def test_pictures_and_missing_folders(watcher, path, tmp_path):
    picture, lost = tmp_path / "a.exr", tmp_path / "later" / "b.exr"
    picture.write_bytes(b"1")
    watcher.watch(path, pictures=[picture, lost])
    picture.write_bytes(b"2")
    assert news(watcher) == [FileChange("picture", picture)]
    lost.parent.mkdir()
    lost.write_bytes(b"3")
    assert news(watcher) == [FileChange("picture", lost)]
    lost.unlink()
    lost.parent.rmdir()
    assert news(watcher) == [FileChange("picture", lost, exists=False)]
    lost.parent.mkdir()
    lost.write_bytes(b"4")
    assert news(watcher) == [FileChange("picture", lost)]


def test_folders_of_shaders_and_nodes(watcher, tmp_path):
    shaders, nodes = tmp_path / "shaders", tmp_path / "nodes"
    for folder in (shaders / "lib", nodes / "color"):
        folder.mkdir(parents=True)
    (shaders / "lib" / "a.glsl").write_text("1")
    watcher.watch(shaders=[shaders], nodes=[nodes])
    until_listed(watcher)
    (shaders / "lib" / "a.glsl").write_text("2")
    (shaders / "lib" / "a.glsl~").write_text("2")
    assert news(watcher) == [FileChange("shader", shaders / "lib" / "a.glsl")]
    (nodes / "new").mkdir()
    (nodes / "new" / "b.py").write_text("3")
    (nodes / "color" / "c.py").write_text("4")
    assert news(watcher, 2) == [
        FileChange("node", nodes / "color" / "c.py"),
        FileChange("node", nodes / "new" / "b.py"),
    ]
    (nodes / "color" / "c.py").unlink()
    assert news(watcher) == [FileChange("node", nodes / "color" / "c.py", exists=False)]


def until_listed(watcher):
    end = time.monotonic() + 120.0
    while not watcher._listed:
        assert time.monotonic() < end
        time.sleep(0.005)


def test_what_is_no_longer_watched_is_no_news(watcher, path, tmp_path):
    other = tmp_path / "other.json"
    save(other, 0)
    watcher.watch(path)
    watcher.watch(other)
    save(path, 1)
    save(other, 1)
    assert news(watcher) == [FileChange("graph", other)]
    watcher.watch(path)
    save(path, 2)
    assert news(watcher) == [FileChange("graph", path)]


def test_news_is_kept_when_more_is_watched_and_forgotten_when_less(watcher, path, tmp_path):
    """Also of folders, and where nobody has asked for it yet."""
    other, shaders = tmp_path / "other.json", tmp_path / "shaders"
    shaders.mkdir()
    for file in (other, shaders / "a.glsl"):
        file.write_text("1")
    watcher.watch(path, groups=[other], shaders=[shaders])
    until_listed(watcher)
    for file in (path, other, shaders / "a.glsl"):
        file.write_text("2")
    end = time.monotonic() + 120.0
    while len(watcher._news) < 3:
        assert time.monotonic() < end
        time.sleep(0.005)
    watcher.watch(path, code=[other], shaders=[shaders])
    assert {change.path for change in watcher.poll()} == {path, shaders / "a.glsl"}


@pytest.mark.skipif(os.name == "nt", reason="links need a privilege there")
def test_links_are_followed(watcher, path, tmp_path):
    link = tmp_path / "links" / "link.json"
    link.parent.mkdir()
    link.symlink_to(path)
    watcher.watch(link)
    save(path, 1)
    assert news(watcher) == [FileChange("graph", link)]


def test_closing_ends_the_thread(path):
    made = FileWatcher(sandbox=UNRESTRICTED)
    made.watch(path)
    made.close()
    assert not made._thread.is_alive() and made._thread not in threading.enumerate()


def test_the_pictures_of_a_graph(tmp_path):
    inner = Graph(folder=str(tmp_path / "lib")).add_input("own", Input(file="own.exr"))
    inner = inner.add_input("fed", Input(file="fed.exr")).add("read", catalogue()["read_image"](path="deep.exr"))
    graph = Graph(folder=str(tmp_path)).add_input("beauty", Input(file="a.exr")).add_input("bound", Input(file="b.exr"))
    graph = graph.add("group", Group(inner)).add("empty", catalogue()["read_image"]())
    graph = graph.connect(Port("inputs", "beauty"), Port("group", "fed"))
    bindings = {"bound": str(tmp_path / "c.exr:Depth"), "number": 3.0}
    assert {file.relative_to(tmp_path) for file in find_pictures(graph, bindings)} == {
        Path("a.exr"),
        Path("c.exr"),
        Path("lib/own.exr"),
        Path("lib/deep.exr"),
    }


def test_what_woke_the_thread_is_taken_note_of_once(monkeypatch):
    """Else it would compare files for ever, without a pause."""
    made = FileWatcher(sandbox=UNRESTRICTED)
    seen = list[bool]()

    def settle() -> None:
        seen.append(made._wake.changed.is_set())
        made._wake.ended.set()

    monkeypatch.setattr(made, "_settle", settle)
    made._wake.changed.set()
    made._run()
    assert seen == [False]
