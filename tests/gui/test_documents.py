"""Files: saved and read again, dropped, changed by others, and nothing lost when the program dies."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest
from halation import document, presets
from halation.authoring.commands import SetValue
from halation.authoring.edits.element_id import ElementId
from halation.graph import Port
from halation.resources.sandbox import UNRESTRICTED

HERE = Path(__file__).parents[1]


@pytest.fixture
def look(tmp_path: Path) -> Path:
    """A preset in a folder of its own, with the picture that it reads."""
    source = next(path for path in presets.paths() if path.stem == "agx_look")
    shutil.copytree(source.parent / "samples", tmp_path / "samples")
    return Path(shutil.copy(source, tmp_path / "look.json"))


def test_what_is_saved_is_what_was_made(gui, look: Path) -> None:
    before = document.load(look, sandbox=UNRESTRICTED)

    def body(ui) -> None:
        ui.session.select([ElementId("tone")])
        ui.session.apply(SetValue(Port("tone", "exposure"), 1.5))
        ui.wait()
        assert ui.session.dirty
        ui.keys("Ctrl+S")
        assert not ui.session.dirty

    gui(body, look)
    after = document.load(look, sandbox=UNRESTRICTED)
    assert after.value(Port("tone", "exposure")) == 1.5
    assert after.set(Port("tone", "exposure"), before.value(Port("tone", "exposure"))) == before


def test_opening_and_saving_unchanged_writes_the_same_text(gui, look: Path) -> None:
    text = look.read_text()

    def body(ui) -> None:
        ui.settled()
        assert not ui.session.dirty
        ui.keys("Ctrl+S")

    gui(body, look)
    assert json.loads(look.read_text()) == json.loads(text)


def test_closing_with_unsaved_work_asks_first(gui, look: Path) -> None:
    def body(ui) -> None:
        ui.session.apply(SetValue(Port("tone", "exposure"), 1.0))
        ui.keys("Ctrl+Q")
        assert ui.editor.dialogs.question is not None and not ui.editor.commands.closing
        assert "look" in ui.editor.dialogs.question.sentence
        ui.keys("Escape")
        assert ui.editor.dialogs.question is None and not ui.editor.commands.closing

    gui(body, look)


def test_a_picture_that_is_dropped_becomes_a_node(gui, look: Path) -> None:
    picture = next((look.parent / "samples").glob("studio.exr"))

    def body(ui) -> None:
        before = set(ui.session.graph.nodes)
        ui.move("Graph")
        ui.window._dropped.append(str(picture))
        ui.wait(5)
        (new,) = set(ui.session.graph.nodes) - before
        assert ui.session.graph.nodes[new].id == "read_image"
        ui.session.views.show(Port(new, "out"))
        ui.settled()
        assert not ui.editor.preview.faults
        ui.keys("Ctrl+Z")
        assert set(ui.session.graph.nodes) == before

    gui(body, look)


def test_a_graph_that_is_dropped_on_the_viewer_is_opened(gui, look: Path) -> None:
    other = next(path for path in presets.paths() if path.stem == "bleach_bypass")

    def body(ui) -> None:
        ui.move("Viewer")
        ui.wait()
        ui.window._dropped.append(str(other))
        ui.wait(5)
        assert ui.session.path == other

    gui(body, look)


def test_a_file_changed_by_another_program_is_loaded_again(gui, look: Path) -> None:
    def body(ui) -> None:
        document.save(
            document.load(look, sandbox=UNRESTRICTED).set(Port("tone", "exposure"), -2.0), look, sandbox=UNRESTRICTED
        )
        ui.until(lambda: ui.session.graph.value(Port("tone", "exposure")) == -2.0)
        assert not ui.session.dirty
        ui.session.apply(SetValue(Port("tone", "exposure"), 3.0))
        document.save(
            document.load(look, sandbox=UNRESTRICTED).set(Port("tone", "exposure"), -1.0), look, sandbox=UNRESTRICTED
        )
        ui.until(lambda: ui.editor.dialogs.question is not None)
        assert ui.session.graph.value(Port("tone", "exposure")) == 3.0

    gui(body, look)


def test_saving_over_what_another_program_wrote_asks_first(gui, look: Path) -> None:
    def body(ui) -> None:
        ui.session.apply(SetValue(Port("tone", "exposure"), 3.0))
        ui.wait()
        theirs = document.load(look, sandbox=UNRESTRICTED).set(Port("tone", "exposure"), -1.0)
        ui.editor.watcher.close()  # it does not notice in time
        document.save(theirs, look, sandbox=UNRESTRICTED)
        ui.keys("Ctrl+S")
        assert "another program" in ui.editor.dialogs.question.sentence and ui.session.dirty
        ui.keys("Escape")
        assert document.load(look, sandbox=UNRESTRICTED) == theirs
        ui.keys("Ctrl+S")
        ui.editor.dialogs.question.answers[0][1]()
        ui.editor.dialogs.question = None
        ui.wait()
        assert not ui.session.dirty
        ui.session.apply(SetValue(Port("tone", "exposure"), 4.0))
        ui.keys("Ctrl+S")
        assert ui.editor.dialogs.question is None and not ui.session.dirty

    gui(body, look)
    assert document.load(look, sandbox=UNRESTRICTED).value(Port("tone", "exposure")) == 4.0


def test_a_read_only_file_is_opened_and_not_replaced(gui, look: Path) -> None:
    look.chmod(0o444)
    text = look.read_text()

    def body(ui) -> None:
        ui.session.apply(SetValue(Port("tone", "exposure"), 3.0))
        ui.keys("Ctrl+S")
        assert "read-only" in ui.editor.log.entries[-1].sentence and ui.session.dirty
        assert look.read_text() == text

    gui(body, look)


def test_work_is_offered_again_after_the_process_was_killed(gui, look: Path, tmp_path: Path) -> None:
    script = (
        "import sys, time; sys.path.append(sys.argv[1])\n"
        "from pathlib import Path\nfrom gui_driver import drive\n"
        "from halation.authoring.commands import SetValue\nfrom halation.graph import Port\n"
        "def body(ui):\n"
        "    ui.session.apply(SetValue(Port('tone', 'exposure'), 2.5))\n"
        "    ui.until(lambda: list((Path(sys.argv[2]) / 'state' / 'recovery').glob('*.json')))\n"
        "    ui.wait(5); print('ready', flush=True); ui.until(lambda: False, 60)\n"
        "drive(body, Path(sys.argv[2]), Path(sys.argv[3]))\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", script, str(HERE), str(tmp_path), str(look)],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "HALATION_STATE": str(tmp_path / "state")},
    ) as process:
        assert process.stdout and any(line.strip().endswith("ready") for line in process.stdout)
        process.kill()
    assert document.load(look, sandbox=UNRESTRICTED).value(Port("tone", "exposure")) != 2.5
    time.sleep(0.1)

    def body(ui) -> None:
        assert "start" in ui.editor.dialogs.open
        (found,) = ui.editor.recovery.find_abandoned()
        assert found.path == look
        ui.click("recover 0")
        ui.wait(3)
        assert ui.session.graph.value(Port("tone", "exposure")) == 2.5
        assert ui.session.dirty and ui.session.path == look
        ui.settled()
        assert not ui.editor.preview.faults

    gui(body)
