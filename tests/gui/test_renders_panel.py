"""Renders of many frames, their queue, and flipbooks of what they wrote, in the real window."""

from __future__ import annotations

import shutil
import signal
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from exr_files import write_exr
from halation import presets
from halation.document import load, save
from halation.graph import OUTPUTS, Expression, Port, Settings
from halation.media import read_layer
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED

LONG = 12
"""Frames of a render that is suspended when the first is done: enough that others are left."""

PRESET = next(path for path in presets.paths() if path.stem == "soft_bloom")


@pytest.fixture
def shot(tmp_path: Path) -> Path:
    """A preset of eight frames in a folder of its own: each glows otherwise."""
    return made(tmp_path, 8)


@pytest.fixture
def long_shot(tmp_path: Path) -> Path:
    """The same, for a while."""
    return made(tmp_path, LONG)


def made(tmp_path: Path, count: int) -> Path:
    """A document with so many frames."""
    shutil.copytree(PRESET.parent / "samples", tmp_path / "samples")
    graph = load(PRESET, sandbox=UNRESTRICTED).animate(Port("bloom", "intensity"), Expression("frame * 0.1"))
    save(replace(graph, settings=Settings(frames=(1, count))), tmp_path / "comp.json", sandbox=UNRESTRICTED)
    return tmp_path / "comp.json"


def sequence(folder: Path, name: str, count: int, level: float) -> Path:
    """Numbered gray pictures that get lighter, with a bar that moves."""
    folder.mkdir(exist_ok=True)
    for frame in range(1, count + 1):
        pixels = np.full((90, 160, 4), level * frame / count, np.float32)
        pixels[20:70, 12 * frame : 12 * frame + 24, :3] = (0.9, 0.35 * level, 0.1)
        pixels[..., 3] = 1.0
        write_exr(folder / f"{name}.{frame:04d}.exr", {"Combined": pixels}, {"Combined": "half"})
    return folder / f"{name}.####.exr"


def suspend(export, suspended: bool) -> None:
    """Stop the process of a render where it is, or let it go on. Does nothing on Windows, which cannot."""
    if hasattr(signal, "SIGSTOP"):
        export._process.send_signal(signal.SIGSTOP if suspended else signal.SIGCONT)


def to_renders(ui) -> None:
    ui.ctx.window_focus("//Renders")
    ui.wait(4)


def ended(ui, count: int = 1) -> None:
    """Wait for so many renders."""
    ui.until(lambda: len(ui.editor.exports.all) >= count and not ui.editor.exports.unfinished, 120)
    ui.wait(4)


@pytest.mark.parametrize(("theme", "scale"), [("dark", 1.0), ("light", 1.0), ("dark", 1.6)])
def test_the_form_in_every_theme(gui, shot: Path, theme: str, scale: float) -> None:
    def body(ui) -> None:
        to_renders(ui)
        assert {"render aim", "render jobs", "render resume"} <= ui.editor.places.keys()
        ui.shot(f"form_{theme}_{scale:g}.png")
        ui.click("Frames")
        ui.shot(f"form_frames_{theme}_{scale:g}.png")
        ui.click("Frames listed frames")
        ui.click("render frames")
        ui.type("1-8x2,x", enter=False)
        assert "render list fault" in ui.editor.places
        ui.shot(f"form_fault_{theme}_{scale:g}.png")

    gui(body, shot, likes={"theme": theme, "ui_scale": scale})


def test_a_range_is_rendered_and_played(gui, shot: Path) -> None:
    def body(ui) -> None:
        to_renders(ui)
        ui.click("render")
        (export,) = ui.editor.exports.all
        ui.until(lambda: export.done >= 2 or export.state != "running", 60)
        ui.wait(3)
        ui.shot("queue_running.png")
        ended(ui)
        assert (export.state, export.failure, export.done) == ("done", "", 8)
        assert len(list(shot.parent.glob("comp.*.exr"))) == 8
        ui.until(lambda: "render exists" in ui.editor.places)
        ui.wait(2)
        ui.click("render resume instead")
        ui.click("render")
        ended(ui, 2)
        assert ui.editor.exports.all[1].reused == 8
        ui.click("notes 0")
        assert "export notes 0" in ui.editor.places
        ui.shot("queue_ended.png")
        ui.click("play 0")
        ui.settled()
        book = ui.editor.stage.flipbook
        assert book is not None and book.session.time.frames == (1, 8)
        ui.keys("Shift+RightArrow")
        assert book.session.time.frame == 8 and ui.session.time.frame == 1
        ui.settled()
        assert ui.editor.preview.find_whole_image("A").frame == 8
        ui.shot("flipbook_alone.png")
        ui.click("compare 0")
        ui.shot("queue_compare.png")
        ui.click("compare with 0")
        ui.settled()
        book = ui.editor.stage.flipbook
        assert book is not None and len(book.strips) == 2 and ui.editor.preview.find_whole_image("B") is not None
        ui.shot("flipbook_of_two_renders.png")
        ui.click("close flipbook")
        ui.settled()
        assert ui.editor.stage.flipbook is None and ui.editor.preview.find_whole_image("A").frame == 1
        assert ui.editor.viewer.compare == "off"

    gui(body, shot)


def test_renders_wait_and_are_stopped(gui, long_shot: Path) -> None:
    def body(ui) -> None:
        exports = ui.editor.exports

        def order(name: str) -> None:
            ui.click("render file image")
            ui.type(str(long_shot.parent / f"{name}.####.png"))
            ui.click("render")

        to_renders(ui)
        order("a")
        (first,) = exports.all
        ui.until(lambda: first.state == "running")
        while first.done < 1 and first.state == "running":  # without the window, which may draw once a second
            time.sleep(0.002)
        suspend(first, True)  # so the render is not done before it is cancelled
        assert first.state == "running" and first.done < LONG
        order("b")
        order("c")
        _, second, third = exports.all
        assert exports.waiting == (second, third)
        ui.shot("queue_waiting.png")
        ui.click("earlier 2")
        assert exports.waiting == (third, second)
        ui.click("cancel 2")
        assert second.state == "cancelled"
        ui.click("cancel 0")
        suspend(first, False)
        ui.until(lambda: first.state == "cancelled")
        ended(ui, 3)
        assert third.state == "done" and 1 <= len(list(long_shot.parent.glob("a.*.png"))) < LONG
        ui.wait(4)
        ui.shot("queue_cancelled.png")
        at = sorted(exports.all, key=lambda one: -one.ended_at).index(first)
        ui.click(f"again {at}")
        ui.until(lambda: exports.all[0] is not first)
        ended(ui, 3)
        assert exports.all[0].state == "done" and exports.all[0].reused >= 1, exports.all[0].failure
        assert len(list(long_shot.parent.glob("a.*.png"))) == LONG

    gui(body, long_shot)


def test_a_failed_render_says_why_and_is_tried_again(gui, shot: Path) -> None:
    def body(ui) -> None:
        to_renders(ui)
        ui.click("render file image")
        ui.type(str(shot.parent / "later" / "s.####.png"))
        ui.click("render")
        ended(ui)
        assert "export fault 0" in ui.editor.places and "no such folder" in ui.editor.exports.all[0].failure
        ui.shot("queue_failed.png")
        (shot.parent / "later").mkdir()
        ui.click("again 0")
        ended(ui)
        assert ui.editor.exports.all[0].state == "done"

    gui(body, shot)


def test_quitting_asks_while_something_renders(gui, tmp_path: Path) -> None:
    def body(ui) -> None:
        to_renders(ui)
        ui.click("render")
        ui.keys("Ctrl+Q")
        assert ui.editor.dialogs.question is not None and not ui.editor.commands.closing
        ui.shot("queue_quit.png")
        ui.click("answer 1")
        assert not ui.editor.commands.closing and ui.editor.exports.unfinished

    window = gui(body, made(tmp_path, 2000))
    assert not window.editor.exports.unfinished


@pytest.mark.parametrize("theme", ["dark", "light"])
def test_two_sequences_are_compared(gui, shot: Path, tmp_path: Path, theme: str) -> None:
    one, other = sequence(tmp_path / "v1", "shot_v1", 6, 0.5), sequence(tmp_path / "v2", "shot_v2", 4, 1.0)

    def body(ui) -> None:
        ui.editor.actions.run("flipbook.open")
        ui.wait(3)
        ui.editor.dialogs.browse.then(Path(str(one).replace("####", "0002")))
        ui.editor.dialogs.browse = None
        ui.settled()
        ui.click("compare flipbook")
        ui.editor.dialogs.browse.then(Path(str(other).replace("####", "0001")))
        ui.editor.dialogs.browse = None
        ui.settled()
        book, viewer = ui.editor.stage.flipbook, ui.editor.viewer
        assert [strip.path for strip in book.strips] == [one, other] and book.session.time.frames == (1, 6)
        assert viewer.compare == "beside"
        ui.keys("RightArrow")
        ui.settled()
        assert book.session.time.frame == 2
        ui.shot(f"flipbook_beside_{theme}.png")
        panel = ui.editor.places["viewer panel"]
        middle, down = (panel[0] + panel[2]) / 2, (panel[1] + panel[3]) / 2
        pixels = ui.pixels("flipbook_beside.png")
        quarter = (panel[2] - panel[0]) / 4
        row = pixels[int(down) + 60]
        left, right = row[int(middle - 1.2 * quarter)].mean(), row[int(middle + 0.8 * quarter)].mean()
        assert right > left + 20
        ui.move((middle + quarter, down))
        ui.wait(3)
        over = viewer.pixel
        ui.move((middle - quarter, down))
        ui.wait(3)
        assert over is not None and viewer.pixel is not None and abs(over[0] - viewer.pixel[0]) <= 1
        for key, name in (("W", "wipe"), ("D", "difference")):
            ui.move((middle, down))
            ui.keys(key)
            ui.settled()
            assert viewer.compare == name
            ui.shot(f"flipbook_{name}_{theme}.png")
        ui.keys("Space")
        ui.until(lambda: book.session.time.frame >= 4, 30)
        ui.keys("Space")
        assert not ui.editor.timeline.playback.playing
        ui.session.views.show(Port(OUTPUTS, "image"), "B")
        ui.session.views.show(Port("bloom", "out"))
        ui.settled()
        assert ui.editor.stage.flipbook is None and viewer.compare == "off"
        assert ui.editor.preview.find_whole_image("A").port == Port("bloom", "out")

    gui(body, shot, likes={"theme": theme})


def test_a_flipbook_follows_what_is_being_written(gui, shot: Path) -> None:
    def body(ui) -> None:
        to_renders(ui)
        ui.click("render")
        (export,) = ui.editor.exports.all
        ui.until(lambda: bool(export.written_files), 60)
        ui.click("play 0")
        book = ui.editor.stage.flipbook
        assert book is not None
        book.session.time.seek(8)
        ended(ui)
        for frame in (8, 1):
            book.session.time.seek(frame)
            ui.settled()
            seen = ui.ask(lambda: ui.editor.probe.read_small(ui.editor.preview.find_whole_image("A").texture, 480))
            there = read_layer(
                str(shot.parent / f"comp.{frame:04d}.exr"), "", Kind.IMAGE, 4, sandbox=UNRESTRICTED
            ).array
            assert seen[..., :3].mean() == pytest.approx(there[..., :3].mean(), rel=0.01)

    gui(body, shot)


def test_pictures_that_are_gone_take_nothing_down(gui, shot: Path, tmp_path: Path) -> None:
    path = sequence(tmp_path / "v1", "gone", 2, 0.5)

    def body(ui) -> None:
        ui.editor.actions.run("flipbook.open")
        ui.editor.dialogs.browse.then(Path(str(path).replace("####", "0001")))
        ui.editor.dialogs.browse = None
        ui.settled()
        shutil.rmtree(tmp_path / "v1")
        ui.editor.preview.refresh()
        ui.keys("RightArrow")
        ui.settled()
        assert ui.editor.faults == {} and ui.editor.preview.fault("A")
        ui.click("close flipbook")
        ui.settled()
        assert ui.editor.preview.fault("A") is None

    gui(body, shot)


def test_many_files_are_rendered_and_counted(gui, shot: Path) -> None:
    """A folder of pictures goes through the graph; one of them is none, and is named."""
    photos = shot.parent / "photos"
    sequence(photos, "plate", 4, 0.8)
    (photos / "plate.0003.exr").write_bytes(b"no picture")

    def body(ui) -> None:
        to_renders(ui)
        ui.click("Frames")
        ui.click("Frames many files")
        assert "render fault" in ui.editor.places  # no files are chosen yet
        ui.click("render many files")
        ui.type("photos/*.exr", enter=False)
        ui.until(lambda: "render aim" in ui.editor.places)
        ui.click("render file image")
        ui.type(str(shot.parent / "graded" / "{stem}_{index}.exr"))
        ui.wait(4)
        ui.shot("form_many_files.png")
        ui.click("render")
        (export,) = ui.editor.exports.all
        ended(ui)
        assert (export.state, export.failure, export.done) == ("failed", "1 of 4 files failed", 4)
        assert len(list((shot.parent / "graded").glob("plate*.exr"))) == 3
        ui.click("notes 0")
        ui.shot("queue_many_files.png")
        assert "play 0" not in ui.editor.places  # they are no sequence
        write_exr(photos / "plate.0003.exr", {"Combined": np.ones((8, 8, 4), np.float32)}, {"Combined": "half"})
        ui.click("again 0")
        ended(ui)
        assert (ui.editor.exports.all[0].state, ui.editor.exports.all[0].reused) == ("done", 3)

    gui(body, shot)


def test_a_render_may_go_to_a_cluster(gui, shot: Path) -> None:
    pytest.importorskip("distributed", reason="Dask is not installed")

    def body(ui) -> None:
        to_renders(ui)
        ui.click("render cluster")
        ui.type("local:2")
        ui.shot("form_cluster.png")
        ui.click("render")
        (export,) = ui.editor.exports.all
        ui.until(lambda: export.workers > 0 or export.state != "running", 120)
        ui.wait(3)
        ui.shot("queue_cluster.png")
        ended(ui)
        assert (export.state, export.failure, export.done, export.workers) == ("done", "", 8, 2)
        assert len(list(shot.parent.glob("comp.*.exr"))) == 8

    gui(body, shot)
