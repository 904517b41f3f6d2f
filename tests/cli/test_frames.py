"""`halation render` over many frames: names, parts, history, resuming, sharing, interruptions."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from exr_files import header, read, write_exr

FRAMES = range(1, 9)
ZYGOTE = Path(__file__).with_name("killed.py")
POSIX = pytest.mark.skipif(os.name == "nt", reason="fork and SIGKILL")


def flat(number: float) -> np.ndarray:
    return np.full((16, 24, 4), number, np.float32)


@pytest.fixture
def sequence(tmp_path) -> Path:
    """shot.0001.exr ... shot.0008.exr: frame n is n / 8 everywhere."""
    (tmp_path / "in").mkdir()
    for frame in FRAMES:
        write_exr(tmp_path / "in" / f"shot.{frame:04d}.exr", {"Combined": flat(frame / 8.0)}, {"Combined": "float"})
    return tmp_path / "in"


@pytest.fixture
def movie(graphs, sequence):
    """`movie(nodes, links, **parts)`: a graph over the sequence; by default its light passes through unchanged."""

    def made(nodes=None, links=None, name="movie.json", **parts):
        beauty = {"type": "Image", "file": "in/shot.####.exr", "layer": "Combined", **parts.pop("beauty", {})}
        path = graphs(name, inputs={"beauty": beauty}, **parts)
        tree = json.loads(path.read_text())
        tree["nodes"] = {"light": {"type": "exposure"}, **(nodes or {})}
        tree["links"].update(links or {})
        path.write_text(json.dumps(tree))
        return path

    return made


TRAIL = ({"trail": {"type": "frame_blend"}}, {"trail.image": "light.out", "outputs.image": "trail.out"})


def rendered(cli, path: Path, out: str, *words) -> dict:
    result = cli("render", path, "-o", path.parent / out, "--precision=float", *words, "--json")
    assert result.code == 0, result.err
    return result.json


def pixels(folder: Path, stem: str, frames=FRAMES) -> list[float]:
    return [float(read(folder / f"{stem}.{frame:04d}.exr")[3, 4, 0]) for frame in frames]


def test_all_frames_of_the_sequence(cli, movie, tmp_path):
    report = rendered(cli, movie(), "out.####.exr")
    assert report["frames"] == list(FRAMES) and len(report["written"]) == 8
    assert pixels(tmp_path, "out") == [frame / 8.0 for frame in FRAMES]
    assert json.loads(header(tmp_path / "out.0003.exr")["halation:job"])["frame"] == 3


def test_some_frames_in_any_order(cli, movie, tmp_path):
    report = rendered(cli, movie(), "out.%03d.exr", "--frames", "7,5-1x2")
    assert report["frames"] == [7, 5, 3, 1]
    assert sorted(path.name for path in tmp_path.glob("out*")) == [f"out.00{frame}.exr" for frame in (1, 3, 5, 7)]


def test_one_frame(cli, movie, tmp_path):
    rendered(cli, movie(), "out.exr", "--frame", 4)
    assert read(tmp_path / "out.exr")[0, 0, 0] == 0.5
    assert rendered(cli, movie(), "first.exr")["frames"] == [1]


def test_many_frames_need_many_names(cli, movie, tmp_path):
    result = cli("render", movie(), "-o", tmp_path / "out.exr", "--frames", "1-3")
    assert result.code == 2 and "out.exr: 3 frames cannot go into one file: write -o" in result.err


def test_frame_and_frames_exclude_each_other(fails, movie):
    assert fails(2, "render", movie(), "--frame", "1", "--frames", "1-2") == "--frame and --frames: give one of them"


@pytest.mark.parametrize(
    ("missing", "expected"), [("hold", [1, 1, 3, 4]), ("nearest", [1, 1, 3, 4]), ("black", [1, 0, 3, 4])]
)
def test_missing_frames(cli, movie, sequence, tmp_path, missing, expected):
    (sequence / "shot.0002.exr").unlink()
    rendered(cli, movie(beauty={"missing": missing}), "out.####.exr", "--frames", "1-4")
    assert pixels(tmp_path, "out", range(1, 5)) == [number / 8.0 for number in expected]


def test_a_missing_frame_is_named_before_and_while_rendering(cli, movie, sequence, tmp_path):
    (sequence / "shot.0005.exr").unlink()
    checked = cli("check", movie())
    assert checked.code == 4 and "shot.0005.exr: there is no such file, only frames 1-4,6-8" in checked.out
    result = cli("render", movie(), "-o", tmp_path / "out.####.exr")
    assert result.code == 4 and "shot.0005.exr" in result.err
    assert pixels(tmp_path, "out", range(1, 4)) == [1 / 8, 2 / 8, 3 / 8]


def test_a_sequence_bound_to_an_input(cli, movie, tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    for frame in (20, 21):
        write_exr(other / f"b.{frame}.exr", {"Combined": flat(frame)}, {"Combined": "float"})
    report = rendered(cli, movie(), "out.####.exr", "-i", f"beauty={other}/b.%d.exr")
    assert report["frames"] == [20, 21] and pixels(tmp_path, "out", (20, 21)) == [20.0, 21.0]
    assert rendered(cli, movie(), "again.####.exr", "-i", f"beauty={other}")["frames"] == [20, 21]


def test_keys_and_expressions_on_the_command_line(cli, movie, tmp_path):
    rendered(cli, movie(), "keys.####.exr", "--set", "light.stops=1@1:linear,8@8")
    assert pixels(tmp_path, "keys") == pytest.approx([frame / 8 * 2**frame for frame in FRAMES])
    rendered(cli, movie(), "said.####.exr", "--set", "light.stops==frame > 4 ? 1 : 0")
    assert pixels(tmp_path, "said") == [frame / 8 * (2 if frame > 4 else 1) for frame in FRAMES]


def test_an_expression_at_fault_is_pointed_at(cli, movie, tmp_path):
    result = cli("render", movie(), "-o", tmp_path / "out.exr", "--set", "light.stops==frme * 2")
    assert result.code == 2 and "frme" in result.err and "Traceback" not in result.err
    assert re.search(r"^\s*\^+", result.err, re.M), result.err


def test_what_stays_the_same_is_computed_once(cli, movie):
    """The noise and its blur are the same in all frames; the exposure that is keyed takes one pass for each."""
    nodes = {
        "noise": {"type": "noise"},
        "mix": {"type": "merge"},
        "soft": {"type": "gaussian_blur", "values": {"sigma": 2.0}},
    }
    links = {"soft.image": "noise.out", "mix.a": "soft.out", "mix.b": "light.out", "outputs.image": "mix.out"}
    path = movie(nodes, links)
    keys = ("--set", "light.stops=1@1,8@8")
    one = rendered(cli, path, "one.exr", *keys, "--frame", "1")["passes"]
    assert one >= 3
    assert rendered(cli, path, "out.####.exr", *keys)["passes"] == one + 7


def test_history_in_one_run_and_in_two(cli, movie, tmp_path):
    path = movie(*TRAIL)
    rendered(cli, path, "whole.####.exr")
    rendered(cli, path, "part.####.exr", "--frames", "1-4")
    rendered(cli, path, "part.####.exr", "--frames", "5-8")
    for frame in FRAMES:
        whole, part = (tmp_path / f"{stem}.{frame:04d}.exr" for stem in ("whole", "part"))
        assert whole.read_bytes() == part.read_bytes()
    assert len(set(pixels(tmp_path, "whole"))) == 8


def test_explain_says_whether_frames_are_independent(cli, movie):
    assert "independent" in cli("explain", movie()).out
    assert "'trail'" in cli("explain", movie(*TRAIL)).out
    assert cli("explain", movie(*TRAIL), "--json").json["frames"] == {"independent": False, "remembering": ["trail"]}


def test_several_processes(cli, movie, tmp_path):
    rendered(cli, movie(), "one.####.exr")
    report = rendered(cli, movie(), "two.####.exr", "-j", 2)
    assert report["frames"] == list(FRAMES) and [Path(path).name for path in report["written"]] == [
        f"two.{frame:04d}.exr" for frame in FRAMES
    ]
    for frame in FRAMES:
        one, two = (tmp_path / f"{stem}.{frame:04d}.exr" for stem in ("one", "two"))
        assert one.read_bytes() == two.read_bytes()


@POSIX
def test_several_processes_share_a_graph_from_standard_input(movie, tmp_path):
    result = subprocess.run(
        [
            sys.executable,
            "-m",
            "halation.cli",
            "render",
            "-",
            "-o",
            tmp_path / "out.####.exr",
            "-j",
            "2",
            "--set",
            "light.stops=1",
            "--frames=1-3",
            "--precision=float",
        ],
        input=movie().read_text(),
        capture_output=True,
        text=True,
        cwd=tmp_path,
        timeout=100,
    )
    assert result.returncode == 0, result.stderr
    assert pixels(tmp_path, "out", (1, 2, 3)) == [2 / 8, 4 / 8, 6 / 8]


def test_dependent_frames_are_not_shared(cli, movie, tmp_path):
    result = cli("render", movie(*TRAIL), "-o", tmp_path / "out.####.exr", "-j", 2)
    assert result.code == 0 and "one process renders all frames: node 'trail'" in result.err


def test_a_fault_in_one_process_is_that_of_all(cli, movie, sequence, tmp_path):
    (sequence / "shot.0006.exr").write_bytes(b"no picture")
    result = cli("render", movie(), "-o", tmp_path / "out.####.exr", "-j", 2)
    assert result.code == 4 and result.err.count("halation: ") == 1 and "shot.0006.exr" in result.err


def test_resume_redoes_what_is_not_as_it_would_be(cli, movie, sequence, tmp_path):
    path = movie()
    rendered(cli, path, "out.####.exr")
    before = {file.name: file.read_bytes() for file in tmp_path.glob("out.*.exr")}
    assert rendered(cli, path, "out.####.exr", "--resume")["kept"] == list(FRAMES)
    (tmp_path / "out.0002.exr").unlink()
    (tmp_path / "out.0003.exr").write_bytes(b"something else")
    shutil.copy(sequence / "shot.0001.exr", tmp_path / "out.0004.exr")
    (tmp_path / "out.0005.exr").write_bytes(before["out.0005.exr"][:400])
    assert rendered(cli, path, "out.####.exr", "--resume")["kept"] == [1, 6, 7, 8]
    assert {file.name: file.read_bytes() for file in tmp_path.glob("out.*.exr")} == before
    write_exr(sequence / "shot.0007.exr", {"Combined": flat(9.0)}, {"Combined": "float"})
    assert rendered(cli, path, "out.####.exr", "--resume")["kept"] == [1, 2, 3, 4, 5, 6, 8]
    assert rendered(cli, path, "out.####.exr", "--resume", "--set", "light.stops=1")["kept"] == []
    assert rendered(cli, path, "out.####.exr", "--resume", "--set", "light.stops=1@1,2@2")["kept"] == [1]


def test_resume_knows_what_history_was_made_of(cli, movie, sequence, tmp_path):
    """An early frame that changed makes all later ones others."""
    path = movie(*TRAIL)
    rendered(cli, path, "out.####.exr")
    write_exr(sequence / "shot.0004.exr", {"Combined": flat(9.0)}, {"Combined": "float"})
    assert rendered(cli, path, "out.####.exr", "--resume")["kept"] == [1, 2, 3]
    rendered(cli, path, "new.####.exr")
    assert pixels(tmp_path, "out") == pixels(tmp_path, "new")


@pytest.mark.parametrize("ending", ["png", "tif", "jpg", "webp"])
def test_resume_in_other_formats(cli, movie, tmp_path, ending):
    """Formats that cannot hold the mark are rendered again: never wrong, only slower."""
    rendered(cli, movie(), f"out.####.{ending}", "--frames", "1-2")
    kept = rendered(cli, movie(), f"out.####.{ending}", "--frames", "1-2", "--resume")["kept"]
    assert kept == ([1, 2] if ending == "png" else kept)


def test_no_mark_of_an_input_goes_on(cli, movie, graphs, tmp_path):
    """A rendered picture that is read again does not pass on how it was made itself."""
    rendered(cli, movie(), "out.####.exr", "--frames", "1")
    again = graphs("again.json", inputs={"beauty": {"type": "Image", "file": "out.0001.exr"}})
    rendered(cli, again, "twice.exr")
    said = header(tmp_path / "twice.exr")
    assert said["halation:key"] != header(tmp_path / "out.0001.exr")["halation:key"]
    assert "in/shot" not in said["halation:graph"]


@POSIX
def test_an_interruption_leaves_what_is_finished(movie, tmp_path):
    slow = movie(
        {"blur": {"type": "gaussian_blur", "values": {"sigma": 40.0}}},
        {"blur.image": "light.out", "outputs.image": "blur.out"},
        settings={"frames": [1, 5000]},
        beauty={"missing": "nearest"},
    )
    process = subprocess.Popen(
        [sys.executable, "-m", "halation.cli", "render", slow, "-o", tmp_path / "out.####.exr", "--progress=json"],
        stderr=subprocess.PIPE,
        text=True,
    )
    for line in process.stderr:
        if '"done": 3' in line:
            process.send_signal(signal.SIGINT)
            break
    _, rest = process.communicate(timeout=60)
    assert process.returncode == 130 and "interrupted" in rest
    done = sorted(tmp_path.glob("out.*.exr"))
    assert 3 <= len(done) < 5000 and all(read(file).shape[:2] == (16, 24) for file in done)
    assert not list(tmp_path.glob(".halation-*"))


@POSIX
def test_kills_leave_no_half_frame_and_resume_ends_the_same(cli, movie, tmp_path, is_nightly):
    """16 processes, 200 at night, killed at random moments of a sequence with history; then one that ends by itself."""
    count = 200 if is_nightly else 16
    path = movie(*TRAIL)
    rendered(cli, path, "whole.####.exr")
    whole = {frame: (tmp_path / f"whole.{frame:04d}.exr").read_bytes() for frame in FRAMES}
    words = [path, "-o", tmp_path / "out.####.exr", "--precision=float", "--resume"]
    result = subprocess.run(
        [sys.executable, ZYGOTE, str(count), *map(str, words)], capture_output=True, text=True, timeout=600
    )
    assert result.returncode == 0, result.stderr
    killed, seen = json.loads(result.stdout)
    assert killed >= count / 2 and seen >= count / 4, (killed, seen)
    assert rendered(cli, path, "out.####.exr", "--resume")["frames"] == list(FRAMES)
    for frame, expected in whole.items():
        assert (tmp_path / f"out.{frame:04d}.exr").read_bytes() == expected


def test_abandoned_parts_are_swept(cli, movie, tmp_path):
    old, new = tmp_path / ".halation-1-aa.exr", tmp_path / ".halation-2-bb.exr"
    for part in (old, new):
        part.write_bytes(b"half")
    os.utime(old, (time.time() - 7200,) * 2)
    rendered(cli, movie(), "out.####.exr", "--frames", "1-2", "--resume")
    assert not old.exists() and new.exists()
