"""`-j auto`: how many processes render, and that their frames are those of one."""

from __future__ import annotations

import math
import threading
import time
from types import SimpleNamespace

import numpy as np
import pytest
from halation.cli import sharing
from halation.cli.sharing import FrameCosts, count_processes
from halation.cluster.chunk import ChunkReport, FrameChunk
from halation.graph import Graph
from halation.regression.parallel import choose_processes
from halation.renderer.jobs.render_job import RenderJob
from halation.resources import machine
from halation.resources.sandbox import UNRESTRICTED

FRAMES = range(1, 13)
GIB = 2**30


@pytest.fixture
def movie(graphs):
    """A graph with an animated value; `movie(node)` has another node at its end."""

    def make(kind: str = "exposure") -> str:
        blur = {"keys": [{"frame": 1, "value": 1.0}, {"frame": 12, "value": 3.0}]}
        return graphs(
            nodes={"noise": {"type": "noise"}, "blur": {"type": "gaussian_blur"}, "last": {"type": kind}},
            links={"blur.image": "noise.out", "last.image": "blur.out", "outputs.image": "last.out"},
            animation={"blur.sigma": blur},
            settings={"size": [32, 18], "frames": [1, 12]},
        )

    return make


@pytest.fixture
def three_processes(monkeypatch):
    """Whatever is measured, three processes are best."""
    monkeypatch.setattr(sharing, "count_processes", lambda *_: 3)


@pytest.mark.parametrize(
    ("costs", "frames", "cores", "memory", "expected"),
    [
        (FrameCosts(1.0, 1.0, 1.0, GIB), 100, 4, 64 * GIB, 4),  # one busy core of four
        (FrameCosts(1.0, 4.0, 1.0, GIB), 100, 4, 64 * GIB, 1),  # all cores are busy already
        (FrameCosts(0.01, 0.01, 1.0, GIB), 20, 4, 64 * GIB, 1),  # over before others have started
        (FrameCosts(1.0, 1.0, 1.0, GIB), 100, 8, 3 * GIB, 3),  # 0.8 of the memory holds two more
        (FrameCosts(1.0, 1.0, 1.0, GIB), 3, 8, 64 * GIB, 3),  # no more than there are frames
        (FrameCosts(1.0, 2.0, 0.0, GIB), 100, 8, math.inf, 4),  # each keeps two of eight busy
        (FrameCosts(1.0, 1.0, 1.0, GIB), 100, 1, 64 * GIB, 1),
        (FrameCosts(1.0, 1.0, 19.0, GIB), 20, 2, 64 * GIB, 1),  # 19.5 s instead of 20 are not worth a process
    ],
)
def test_as_many_processes_as_are_fastest(costs, frames, cores, memory, expected):
    assert count_processes(costs, frames, cores, memory) == expected


def test_the_count_is_the_best_of_all_by_the_model():
    """A second process halves `n p` seconds of processors and adds its start: the break-even is `n p = s`."""
    rng = np.random.default_rng(7)
    for _ in range(50):
        processor, start = rng.uniform(0.1, 2.0, 2)
        frames = int(rng.integers(2, 400))
        costs = FrameCosts(processor, processor, start, 1)
        saved = 1.0 - (frames * processor + start) / 2.0 / (frames * processor)
        assert (count_processes(costs, frames, 2, GIB) == 2) == (saved > 0.05)


def test_what_a_frame_costs_is_measured_without_the_start(monkeypatch):
    """Three marks, of the clock and of the processor, lie around two frames; what was used before is the start."""
    sharing_frames = sharing.FrameSharing(RenderJob(sandbox=UNRESTRICTED, frames=tuple(range(9))), Graph(), {}, None)
    sharing_frames.watch(SimpleNamespace(device=SimpleNamespace(target=SimpleNamespace(software=True))))
    sharing_frames._marks = [(100.0, 7.0), (101.0, 9.0), (104.0, 11.0)]
    asked = []
    monkeypatch.setattr(sharing, "count_processes", lambda *words: asked.append(words) or 1)
    assert sharing_frames._choose_count() == 1
    ((costs, left, cores, _),) = asked
    assert (costs.seconds, costs.processor, costs.start) == (2.0, 2.0, 5.0) and costs.memory > 2**20
    assert (left, cores) == (9, machine.available_cores())


def test_who_is_stopped_renders_nothing_more():
    """The others see it between two frames of what they have taken, and take no more."""
    frames = sharing.FrameSharing(RenderJob(sandbox=UNRESTRICTED, frames=tuple(FRAMES)), Graph(), {}, None)
    has_begun, seen = threading.Event(), []

    def render(piece, note_frame, is_cancelled, limit):
        seen.append(is_cancelled())
        has_begun.set()
        while not is_cancelled():
            time.sleep(0.001)
        return ChunkReport("", is_cancelled=True)

    process = SimpleNamespace(
        render=render, finish=lambda: seen.append("finished"), stop=lambda: seen.append("stopped")
    )
    frames._threads.append(
        threading.Thread(target=frames._run, args=(process, FrameChunk(frames._job, "/show"), 2), daemon=True)
    )
    frames._threads[0].start()
    assert has_begun.wait(30.0)
    frames.stop()
    assert seen == [False, "finished", "stopped"]


def test_frames_are_those_of_one_process(cli, movie, tmp_path, three_processes):
    graph = movie()
    assert cli("render", graph, "-o", tmp_path / "one.##.exr").code == 0
    ending = cli("render", graph, "-o", tmp_path / "many.##.exr", "-j", "auto", "--json")
    assert ending.code == 0 and ending.json["frames"] == list(FRAMES), ending.err
    assert ending.json["written"] == [str(tmp_path / f"many.{frame:02d}.exr") for frame in FRAMES]
    for frame in FRAMES:
        one, many = (tmp_path / f"{stem}.{frame:02d}.exr" for stem in ("one", "many"))
        assert one.read_bytes() == many.read_bytes()
    again = cli("render", graph, "-o", tmp_path / "many.##.exr", "-j", "auto", "--json", "--resume")
    assert again.json["kept"] == list(FRAMES)


def test_others_take_frames_from_the_end(cli, movie, tmp_path, three_processes, monkeypatch):
    taken: list[int] = []
    take = sharing.FrameSharing._take

    def note(self, count):
        frames = take(self, count)
        taken.extend(frames)
        return frames

    monkeypatch.setattr(sharing.FrameSharing, "_take", note)
    assert cli("render", movie(), "-o", tmp_path / "f.##.exr", "-j", "auto").code == 0
    assert taken[0] > 6 and len(taken) == len(set(taken)) and not {1, 2} & set(taken)


def test_a_fault_of_another_process_is_that_of_all(cli, movie, tmp_path, three_processes):
    (tmp_path / "f.12.exr").mkdir()
    ending = cli("render", movie(), "-o", tmp_path / "f.##.exr", "-j", "auto")
    assert ending.code == 1 and ending.err.count("halation: ") == 1 and "f.12.exr" in ending.err
    assert not list(tmp_path.glob(".halation-*"))


def test_what_needs_the_frame_before_is_not_shared(cli, movie, tmp_path, three_processes, monkeypatch):
    monkeypatch.setattr(sharing, "describe_share", lambda *_: pytest.fail("it is shared"))
    assert cli("render", movie("feedback"), "-o", tmp_path / "f.##.exr", "-j", "auto").code == 0
    assert len(list(tmp_path.glob("f.*.exr"))) == len(FRAMES)


@pytest.mark.parametrize("text", ["0", "-1", "many", "1.5"])
def test_other_texts_are_refused(fails, movie, text):
    assert "write a number of processes, such as -j 4, or -j auto" in fails(2, "render", movie(), "-j", text)


@pytest.mark.parametrize(
    ("cases", "cores", "memory", "expected"),
    [(100, 4, 64 * GIB, 4), (100, 4, GIB, 2), (20, 4, 64 * GIB, 2), (1, 4, 64 * GIB, 1), (100, 4, 0.0, 1)],
)
def test_processes_of_a_suite(monkeypatch, cases, cores, memory, expected):
    monkeypatch.setattr("halation.regression.parallel.available_cores", lambda: cores)
    monkeypatch.setattr("halation.regression.parallel.available_memory", lambda: memory)
    assert choose_processes(cases) == expected


def test_a_container_has_the_cores_and_the_memory_of_its_group(monkeypatch, tmp_path):
    monkeypatch.setattr(machine, "_CONTROL_GROUP", tmp_path)
    cores, memory = machine.available_cores(), machine.available_memory()
    (tmp_path / "cpu.max").write_text("max 100000\n")
    (tmp_path / "memory.max").write_text("max\n")
    (tmp_path / "memory.current").write_text("4096\n")
    assert machine.available_cores() == cores and 0.5 < machine.available_memory() / memory < 2.0
    (tmp_path / "cpu.max").write_text("50000 100000\n")
    (tmp_path / "memory.max").write_text("16384\n")
    assert machine.available_cores() == 1 and machine.available_memory() == 12288.0
