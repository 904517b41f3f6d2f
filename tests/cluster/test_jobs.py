"""`render --detach` and `halation jobs`, and which workers get frames."""

from __future__ import annotations

import json
import os
import re
import sys
import time

import pytest
from farms import FRAMES, SLOW, check_whole, customize, end_group, read_frames, wait_for_frames

pytest.importorskip("distributed", reason="Dask is not installed")

PATIENCE = 60.0
"""Seconds for frames that are under way when their job is cancelled."""


def list_jobs(halation, farm):
    return json.loads(halation("jobs", "--cluster", farm.address, "--json").out)["jobs"]


def send(halation, farm, *words):
    return halation("render", "shot.json", "--deterministic", "--detach", "--cluster", farm.address, "--json", *words)


def test_a_job_goes_on_without_its_sender_and_is_followed_and_forgotten(halation, shot, farm):
    ending = send(halation, farm, "-o", "f.####.exr")
    assert ending.code == 0, ending.err
    name = json.loads(ending.out)["job"]
    followed = halation("jobs", "--cluster", farm.address, "--follow", name)
    assert followed.code == 0 and re.search(rf"{name}  finished  8 of 8 frames.*  shot\.json$", followed.out), followed
    (shot / "one").mkdir()
    assert halation("render", "shot.json", "-o", "one/f.####.exr", "--deterministic").code == 0
    assert read_frames(shot) == read_frames(shot / "one")
    assert [(job["name"], job["state"]) for job in list_jobs(halation, farm)] == [(name, "finished")]
    assert halation("jobs", "--cluster", farm.address, "--cancel", name).code == 0
    assert list_jobs(halation, farm) == []
    ending = halation("jobs", "--cluster", farm.address, "--follow", name)
    assert ending.code == 2 and "the cluster has no such job" in ending.err


def test_a_job_that_is_cancelled_leaves_finished_frames_and_nothing_else(halation, shot, farm):
    graph = json.loads((shot / "shot.json").read_text())
    graph["inputs"]["plate"]["missing"] = "hold"
    (shot / "shot.json").write_text(json.dumps(graph))
    ending = send(halation, farm, "-o", "f.####.exr", "--frames", "1001-5000")
    assert ending.code == 0, ending.err
    name = json.loads(ending.out)["job"]
    while not list(shot.glob("f.*.exr")):
        time.sleep(0.05)
    (job,) = list_jobs(halation, farm)
    assert job["state"] == "rendering" and job["total"] == 4000 and job["graph"] == "shot.json"
    assert halation("jobs", "--cluster", farm.address, "--cancel", name).code == 0
    written, deadline = -1, time.monotonic() + PATIENCE  # frames that are under way are still finished
    while (count := len(list(shot.glob("f.*.exr")))) != written or list(shot.glob(".halation-*")):
        assert time.monotonic() < deadline, list(shot.glob(".halation-*"))
        written = count
        time.sleep(1.0)
    assert written < 4000


def test_a_job_goes_on_when_the_worker_that_conducts_it_is_killed(halation, shot, make_farm, tmp_path):
    from distributed import Client

    farm, slow = make_farm(), customize(tmp_path / "slow", SLOW)
    groups = {farm.start_worker(**slow) for _ in range(2)}
    name = json.loads(send(halation, farm, "-o", "f.####.exr").out)["job"]
    wait_for_frames(shot, 2)
    with Client(farm.address, set_as_default=False) as client:
        (conductor,) = (address for address, keys in client.processing().items() if name in keys)
        process = client.run(os.getpid, workers=[conductor])[conductor]
    assert os.getpgid(process) in groups
    end_group(os.getpgid(process))
    followed = halation("jobs", "--cluster", farm.address, "--follow", name)
    assert followed.code == 0 and f"{name}  finished  8 of 8 frames" in followed.out, followed
    check_whole(halation, shot)


def test_only_workers_with_a_gpu_render_where_there_are_some(halation, shot, farm):
    farm.start_worker("--resources", "GPU=1")
    words = ("-o", "f.####.exr", "--cluster", farm.address, "--priority", "5", "--json")
    while json.loads(halation("render", "shot.json", *words).out)["workers"] != 1:
        time.sleep(0.1)  # until the new worker is connected
    ending = halation("render", "shot.json", *words, "--deterministic")
    assert json.loads(ending.out)["workers"] > 1 and len(list(shot.glob("f.*.exr"))) == len(FRAMES)


@pytest.mark.skipif(sys.platform != "linux", reason="this system has no EGL")
def test_each_worker_of_a_machine_renders_on_the_device_that_it_is_told(halation, shot, make_farm):
    """There is no tenth one here, so its worker is refused. Pinned pixels come from the software rasterizer anyway."""
    farm = make_farm()
    for place in ("9", "0"):
        farm.start_worker(GLCONTEXT_DEVICE_INDEX=place)
    words = ("render", "shot.json", "-o", "f.####.exr", "--cluster", farm.address, "--json")
    ending = halation(*words)
    while json.loads(ending.out)["workers"] == 1 and "it gets no frames" not in ending.err:
        ending = halation(*words)  # until the other one is connected
    assert ending.code == 0 and re.search(r"worker tcp://\S+: .*requested device index 9", ending.err), ending.err
    end_group(farm.workers.pop(1))
    ending = halation(*words, "--deterministic")
    assert ending.code == 0 and json.loads(ending.out)["workers"] == 1, ending.err
    check_whole(halation, shot)


def test_a_suite_is_shared_and_reports_what_one_process_does(halation, shot, farm):
    cases = """
    [cases.look]
    graph = "shot.json"
    frames = [1, 2]
    golden = "golden.####.exr"
    [cases.missing]
    graph = "shot.json"
    frames = [99]
    golden = ""
    [cases.expected]
    graph = "shot.json"
    frames = [99]
    golden = ""
    error = "there is no"
    """
    (shot / "a.suite.toml").write_text(cases)
    halation("test", "--update")
    here, there = halation("test", "--json"), halation("test", "--json", "--cluster", farm.address)
    assert here.code == there.code == 1, there.err
    reports = [json.loads(ending.out) for ending in (here, there)]
    outcomes = [{case["id"]: case["status"] for case in report["cases"]} for report in reports]
    assert outcomes[0] == outcomes[1] and set(outcomes[0].values()) == {"failed", "passed"}, outcomes
    assert halation("test", "--cluster", farm.address, "-j", "2").code == 2
