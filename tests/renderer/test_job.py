"""Jobs of many frames: reading, computing and writing overlap, in bounded memory."""

from __future__ import annotations

import threading
from pathlib import Path

import numpy as np
import pytest
from exr_files import read, write_exr
from halation import media
from halation.compiler import Surface
from halation.errors import InputError
from halation.graph import Graph, Input, Output, Port
from halation.nodes import catalogue
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.renderer import Renderer, RenderRequest, open_device
from halation.renderer.execution.decoding import MAX_LOOKAHEAD, MAX_LOOKAHEAD_BYTES, limit_lookahead
from halation.renderer.execution.executor import Executor
from halation.renderer.jobs.job import OutputSettings, run_job
from halation.renderer.jobs.write_queue import MAX_WAITING, MAX_WAITING_BYTES, WriteQueue
from halation.resources import large_arrays
from halation.resources.sandbox import UNRESTRICTED

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
    made = Renderer(open_device(sandbox=UNRESTRICTED), sandbox=UNRESTRICTED)
    yield made
    made.close()


def writing(folder: Path) -> OutputSettings:
    return OutputSettings((("", folder / "out.##.exr"),), precision="float")


def values(folder: Path, frames=FRAMES) -> list[float]:
    return [float(read(folder / f"out.{frame:02d}.exr")[0, 0, 0]) for frame in frames]


def test_the_next_frame_is_read_while_this_one_is_written(engine, graph, shot, monkeypatch):
    """The first write waits until the third frame has been decoded; one after the other, it would wait in vain."""
    decoded, waited = threading.Event(), []
    load, write = engine.pictures.load_pixels, media.write_picture

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
    monkeypatch.setattr(media, "write_picture", slow)
    run_job(engine, graph, RenderRequest(), writing(shot), tuple(FRAMES))
    assert waited == [True] and values(shot) == [2.0 * frame for frame in FRAMES]


def test_what_waits_is_bounded(engine, graph, shot, monkeypatch):
    """A slow disk holds the rendering up; a fast one would not be read far ahead either."""
    loaded, written, most_read, most_waiting = [], [], [], []
    load, write = engine.pictures.load_pixels, media.write_picture

    def loading(picture):
        loaded.append(picture.path)
        most_read.append(len(loaded) - len(written))
        return load(picture)

    def counted(path, *rest, **options):
        threading.Event().wait(0.02)
        write(path, *rest, **options)
        written.append(path)

    class Ends:
        def report_pass(self, *_):
            most_waiting.append(len(loaded) - len(written))

        def report_frame(self, *_):
            pass

    engine.runner._load = loading
    monkeypatch.setattr(media, "write_picture", counted)
    run_job(engine, graph, RenderRequest(), writing(shot), tuple(FRAMES), progress=Ends())
    assert max(most_read + most_waiting) <= MAX_LOOKAHEAD + MAX_WAITING + 2 and len(written) == len(FRAMES)
    assert engine.runner.textures.allocated <= engine.runner.textures.budget


def test_a_fault_comes_after_what_was_begun(engine, graph, shot):
    (shot / "in.05.exr").write_bytes(b"no picture")
    with pytest.raises(InputError, match=r"in\.05\.exr"):
        run_job(engine, graph, RenderRequest(), writing(shot), tuple(FRAMES))
    assert values(shot, range(1, 5)) == [2.0, 4.0, 6.0, 8.0]
    assert not (shot / "out.05.exr").exists() and not list(shot.glob(".halation-*"))


def test_a_frame_that_cannot_be_written_ends_the_job(engine, graph, shot, monkeypatch):
    write = media.write_picture

    def full(path, *rest, **options):
        if path.name == "out.04.exr":
            raise OSError("disk full")
        write(path, *rest, **options)

    monkeypatch.setattr(media, "write_picture", full)
    with pytest.raises(OSError, match="disk full"):
        run_job(engine, graph, RenderRequest(), writing(shot), tuple(FRAMES))
    assert values(shot, range(1, 4)) == [2.0, 4.0, 6.0]
    assert len(list(shot.glob("out.*.exr"))) <= 3 + MAX_WAITING + 1


def test_the_report_says_what_became_of_every_frame(engine, graph, shot):
    report = run_job(engine, graph, RenderRequest(), writing(shot), (3, 1, 2))
    assert [item.frame for item in report.frames] == [3, 1, 2] and all(item.passes == 1 for item in report.frames)
    assert [path.name for path in report.written] == ["out.03.exr", "out.01.exr", "out.02.exr"]
    again = run_job(engine, graph, RenderRequest(), writing(shot), (1, 2, 4), resume=True)
    assert [item.is_kept for item in again.frames] == [True, True, False] and again.passes == 1


def over_a_still(graph: Graph, shot: Path) -> Graph:
    """The shot over a soft picture that stays the same."""
    still = np.random.default_rng(3).random((8, 8, 4), np.float32)
    write_exr(shot / "still.exr", {"Combined": still}, {"Combined": "float"})
    graph = graph.add_input("still", Input(file="still.exr")).add("soft", GaussianBlur(sigma=2.0))
    graph = graph.connect(Port("inputs", "still"), Port("soft", "image"))
    graph = graph.add("both", catalogue()["merge"](mode="plus")).connect(Port("soft", "out"), Port("both", "b"))
    return graph.connect(Port("light", "out"), Port("both", "a")).connect(Port("both", "out"), Port("outputs", "image"))


class Watcher:
    """Counts what is on the device after every frame."""

    def __init__(self, engine: Renderer) -> None:
        self.textures, self.results, self.bytes = engine.runner.textures, list[int](), list[int]()

    def report_pass(self, *_):
        pass

    def report_frame(self, *_):
        self.results.append(len(self.textures._results))
        self.bytes.append(self.textures.allocated)


def test_what_stays_the_same_is_kept_and_nothing_else(graph, shot):
    """Without any budget: the still is read and blurred once, and no frame leaves anything behind."""
    engine = Renderer(open_device(sandbox=UNRESTRICTED), budget=0, sandbox=UNRESTRICTED)
    whole, passes = over_a_still(graph, shot), engine.runner.counters
    run_job(engine, whole, RenderRequest(), writing(shot), (1,))
    alone, single = passes.passes, engine.runner.textures.peak
    assert passes.uploads == 2 and not engine.runner.textures._results
    seen = Watcher(engine)
    run_job(engine, whole, RenderRequest(), writing(shot), tuple(FRAMES), progress=seen)
    assert passes.passes == alone + alone + len(FRAMES) - 1 and passes.uploads == 2 + 1 + len(FRAMES)
    assert max(seen.results) <= 2 and engine.runner.textures.peak <= single + 2 * 8 * 8 * 16
    assert not engine.runner.textures._leases and not engine.runner.textures._results and not engine.runner._leftovers
    engine.close()
    fresh = Renderer(open_device(sandbox=UNRESTRICTED), budget=0, sandbox=UNRESTRICTED)
    for frame in (1, 7, 12):
        found = fresh.render(whole, RenderRequest(frame=frame))["image"]
        np.testing.assert_array_equal(read(shot / f"out.{frame:02d}.exr"), found)
    fresh.close()


def test_memory_does_not_grow_with_the_frames(graph, shot):
    """What is on the device after the fourth frame is there after the last."""
    engine = Renderer(open_device(sandbox=UNRESTRICTED), budget=0, sandbox=UNRESTRICTED)
    seen = Watcher(engine)
    run_job(engine, over_a_still(graph, shot), RenderRequest(), writing(shot), tuple(FRAMES) * 4, progress=seen)
    assert len(seen.bytes) == 4 * len(FRAMES)
    assert max(seen.bytes[4:]) <= max(seen.bytes[:4]) and max(seen.results[4:]) <= max(seen.results[:4])
    engine.close()


def test_a_still_sequence_is_computed_once(graph, shot):
    engine = Renderer(open_device(sandbox=UNRESTRICTED), budget=0, sandbox=UNRESTRICTED)
    run_job(engine, graph, RenderRequest({"image": shot / "in.03.exr"}), writing(shot), tuple(FRAMES))
    assert engine.runner.counters.passes == 1 and values(shot) == [6.0] * len(FRAMES)
    engine.close()


def test_pages_are_used_again(engine, graph, shot, monkeypatch):
    """Those of a few frames for all, and none while it is still to be written."""
    monkeypatch.setattr(large_arrays, "LARGE", 1)
    created, write = list[object](), media.write_picture
    create = large_arrays._create_pages

    def counted(nbytes):
        created.append(nbytes)
        return create(nbytes)

    def slow(path, layers, **options):
        threading.Event().wait(0.005)
        write(path, layers, **options)

    monkeypatch.setattr(large_arrays, "_create_pages", counted)
    monkeypatch.setattr(media, "write_picture", slow)
    run_job(engine, graph, RenderRequest(), writing(shot), tuple(FRAMES))
    assert len(created) <= MAX_WAITING + 2 and values(shot) == [2.0 * frame for frame in FRAMES]


def test_textures_make_room_for_the_pixels_of_the_last_frame(graph, shot, monkeypatch):
    """Only the last frame is read when nothing but its output is on the device."""
    engine = Renderer(open_device(sandbox=UNRESTRICTED), budget=0, sandbox=UNRESTRICTED)
    allocated, download = list[int](), Executor.download

    def watched(self, plan, number, create):
        allocated.append(self.textures.allocated - plan.surfaces[number].nbytes)
        return download(self, plan, number, create)

    monkeypatch.setattr(Executor, "download", watched)
    run_job(engine, graph, RenderRequest(), writing(shot), tuple(FRAMES))
    engine.close()
    assert all(allocated[:-1]) and allocated[-1] == 0


def large(nbytes: int) -> np.ndarray:
    """So many bytes that take no memory."""
    return np.broadcast_to(np.uint8(0), (nbytes,))


@pytest.mark.parametrize(
    ("nbytes", "most"), [(16, MAX_WAITING), (MAX_WAITING_BYTES // 2 + 1, 1), (2 * MAX_WAITING_BYTES, 1)]
)
def test_frames_wait_by_number_and_by_bytes(nbytes, most):
    behind, gate = WriteQueue[int](), threading.Event()
    try:
        for number in range(most):
            behind.submit(lambda _, number=number: (gate.wait(PATIENCE), number)[1], {"image": large(nbytes)})
            assert list(behind.collect_finished()) == []
        behind.submit(lambda _: -1, {"image": large(nbytes)})
        gate.set()
        assert [*behind.collect_finished(), *behind.collect_all()] == [*range(most), -1]
    finally:
        behind.close()


@pytest.mark.parametrize(("side", "most"), [(64, MAX_LOOKAHEAD), (4096, 1), (3000, 1), (2500, 2)])
def test_pictures_are_read_ahead_by_number_and_by_bytes(side, most):
    surface = Surface("", "", (side, side), 4, "f4", 0, 0, 1)
    wanted = [(number, surface) for number in range(9)]
    assert [number for number, _ in limit_lookahead(wanted)] == list(range(most))
    assert most == 1 or most * surface.nbytes <= MAX_LOOKAHEAD_BYTES
