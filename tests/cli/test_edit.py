"""`halation edit` as the system sees it: how it starts, how it refuses, how it ends. No display is needed."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from halation import document, presets
from halation.resources.sandbox import UNRESTRICTED

HALATION = [sys.executable, "-m", "halation.cli", "edit"]
LOOK = next(path for path in presets.paths() if path.stem == "agx_look")
PATIENCE = 100.0
"""Seconds for an editor to open or to end, which takes two: on a machine that is full, other programs come first."""

POSIX = pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
BROKEN_PARTS = """
import sys
from halation.editor.window import window
from halation.errors import DeviceError

def broken(*_, **__):
    raise {fault}

count = [0]

def broken_later(self, editor):
    count[0] += 1
    if count[0] == 5:
        from halation.authoring.commands import SetValue
        from halation.graph import Port
        editor.session.apply(SetValue(Port("tone", "exposure"), 2.5))
    if count[0] > 8:
        broken()

{what} = {how}
from halation.cli.program import run
sys.exit(run(["edit", *sys.argv[1:]]))
"""

ASKED_EARLY = """
import os, sys
from halation.editor.window import window

open_first = window.open_first

def ask_to_end(*words):
    open_first(*words)
    os.kill(os.getpid(), {number})

window.open_first = ask_to_end
from halation.cli.program import run
sys.exit(run(["edit", *sys.argv[1:]]))
"""


@pytest.fixture
def place(tmp_path: Path) -> dict[str, str]:
    """The environment of an editor that remembers in a folder of its own, and shows its window nowhere."""
    left = {name: text for name, text in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    return {**left, "HALATION_STATE": str(tmp_path / "state"), "HALATION_WINDOW": "none"}


def ended(place: dict[str, str], *words: object, program: list[str] | None = None, **options) -> tuple[int, str]:
    """How an editor ends that cannot begin: exit code and what it says."""
    found = subprocess.run(
        [*(program or HALATION), *map(str, words)],
        env=place,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        **options,
    )
    assert found.stdout == ""
    return found.returncode, found.stderr.strip()


@contextmanager
def running(place: dict[str, str], *words: object, **options) -> Iterator[subprocess.Popen[str]]:
    """An editor whose window is open."""
    with subprocess.Popen(
        [*HALATION, *map(str, words)], env=place, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options
    ) as process:
        try:
            yield process
        finally:
            process.kill()


def until(question: Callable[[], object], process: subprocess.Popen[str]) -> None:
    end = time.monotonic() + PATIENCE
    while not question():
        assert process.poll() is None, process.communicate()[1]
        assert time.monotonic() < end, "this never became true"
        time.sleep(0.02)


def held(place: dict[str, str]) -> list[Path]:
    return sorted(Path(place["HALATION_STATE"], "recovery").glob("*.lock"))


def recent(place: dict[str, str]) -> list[str]:
    file = Path(place["HALATION_STATE"], "preferences.json")
    return [one["path"] for one in json.loads(file.read_text())["recent"]] if file.exists() else []


@pytest.mark.skipif(sys.platform != "linux", reason="a Mac or Windows always has a display")
def test_without_a_display_it_says_so(place: dict[str, str]) -> None:
    code, said = ended({name: text for name, text in place.items() if name != "HALATION_WINDOW"}, LOOK)
    assert (code, said.count("\n")) == (5, 0) and "needs a display" in said


@pytest.mark.parametrize(
    ("words", "code", "sentence"),
    [
        (["missing.json"], 3, "missing.json: there is no such file"),
        (["."], 3, "this is a folder"),
        (["broken.json"], 3, "broken.json: not valid JSON"),
        ([LOOK, "-i", "nothing=shot.exr"], 2, "the graph has no input 'nothing'"),
        (["-i", "beauty=shot.exr"], 2, "name the graph file too"),
        (["missing/render.exr"], 4, "missing/render.exr: there is no such file"),
        (["shot.exr", "-i", "beauty=shot.exr"], 2, "leave -i out"),
    ],
)
def test_what_cannot_be_opened_is_a_sentence(place, tmp_path: Path, words, code: int, sentence: str) -> None:
    (tmp_path / "broken.json").write_text("{")
    (tmp_path / "shot.exr").write_bytes(b"")
    found, said = ended(place, *words, cwd=tmp_path)
    assert (found, said.count("\n")) == (code, 0) and sentence in said and "Traceback" not in said


@pytest.mark.parametrize(
    ("what", "fault", "code", "sentence"),
    [
        ("window.adopt_window", "DeviceError('this driver is too old')", 5, "halation: this driver is too old"),
        ("window.assemble", "ValueError('oh')", 70, "this is a bug in Halation (ValueError: oh)"),
        (
            "window.open_first",
            "document.DocumentError('x.json', '', 'it vanished')",
            3,
            "halation: x.json: it vanished",
        ),
        ("window.fonts.load", "ValueError('oh')", 70, "this is a bug in Halation (ValueError: oh)"),
    ],
)
def test_a_fault_at_the_start_is_a_sentence_and_no_crash(place, what: str, fault: str, code: int, sentence) -> None:
    script = BROKEN_PARTS.format(fault=fault, what=what, how="broken").replace(
        "import DeviceError", "import DeviceError\nfrom halation import errors as document"
    )
    found, said = ended(place, LOOK, program=[sys.executable, "-c", script])
    assert found == code and said.splitlines()[-1].startswith("halation: ") and sentence in said
    assert not held(place), "nothing is left behind"


def test_a_fault_of_the_window_keeps_unsaved_work(place: dict[str, str]) -> None:
    script = BROKEN_PARTS.format(fault="ValueError('oh')", what="window.Appearance.follow", how="broken_later")
    code, said = ended(place, LOOK, program=[sys.executable, "-c", script])
    assert code == 70 and "bug in Halation (ValueError: oh)" in said
    (kept,) = Path(place["HALATION_STATE"], "recovery").glob("*.json")
    assert json.loads(kept.read_text())["graph"]["nodes"]["tone"]["values"]["exposure"] == 2.5
    code, said = ended(place | {"HALATION_DEBUG": "1"}, LOOK, program=[sys.executable, "-c", script])
    assert code == 1 and "Traceback" in said


@POSIX
@pytest.mark.parametrize(("number", "code"), [(signal.SIGTERM, 0), (signal.SIGINT, 130), (signal.SIGHUP, 0)])
def test_it_ends_when_asked_to(place: dict[str, str], number: signal.Signals, code: int) -> None:
    with running(place, LOOK) as process:
        until(lambda: recent(place), process)
        process.send_signal(number)
        said = process.communicate(timeout=PATIENCE)[1]
        assert process.returncode == code, said
    assert not held(place) and (said.count("\n"), "interrupted" in said) == (code > 0, code > 0)


@POSIX
@pytest.mark.parametrize(("number", "code"), [(signal.SIGTERM, 0), (signal.SIGINT, 130), (signal.SIGHUP, 0)])
def test_it_ends_without_a_word_before_its_first_frame(place, number: signal.Signals, code: int) -> None:
    found, said = ended(place, LOOK, program=[sys.executable, "-c", ASKED_EARLY.format(number=int(number))])
    assert found == code and ("interrupted" in said if code else said == ""), said
    assert not held(place)


@POSIX
def test_paths_start_where_it_was_started(place: dict[str, str], tmp_path: Path) -> None:
    (tmp_path / "work").mkdir()
    document.save(document.load(LOOK, sandbox=UNRESTRICTED), tmp_path / "work" / "look.json", sandbox=UNRESTRICTED)
    with running(place, "work/look.json", "-i", "beauty=work/none.exr", cwd=tmp_path) as process:
        until(lambda: recent(place), process)
        process.terminate()
        assert process.wait(PATIENCE) == 0
    assert recent(place) == [str(tmp_path / "work" / "look.json")]


@POSIX
def test_two_editors_at_once(place: dict[str, str], tmp_path: Path) -> None:
    files = [tmp_path / "one.json", tmp_path / "two.json"]
    for file in files:
        document.save(document.load(LOOK, sandbox=UNRESTRICTED), file, sandbox=UNRESTRICTED)
    with running(place, files[0]) as first, running(place, files[1]) as second:
        until(lambda: len(held(place)) == 2, first)
        until(lambda: set(recent(place)) == set(map(str, files)), second)
        for process in (first, second):
            process.terminate()
            assert process.wait(PATIENCE) == 0
    assert not held(place)


def limited() -> None:
    """No file may grow: as on a full disk."""
    import resource

    resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))


EDITED = """
import sys
from time import monotonic
from halation.editor.window.frame_updater import FrameUpdater
from halation.authoring.commands import SetValue
from halation.graph import Port

update, heard = FrameUpdater.update, []

def edited(self):
    editor = self._editor
    if not editor.session.dirty:
        editor.session.apply(SetValue(Port("tone", "exposure"), 2.5))
    update(self)
    said = [entry.sentence for entry in editor.log.entries]
    if any("unsaved work" in one for one in said):
        heard.append(monotonic())
    if heard and monotonic() - heard[0] > 2.5:
        print(*said, sep=chr(10), file=sys.stderr)
        editor.commands.closing = True

FrameUpdater.update = edited
from halation.cli.program import run
sys.exit(run(["edit", *sys.argv[1:]]))
"""


@POSIX
@pytest.mark.parametrize("state", ["file", "file/inside", "full"])
def test_a_state_folder_that_cannot_be_is_said_once_and_stops_nothing(place, tmp_path: Path, state: str) -> None:
    (tmp_path / "file").write_text("precious")
    here = place | {"HALATION_STATE": str(tmp_path / state)}
    found = subprocess.run(
        [sys.executable, "-c", EDITED, str(LOOK)],
        env=here,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        preexec_fn=limited if state == "full" else None,
    )
    assert found.returncode == 0, found.stderr
    assert [found.stderr.count(name) for name in ("unsaved work", "preferences cannot")] == [1, 1], found.stderr
    assert (tmp_path / "file").read_text() == "precious"
