"""Workers that die, crash, lack something, or are no longer wanted: frames are whole, and all others are finished."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest
from farms import FRAMES, end_group, read_frames, start_halation

pytest.importorskip("distributed", reason="Dask is not installed")

SLOW = """
import sys, time
if "--chunks" in sys.orig_argv:
    from halation.renderer.jobs import item_session
    plan = item_session.ItemSession.plan_task
    def plan_task(self, frame):
        time.sleep(0.4)
        return plan(self, frame)
    item_session.ItemSession.plan_task = plan_task
"""
"""Loaded by each Python of a worker (`sitecustomize`): frames that take long."""

FULL = """
import errno, sys
if "--chunks" in sys.orig_argv:
    import os
    def reserve(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    os.posix_fallocate = reserve
"""
"""The same: a disk that is full."""

OLD = """
import halation.version
halation.version.VERSION = "0.0.7"
"""
"""The same: an older version of Halation."""

BLIND = """
import sys
if "--chunks" in sys.orig_argv:
    from halation.errors import DeviceError
    from halation import renderer
    from halation.renderer import pinned_device
    def open_pinned(*_, **__):
        raise DeviceError("no usable OpenGL: install a driver")
    pinned_device.open_pinned = renderer.open_pinned = open_pinned
"""
"""The same: a machine without OpenGL."""


def customize(folder: Path, text: str) -> dict[str, str]:
    """The environment of a worker all of whose Pythons run a text first."""
    folder.mkdir()
    (folder / "sitecustomize.py").write_text(text)
    return {"PYTHONPATH": str(folder)}


def render_words(farm, frames="1-8"):
    words = ("-o", "f.####.exr", "--deterministic", "--frames", frames, "--cluster", farm.address)
    return ("render", "shot.json", *words)


def list_written(shot) -> list[int]:
    return sorted(int(path.name[2:6]) for path in shot.glob("f.*.exr"))


def wait_for_frames(shot, count, seconds=60.0):
    for _ in range(int(seconds / 0.02)):
        if len(list_written(shot)) >= count:
            return
        time.sleep(0.02)
    raise AssertionError(f"{list_written(shot)} of {count} frames")


def check_whole(halation, shot):
    """All frames are those of one process, and nothing else is left."""
    (shot / "one").mkdir()
    assert halation("render", "shot.json", "-o", "one/f.####.exr", "--deterministic").code == 0
    assert read_frames(shot) == read_frames(shot / "one")
    assert not list(shot.glob(".halation-*"))


def test_a_frame_that_ends_its_process_each_time_is_named_and_others_are_finished(halation, shot, farm):
    graph = json.loads((shot / "shot.json").read_text())
    graph["inputs"]["plate"]["missing"] = "hold"
    (shot / "shot.json").write_text(json.dumps(graph))
    ending = halation(*render_words(farm, "660-670"), "--json")
    assert ending.code == 1
    assert "frame 666: its process was ended by SIGKILL each time, on 3 tries" in ending.err, ending.err
    report = json.loads(ending.out)
    assert list(report["failed"]) == ["666"]
    assert list_written(shot) == [frame for frame in range(660, 671) if frame != 666]


def test_machines_that_cannot_render_the_same_are_refused_with_the_reason(halation, shot, make_farm, tmp_path):
    """One has another version, one no OpenGL, one a full disk; the last one renders everything."""
    farm = make_farm()
    for name, text in (("old", OLD), ("blind", BLIND), ("full", FULL)):
        farm.start_worker(**customize(tmp_path / name, text))
    farm.start_worker()
    ending = halation(*render_words(farm))
    assert ending.code == 0, ending.err
    lines = [line for line in ending.err.splitlines() if line.startswith("worker tcp://")]
    assert any("it has Halation 0.0.7, and the job was sent by " in line for line in lines), lines
    check_whole(halation, shot)
    end_group(farm.workers[3])
    ending = halation(*render_words(farm))
    assert ending.code == 1 and "no usable OpenGL: install a driver" in ending.err, ending.err


def test_a_killed_worker_and_a_new_one(halation, shot, make_farm, tmp_path):
    farm = make_farm()
    slow = customize(tmp_path / "slow", SLOW)
    for _ in range(2):
        farm.start_worker(**slow)
    process = start_halation(*render_words(farm), cwd=shot)
    wait_for_frames(shot, 2)
    end_group(farm.workers[0])
    farm.start_worker(**slow)
    _, err = process.communicate(timeout=100)
    assert process.returncode == 0, err
    check_whole(halation, shot)


def test_without_its_scheduler_a_job_ends_with_a_sentence_and_goes_on_later(halation, shot, make_farm, tmp_path):
    farm = make_farm()
    farm.start_worker(**customize(tmp_path / "slow", SLOW))
    process = start_halation(*render_words(farm), cwd=shot)
    wait_for_frames(shot, 2)
    end_group(farm.scheduler)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1
    assert "the scheduler has gone" in err.splitlines()[-1] and "--resume" in err, err
    finished = {frame: (shot / f"f.{frame:04d}.exr").stat().st_mtime_ns for frame in list_written(shot)}
    ending = halation("render", "shot.json", "-o", "f.####.exr", "--deterministic", "--cluster", "local:1", "--resume")
    assert ending.code == 0, ending.err
    assert all((shot / f"f.{frame:04d}.exr").stat().st_mtime_ns == date for frame, date in finished.items())
    check_whole(halation, shot)


@pytest.mark.parametrize("place", ["farm", "local"])
def test_an_interrupt_ends_a_job_soon_and_leaves_finished_frames(
    shot, make_farm, tmp_path, place, monkeypatch, is_nightly
):
    if place == "local" and not is_nightly:
        pytest.skip("tried nightly")
    slow = customize(tmp_path / "slow", SLOW)
    if place == "farm":
        farm = make_farm()
        farm.start_worker(**slow)
        words = render_words(farm)
    else:
        monkeypatch.setenv("PYTHONPATH", slow["PYTHONPATH"])
        words = ("render", "shot.json", "-o", "f.####.exr", "--deterministic", "--cluster", "local:1")
    process = start_halation(*words, cwd=shot)
    wait_for_frames(shot, 2)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=30)
    assert process.returncode == 130 and "interrupted" in err, err
    time.sleep(1.5)
    written = list_written(shot)
    assert len(written) < len(FRAMES) and not list(shot.glob(".halation-*"))
    time.sleep(1.0)
    assert list_written(shot) == written
    assert os.name == "nt" or not find_processes(shot)


def find_processes(shot) -> list[str]:
    """Processes that render chunks in the folder of a shot."""
    lines = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=True).stdout.splitlines()
    return [line for line in lines if "--chunks" in line and str(shot) in line]
