"""Videos on the command line: read where a sequence may stand, written as one file."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from halation.resources.sandbox import UNRESTRICTED

av: Any = pytest.importorskip("av", reason="PyAV is not installed: pip install halation[video]")

from exr_files import read  # noqa: E402
from halation import media  # noqa: E402
from halation.nodes import Kind  # noqa: E402
from halation.renderer.execution.executor import Executor  # noqa: E402
from videos import decode_frames, number_in, write_numbers  # noqa: E402

COUNT = 9


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    """Frame n shows n; 25 frames per second."""
    return write_numbers(tmp_path / "clip.mp4", "libx264", "yuv420p", COUNT, rate=25, options={"g": "5", "bf": "2"})


@pytest.fixture
def movie(graphs, clip):
    """A graph that shows the video as it is."""

    def made(**beauty) -> Path:
        end = {"type": "Image", "file": clip.name, "layer": "", **beauty}
        return graphs("movie.json", inputs={"beauty": end}, nodes={"light": {"type": "exposure"}})

    return made


def test_a_video_stands_for_a_sequence(cli, movie, tmp_path):
    result = cli("render", movie(), "-o", tmp_path / "out.####.exr", "--json")
    assert result.code == 0, result.err
    assert result.json["frames"] == list(range(1, COUNT + 1))
    for frame in range(1, COUNT + 1):
        assert number_in(read(tmp_path / f"out.{frame:04d}.exr")) == frame


def test_a_video_bound_to_an_input_or_read_by_a_node(cli, graphs, clip, tmp_path):
    bound = graphs("bound.json", nodes={"light": {"type": "exposure"}})
    assert cli("render", bound, "-i", f"beauty={clip}", "--frame", 6, "-o", tmp_path / "a.exr").code == 0
    node = graphs(
        "node.json",
        nodes={"read": {"type": "read_image", "values": {"path": clip.name}}},
        links={"outputs.image": "read.out"},
    )
    tree = json.loads(node.read_text())
    tree["links"] = {"outputs.image": f"read.{next(iter(outputs_of('read_image')))}"}
    node.write_text(json.dumps(tree))
    assert cli("render", node, "--frame", 6, "-o", tmp_path / "b.exr").code == 0
    assert number_in(read(tmp_path / "a.exr")) == 6
    assert np.array_equal(read(tmp_path / "a.exr"), read(tmp_path / "b.exr"))


def outputs_of(node: str) -> Any:
    from halation.nodes import catalogue

    return catalogue()[node].outputs


def test_frames_beyond_the_end(cli, movie, fails, tmp_path):
    assert "has no frame 12, only 1-9" in fails(4, "render", movie(), "--frame", 12)
    held = movie(missing="hold")
    assert cli("render", held, "--frame", 12, "-o", tmp_path / "held.exr").code == 0
    assert number_in(read(tmp_path / "held.exr")) == COUNT
    black = movie(missing="black")
    assert cli("render", black, "--frame", 12, "-o", tmp_path / "black.exr").code == 0
    assert not read(tmp_path / "black.exr")[..., :3].any()


def test_info_tells_what_a_video_is(cli, clip):
    said = cli("info", clip)
    assert said.code == 0
    for words in (f"{COUNT} frames: 1-{COUNT}", "80 x 32, video, h264", "yuv420p", "25.0"):
        assert words in said.out
    facts = cli("info", clip, "--json").json
    assert facts["sequence"]["count"] == COUNT and facts["metadata"]["video:rate"] == 25.0


@pytest.mark.parametrize("name", ["out.mp4", "out.mov", "out.mkv", "out.webm"])
def test_all_frames_go_into_one_file_in_their_order(cli, movie, tmp_path, name):
    graph = movie()
    words = ("--view", "none", "--size", "80x32", "--json")
    first = cli("render", graph, "-o", tmp_path / name, *words)
    assert first.code == 0, first.err
    assert first.json["written"] == [str(tmp_path / name)]
    assert [number_in(frame) for frame in decode_frames(tmp_path / name)] == list(range(1, COUNT + 1))
    found = media.find_sequence(str(tmp_path / name), sandbox=UNRESTRICTED)
    assert found is not None and found.rate == 25  # that of the video that is read
    before = (tmp_path / name).read_bytes()
    assert cli("render", graph, "-o", tmp_path / name, *words).code == 0
    assert (tmp_path / name).read_bytes() == before
    assert not list(tmp_path.glob(".halation-*"))


def test_some_frames_backwards_beside_pictures(cli, movie, tmp_path):
    files = ("-o", tmp_path / "a.mkv", "-o", tmp_path / "a.####.png")
    result = cli("render", movie(), "--frames", "7-3x2", *files, "--json")
    assert [Path(file).name for file in result.json["written"]] == ["a.0007.png", "a.0005.png", "a.0003.png", "a.mkv"]
    assert [number_in(frame) for frame in decode_frames(tmp_path / "a.mkv")] == [7, 5, 3]
    for place, frame in enumerate((7, 5, 3), 1):
        still = media.read_layer(tmp_path / f"a.{frame:04d}.png", "", Kind.IMAGE, sandbox=UNRESTRICTED).array
        assert np.array_equal(
            media.read_layer(tmp_path / "a.mkv", "", Kind.IMAGE, frame=place, sandbox=UNRESTRICTED).array, still
        )


def test_the_rate_of_the_graph_counts(cli, graphs, clip, tmp_path):
    graph = graphs(
        inputs={"beauty": {"type": "Image", "file": clip.name, "layer": ""}},
        settings={"rate": 29.97, "frames": [2, 4]},
    )
    assert cli("render", graph, "-o", tmp_path / "a.mp4").code == 0
    assert str(media.find_sequence(str(tmp_path / "a.mp4"), sandbox=UNRESTRICTED).rate) == "30000/1001"


def test_what_cannot_be_written_is_said_before_anything_is_rendered(fails, movie, monkeypatch):
    monkeypatch.setattr(Executor, "execute_in_bands", lambda *_: pytest.fail("something was rendered"))
    graph = movie()
    for words, code, said in (
        (("-o", "a.mp4", "--codec", "vp9"), 2, "such a file holds no codec 'vp9'"),
        (("-o", "a.mkv", "--codec", "h256"), 2, "did you mean 'h265'"),
        (("-o", "a.mp4", "--size", "81x32"), 2, "width and height must be even, not 81x32"),
        (
            (
                "-o",
                "a.####.mp4",
            ),
            2,
            "remove the frame number",
        ),
        (("-o", "a.mp4", "--resume"), 2, "leave out --resume"),
        (
            (
                "-o",
                "a.avi",
            ),
            2,
            "videos are written as .mp4",
        ),
        (("-o", "a.png", "--codec", "h264", "--frame", "1"), 2, "a codec needs a video"),
        (
            (
                "-o",
                "nowhere/a.mp4",
            ),
            1,
            "there is no such folder",
        ),
    ):
        assert said in fails(code, "render", graph, *words)


def test_a_video_that_is_read_is_not_overwritten(fails, movie, clip):
    assert "is read by 'beauty'" in fails(2, "render", movie(), "-o", clip, out="clip.mp4")


def test_one_process_writes_a_video(cli, movie, tmp_path):
    result = cli("render", movie(), "-o", tmp_path / "a.mkv", "-j", 4)
    assert result.code == 0 and "one process renders all frames" in result.err
    assert [number_in(frame) for frame in decode_frames(tmp_path / "a.mkv")] == list(range(1, COUNT + 1))


def test_a_frame_that_fails_leaves_the_older_video(fails, movie):
    fails(4, "render", movie(), "--frames", "7-12", "-o", "out.mp4", out="out.mp4")


@pytest.mark.skipif(os.name == "nt", reason="signals and limits")
def test_an_interruption_leaves_nothing_half_written(movie, tmp_path):
    graph = movie(missing="nearest")
    out = tmp_path / "out.mp4"
    process = subprocess.Popen(
        [sys.executable, "-m", "halation.cli", "render", graph, "-o", out, "--frames", "1-5000", "--progress=json"],
        stderr=subprocess.PIPE,
        text=True,
    )
    for line in process.stderr:
        if '"done": 3' in line:
            process.send_signal(signal.SIGINT)
            break
    _, rest = process.communicate(timeout=60)
    assert process.returncode == 130 and "interrupted" in rest
    assert not out.exists() and not list(tmp_path.glob(".halation-*"))


@pytest.mark.skipif(os.name == "nt", reason="signals and limits")
@pytest.mark.parametrize("name", ["out.mkv", "out.mov"])
def test_a_full_disk_leaves_nothing_half_written(movie, tmp_path, name):
    """A limit on the size of files fails in the same way, and any user may set it."""
    code = (
        "import resource, sys; resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000)); "
        "from halation.cli.program import run; sys.exit(run(sys.argv[1:]))"
    )
    words = ["render", movie(missing="nearest"), "-o", tmp_path / name, "--frames", "1-60", "--size", "240x96"]
    result = subprocess.run([sys.executable, "-c", code, *map(str, words)], capture_output=True, text=True)
    assert result.returncode == 1, result
    assert "cannot be written" in result.stderr.splitlines()[-1] and "Traceback" not in result.stderr
    assert not (tmp_path / name).exists() and not list(tmp_path.glob(".halation-*"))


def test_without_pyav_there_is_a_sentence(fails, movie, monkeypatch):
    from halation.media.video import codecs, index

    graph = movie()
    monkeypatch.setattr(index, "load_pyav", lambda: None)
    monkeypatch.setattr(codecs, "load_pyav", lambda: None)
    index.survey_video.cache_clear()
    assert "pip install halation[video]" in fails(4, "render", graph, "--frame", 1)
    plain = graph.with_name("plain.json")
    tree = json.loads(graph.read_text())
    tree["inputs"]["beauty"] = {"type": "Image", "file": "shot.exr", "layer": "Combined"}
    plain.write_text(json.dumps(tree))
    assert "pip install halation[video]" in fails(2, "render", plain, "-o", "out.mp4", out="out.mp4")
