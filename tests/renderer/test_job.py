"""Jobs of many frames: reading, computing and writing overlap, in bounded memory."""

from __future__ import annotations

import threading
from pathlib import Path

import numpy as np
import pytest
from exr_files import read, write_exr
from halation.app import media
from halation.app.errors import InputError
from halation.app.graph import Graph, Input, Output, Port
from halation.app.renderer import Renderer, Wanted, open_device
from halation.app.renderer.decoding import AHEAD
from halation.app.renderer.job import BEHIND, Writing, run_job
from halation.nodes.color.exposure import Exposure

FRAMES = range(1, 13)
PATIENCE = 20.0


@pytest.fixture
def shot(tmp_path: Path) -> Path:
    for frame in FRAMES:
        picture = np.full((8, 8, 4), frame, np.float32)
        write_exr(tmp_path / f"in.{frame:02d}.exr", {"Combined": picture}, {"Combined": "float"})
    return tmp_path


@pytest.fixture
def graph(shot: Path) -> Graph:
    made = Graph(folder=str(shot)).add_input("image", Input(file="in.##.exr")).add_output("image", Output())
    made = made.add("light", Exposure(stops=1.0)).connect(Port("inputs", "image"), Port("light", "image"))
    return made.connect(Port("light", "out"), Port("outputs", "image"))


@pytest.fixture
def engine():
    made = Renderer(open_device())
    yield made
    made.close()


def writing(folder: Path) -> Writing:
    return Writing((("", folder / "out.##.exr"),), precision="float")


def values(folder: Path, frames=FRAMES) -> list[float]:
    return [float(read(folder / f"out.{frame:02d}.exr")[0, 0, 0]) for frame in frames]


def test_the_next_frame_is_read_while_this_one_is_written(engine, graph, shot, monkeypatch):
    """The first write waits until the third frame has been decoded; one after the other, it would wait in vain."""
    decoded, waited = threading.Event(), []
    load, write = engine.pictures.load, media.write

    def loading(picture):
        pixels = load(picture)
        if picture.path.endswith("in.03.exr"):
            decoded.set()
        return pixels

    def slow(path, *rest, **options):
        if path.name == "out.01.exr":
            waited.append(decoded.wait(PATIENCE))
        write(path, *rest, **options)

    engine.runner._load = loading
    monkeypatch.setattr(media, "write", slow)
    run_job(engine, graph, Wanted(), writing(shot), tuple(FRAMES))
    assert waited == [True] and values(shot) == [2.0 * frame for frame in FRAMES]


def test_what_waits_is_bounded(engine, graph, shot, monkeypatch):
    """A slow disk holds the rendering up; a fast one would not be read far ahead either."""
    loaded, written, most_read, most_waiting = [], [], [], []
    load, write = engine.pictures.load, media.write

    def loading(picture):
        loaded.append(picture.path)
        most_read.append(len(loaded) - len(written))
        return load(picture)

    def counted(path, *rest, **options):
        threading.Event().wait(0.02)
        write(path, *rest, **options)
        written.append(path)

    class Ends:
        def passed(self, *_):
            most_waiting.append(len(loaded) - len(written))

        def finished(self, *_):
            pass

    engine.runner._load = loading
    monkeypatch.setattr(media, "write", counted)
    run_job(engine, graph, Wanted(), writing(shot), tuple(FRAMES), progress=Ends())
    assert max(most_read + most_waiting) <= AHEAD + BEHIND + 2 and len(written) == len(FRAMES)
    assert engine.runner.textures.allocated <= engine.runner.textures.budget


def test_a_fault_comes_after_what_was_begun(engine, graph, shot):
    (shot / "in.05.exr").write_bytes(b"no picture")
    with pytest.raises(InputError, match=r"in\.05\.exr"):
        run_job(engine, graph, Wanted(), writing(shot), tuple(FRAMES))
    assert values(shot, range(1, 5)) == [2.0, 4.0, 6.0, 8.0]
    assert not (shot / "out.05.exr").exists() and not list(shot.glob(".halation-*"))


def test_a_frame_that_cannot_be_written_ends_the_job(engine, graph, shot, monkeypatch):
    write = media.write

    def full(path, *rest, **options):
        if path.name == "out.04.exr":
            raise OSError("disk full")
        write(path, *rest, **options)

    monkeypatch.setattr(media, "write", full)
    with pytest.raises(OSError, match="disk full"):
        run_job(engine, graph, Wanted(), writing(shot), tuple(FRAMES))
    assert values(shot, range(1, 4)) == [2.0, 4.0, 6.0]
    assert len(list(shot.glob("out.*.exr"))) <= 3 + BEHIND + 1


def test_the_report_says_what_became_of_every_frame(engine, graph, shot):
    report = run_job(engine, graph, Wanted(), writing(shot), (3, 1, 2))
    assert [item.frame for item in report.frames] == [3, 1, 2] and all(item.passes == 1 for item in report.frames)
    assert [path.name for path in report.written] == ["out.03.exr", "out.01.exr", "out.02.exr"]
    again = run_job(engine, graph, Wanted(), writing(shot), (1, 2, 4), resume=True)
    assert [item.kept for item in again.frames] == [True, True, False] and again.passes == 1
