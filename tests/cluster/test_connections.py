"""Schedulers that are started again, connections that are cut, and jobs of several users."""

from __future__ import annotations

import socket
import time
from contextlib import nullcontext
from types import SimpleNamespace

import pytest
from farms import (
    FRAMES,
    SLOW,
    Proxy,
    check_whole,
    customize,
    end_group,
    list_written,
    read_frames,
    render_words,
    start_halation,
    start_scheduler,
    wait_for_frames,
)
from halation.cluster import connection
from halation.errors import RenderError
from halation.renderer.jobs.render_job import RenderJob
from halation.resources.sandbox import UNRESTRICTED

pytest.importorskip("distributed", reason="Dask is not installed")

IMPATIENT = """
import sys
if "render" in sys.orig_argv:
    from halation.cluster import connection
    connection.RETURN_SECONDS = 0.5
"""
"""Loaded by each Python: a sender that does not wait for a scheduler."""


@pytest.fixture
def slow_farm(make_farm, tmp_path):
    """A scheduler and a worker whose frames take long."""
    farm = make_farm()
    farm.slow = customize(tmp_path / "slow", SLOW)
    farm.start_worker(**farm.slow)
    return farm


def restart_scheduler(farm):
    end_group(farm.scheduler)
    time.sleep(0.5)
    farm.scheduler = start_scheduler(farm.folder, int(farm.address.rpartition(":")[2]))
    farm.start_worker(**farm.slow)


class BreakingClient:
    """Stands in for a client of Dask whose connection breaks while it is opened, as often as it says."""

    left = 0

    def __init__(self, *_, **__):
        if BreakingClient.left:
            BreakingClient.left -= 1
            raise AssertionError  # what Dask says where the first words of a scheduler are no greeting

    def close(self, timeout):
        pass


def test_a_connection_that_breaks_while_it_is_opened_is_tried_again(monkeypatch):
    monkeypatch.setattr("distributed.Client", BreakingClient)
    monkeypatch.setattr(connection, "_RETRY_INTERVAL", 0.0)
    with socket.create_server(("127.0.0.1", 0)) as listener:
        address = f"tcp://127.0.0.1:{listener.getsockname()[1]}"
        BreakingClient.left = 3
        with connection.open_client(address) as client:
            assert isinstance(client, BreakingClient) and not BreakingClient.left
        BreakingClient.left = 1
        monkeypatch.setattr(connection, "CONNECT_SECONDS", 0.0)
        with pytest.raises(RenderError, match="no scheduler answers there: start one"), connection.open_client(address):
            pass


@pytest.mark.parametrize(
    ("address", "frames", "count"),
    [("local:4", 2, 2), ("local:2", 9, 2), ("local:3", 0, 3), ("tcp://farm:8786", 9, None)],
)
def test_as_many_processes_are_warmed_as_there_are_workers_and_frames(monkeypatch, address, frames, count):
    """A job of videos or files does not say how many frames it has."""
    job, warmed = RenderJob(sandbox=UNRESTRICTED, frames=tuple(range(frames))), []
    pool = SimpleNamespace(close=lambda: warmed.append("closed"), warm=lambda *words: warmed.append(words))
    monkeypatch.setattr(connection, "open_pool", lambda: pool)
    monkeypatch.setattr(connection, "_connect", lambda *words: nullcontext(words))
    with connection.open_client(address, job) as words:
        assert words == (address, int(address[-1]) if count else 0)
        assert warmed == ([(job, count)] if count else [])
    assert warmed[1:] == (["closed"] if count else [])


def test_a_job_goes_on_when_its_scheduler_is_started_again(halation, shot, slow_farm):
    process = start_halation(*render_words(slow_farm), cwd=shot)
    wait_for_frames(shot, 2)
    restart_scheduler(slow_farm)
    _, err = process.communicate(timeout=100)
    assert process.returncode == 0, err
    check_whole(halation, shot)


def test_without_its_scheduler_a_job_ends_with_a_sentence_and_goes_on_later(
    halation, shot, slow_farm, monkeypatch, tmp_path
):
    monkeypatch.setenv("PYTHONPATH", customize(tmp_path / "sender", IMPATIENT)["PYTHONPATH"])
    process = start_halation(*render_words(slow_farm), cwd=shot)
    wait_for_frames(shot, 2)
    end_group(slow_farm.scheduler)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1
    assert "the scheduler has gone" in err.splitlines()[-1] and "--resume" in err, err
    finished = {frame: (shot / f"f.{frame:04d}.exr").stat().st_mtime_ns for frame in list_written(shot)}
    ending = halation("render", "shot.json", "-o", "f.####.exr", "--deterministic", "--cluster", "local:1", "--resume")
    assert ending.code == 0, ending.err
    assert all((shot / f"f.{frame:04d}.exr").stat().st_mtime_ns == date for frame, date in finished.items())
    check_whole(halation, shot)


@pytest.mark.parametrize("end", ["sender", "worker"])
def test_a_connection_that_is_cut_loses_no_frame(halation, shot, make_farm, tmp_path, end):
    farm = make_farm()
    slow, direct = customize(tmp_path / "slow", SLOW), farm.address
    proxy = Proxy(int(direct.rpartition(":")[2]))
    through_proxy = f"tcp://127.0.0.1:{proxy.port}"
    farm.start_worker(**slow)
    farm.address = through_proxy if end == "worker" else direct
    farm.start_worker(**slow)
    farm.address = through_proxy if end == "sender" else direct
    process = start_halation(*render_words(farm), cwd=shot)
    wait_for_frames(shot, 2)
    proxy.cut()
    _, err = process.communicate(timeout=100)
    proxy.close()
    assert process.returncode == 0, err
    check_whole(halation, shot)


def test_jobs_of_two_users_run_side_by_side_and_a_higher_priority_goes_first(shot, slow_farm):
    """One worker: the frames of two equal jobs alternate, and an urgent job overtakes both."""
    processes = []
    for name, priority in (("a", "0"), ("b", "0"), ("urgent", "5")):
        (shot / name).mkdir()
        words = ("-o", f"{name}/f.####.exr", "--frames", "1-8", "--deterministic", "--priority", priority)
        processes.append(start_halation("render", "shot.json", *words, "--cluster", slow_farm.address, cwd=shot))
        if name == "a":
            wait_for_frames(shot / name, 1)
    for process in processes:
        _, err = process.communicate(timeout=100)
        assert process.returncode == 0, err
    dates = {name: sorted(path.stat().st_mtime_ns for path in (shot / name).iterdir()) for name in ("a", "b", "urgent")}
    assert dates["urgent"][-1] < max(dates["a"][-1], dates["b"][-1])
    assert dates["b"][0] < dates["a"][-1] or dates["a"][0] < dates["b"][-1]
    assert [len(each) for each in dates.values()] == [8, 8, 8]
    assert read_frames(shot / "a") == read_frames(shot / "b") == read_frames(shot / "urgent", FRAMES)
