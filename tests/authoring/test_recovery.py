"""Unsaved work: kept while the editor runs, found after it died, gone after a clean end."""

from __future__ import annotations

import os
import random
import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path

import pytest
from halation import document
from halation.authoring.recovery.recovery import RecoveryFile
from halation.errors import DocumentError
from halation.graph import Graph, Group, Input
from halation.nodes import catalogue
from halation.resources.sandbox import UNRESTRICTED

FAST = 0.02


def graph(count=0, folder=""):
    return Graph(ui={"count": count}, folder=folder).add("fill", catalogue()["constant"]())


def until(condition):
    end = time.monotonic() + 120.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.005)


@pytest.fixture
def editor(tmp_path):
    """`editor()` is the recovery of one more editor."""
    made = []

    def one(interval=FAST):
        made.append(RecoveryFile(tmp_path, interval))
        return made[-1]

    yield one
    for recovery in made:
        recovery.close()


@pytest.fixture
def kept(tmp_path):
    """The recovery files there are."""
    return lambda: list((tmp_path / "recovery").glob("*.json"))


def test_unsaved_work_is_kept_until_it_is_saved(editor, kept, tmp_path):
    path = tmp_path / "mine.json"
    document.save(graph(1), path, sandbox=UNRESTRICTED)
    before = path.read_bytes()
    one = editor()
    one.note(graph(1), path, False)
    one.note(graph(2), path, True)
    until(kept)
    other = editor()
    assert path.read_bytes() == before and other.find_abandoned() == ()  # its editor still runs
    other.close()
    one.clear()
    until(lambda: not kept())
    one.note(graph(3), path, True)
    until(kept)
    one.note(graph(3), path, False)
    until(lambda: not kept())
    one.note(graph(4), path, True)
    one.close()
    assert not list((tmp_path / "recovery").iterdir())


def test_what_a_crash_leaves_is_found_loaded_and_discarded(editor, kept, tmp_path):
    for count, path in ((1, None), (2, tmp_path / "mine.json")):
        one = editor()
        one.note(graph(count, str(tmp_path)), path, True)
        one.close(keep=True)
    new = editor()
    second, first = new.find_abandoned()
    assert (first.path, first.title, first.nodes, first.fault) == (None, "Untitled", 1, "")
    assert (second.path, second.title) == (tmp_path / "mine.json", "mine.json") and second.time >= first.time > 1e9
    assert first.load(UNRESTRICTED) == graph(1) and second.load(UNRESTRICTED) == graph(2)
    first.discard()
    assert new.find_abandoned() == (second,)


def test_what_is_the_same_in_its_own_file_is_no_loss(editor, kept, tmp_path):
    path = tmp_path / "mine.json"
    one = editor()
    one.note(graph(7), path, True)
    one.close(keep=True)
    document.save(graph(7), path, sandbox=UNRESTRICTED)
    assert editor().find_abandoned() == () and not kept()


def test_pictures_and_groups_are_found_where_the_original_found_them(editor, tmp_path, monkeypatch):
    folder = tmp_path / "project"
    folder.mkdir()
    document.save(Graph().add_input("image", Input()), folder / "body.json", sandbox=UNRESTRICTED)
    monkeypatch.chdir(tmp_path)
    whole = Graph(folder="project").add("read", catalogue()["read_image"](path="a.exr"))
    whole = whole.add("group", Group(document.load("project/body.json", sandbox=UNRESTRICTED), "body.json"))
    one = editor()
    one.note(whole, folder / "graph.json", True)
    one.close(keep=True)
    monkeypatch.chdir("/")
    loaded = editor().find_abandoned()[0].load(UNRESTRICTED)
    assert loaded == whole and loaded.folder == str(folder)
    assert list(loaded.nodes["group"].graph.inputs) == ["image"]


def test_damaged_files_are_told_of_not_raised(editor, tmp_path, kept):
    one = editor()
    one.note(graph(1), None, True)
    one.close(keep=True)
    file = kept()[0]
    text = file.read_text()
    new = editor()
    for number, broken in enumerate(("", "{", text[:40], text.replace('"constant"', "3"), "[]", "\x00")):
        file.with_name(f"broken{number}.json").write_text(broken)
    found = new.find_abandoned()
    assert len(found) == 7 and [one.load(UNRESTRICTED) for one in found if one.file == file] == [graph(1)]
    for one in (one for one in found if one.file != file):
        with pytest.raises(DocumentError):
            one.load(UNRESTRICTED)
        one.discard()
    assert [one.file for one in new.find_abandoned()] == [file]


def test_adopted_work_is_never_without_a_file(editor, kept, tmp_path):
    one = editor()
    one.note(graph(1), None, True)
    one.close(keep=True)
    [old] = kept()
    new = editor()
    loaded = new.adopt(new.find_abandoned()[0], UNRESTRICTED)
    assert kept() == [old]
    new.note(loaded, None, True)
    until(lambda: kept() != [old] and len(kept()) == 1)
    assert b'"count": 1' in kept()[0].read_bytes()
    new.close()
    assert not kept()


def test_adopted_work_that_is_saved_at_once_goes(editor, kept):
    one = editor()
    one.note(graph(1), None, True)
    one.close(keep=True)
    new = editor(5.0)
    new.note(new.adopt(new.find_abandoned()[0], UNRESTRICTED), None, True)
    new.clear()
    until(lambda: not kept())


def test_a_fault_is_a_sentence_and_tried_again(editor, kept, tmp_path):
    one = editor()
    (tmp_path / "recovery").rename(tmp_path / "away")
    one.note(graph(1), None, True)
    until(lambda: one.fault)
    assert "unsaved work is not kept" in one.fault and "Traceback" not in one.fault
    (tmp_path / "away").rename(tmp_path / "recovery")
    until(lambda: not one.fault)
    assert len(kept()) == 1
    one.note(Graph(ui={"bad": float("nan")}), None, True)
    until(lambda: "nan cannot be saved" in one.fault)
    one.note(graph(2), None, True)
    until(lambda: not one.fault)


def test_a_folder_that_cannot_be(tmp_path):
    (tmp_path / "recovery").write_text("in the way")
    one = RecoveryFile(tmp_path)
    assert "save often" in one.fault
    one.note(graph(1), None, True)
    assert one.find_abandoned() == ()
    one.close()


def test_writes_are_rare_and_the_newest_wins(editor, kept, monkeypatch):
    texts = []
    real = document.dumps
    monkeypatch.setattr(document, "dumps", lambda item: texts.append(item) or real(item))
    one = editor(0.5)
    for count in range(200):
        one.note(graph(count), None, True)
        one.note(one._noted[0], None, True)
    until(kept)
    assert len(texts) == 1 and texts[0] == graph(199)


def test_leftovers_of_ended_editors_are_tidied(editor, tmp_path):
    one = editor()
    folder = tmp_path / "recovery"
    [mine] = folder.glob("*.lock")
    ours, theirs = folder / f".halation-1-0a-{mine.stem}.json.tmp", folder / ".halation-1-0a-0123456789abcdef.json.tmp"
    for path in (ours, theirs, folder / "0123456789abcdef.lock"):
        path.touch()
    two = editor()
    assert ours.exists() and not theirs.exists() and not (folder / "0123456789abcdef.lock").exists()
    assert len(list(folder.glob("*.lock"))) == 2
    ours.unlink()
    two.close()
    one.close()
    assert not list(folder.iterdir())


SCRIPT = """
import itertools, sys, time
from itertools import pairwise
from pathlib import Path
from halation import document
from halation.authoring.recovery.recovery import RecoveryFile
from halation.graph import Graph
from halation.nodes import catalogue
from halation.resources.sandbox import UNRESTRICTED

folder, path = Path(sys.argv[1]), Path(sys.argv[2])
graph = Graph(folder=str(path.parent))
for number in range(60):
    graph = graph.add(f"fill{number}", catalogue()["constant"]())
recovery = RecoveryFile(folder, 0.05)
for count in itertools.count(1):
    now = Graph(graph.nodes, ui={"count": count}, folder=graph.folder)
    recovery.note(now, path, True)
    print("noted", count, time.monotonic(), flush=True)
    if count % 5 == 0:
        document.save(now, path, sandbox=UNRESTRICTED)
        print("saved", count, time.monotonic(), flush=True)
    time.sleep(0.002)
"""


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_killed_at_any_moment_nothing_is_lost(tmp_path):
    """The last save is whole, and unsaved work is whole and as new as promised, whenever SIGKILL strikes."""
    chance = random.Random(1)
    delays = [2.5, 3.0] + [chance.uniform(0.0, 0.25) for _ in range(150)]
    recovered = saves = 0
    for round, delay in enumerate(delays):
        if round >= 30 and recovered >= 20 and saves >= 20:
            break
        state, path = tmp_path / f"state{round % 2}", tmp_path / "mine.json"
        said = killed(delay, state, path)
        saved = [count for word, count, _ in said if word == "saved"]
        if saved:
            saves += 1
            assert document.load(path, sandbox=UNRESTRICTED).ui["count"] >= saved[-1]
        new = RecoveryFile(state)
        for one in new.find_abandoned():
            count, ended = one.load(UNRESTRICTED).ui["count"], said[-1][2]
            recovered += 1
            assert len(one.load(UNRESTRICTED).nodes) == 60 and one.path == path
            times = [when for *_, when in said]
            pause = max((later - earlier for earlier, later in pairwise(times)), default=0.0)
            assert all(number <= count for _, number, when in said if when < ended - 0.05 - 1.0 - pause)
            one.discard()
        new.close()
        assert not list(new.folder.iterdir())
    assert recovered >= 20 and saves >= 20


def killed(delay: float, state: Path, path: Path) -> list[tuple[str, int, float]]:
    """What the script said until it was killed, `delay` seconds after it began to work."""
    words = [sys.executable, "-c", SCRIPT, str(state), str(path)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as running:
        assert running.stdout is not None
        first = running.stdout.readline()
        time.sleep(delay)
        running.kill()
        lines = [first, *running.stdout.readlines()]
    return [
        (word, int(count), float(when)) for line in lines if line.endswith("\n") for word, count, when in [line.split()]
    ]
