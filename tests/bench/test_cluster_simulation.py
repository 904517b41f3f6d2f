"""The simulation of a cluster against closed forms."""

from __future__ import annotations

import math

import pytest
from bench.cluster_simulation import ClusterCosts, ClusterSimulation, iterate_limits

FREE = ClusterCosts(sender=0.0, scheduler=0.0, report=0.0, decode=0.0, encode=0.0)


def simulate(workers: int, frames: int, **costs: float) -> ClusterSimulation:
    return ClusterSimulation(ClusterCosts(**{**vars(FREE), **costs}), workers, frames).run()


def test_workers_alone_take_the_time_of_their_frames():
    for workers in (1, 4, 32):
        job = simulate(workers, 64 * workers, render=0.5)
        assert job.end == pytest.approx(64 * 0.5) and job.list_shares()["workers"] == pytest.approx(1.0)


def test_a_chunk_ends_with_its_last_file():
    """All other files are written while the next frame is rendered."""
    job = simulate(1, 50, render=1.0, encode=0.25)
    assert job.end == pytest.approx(50 * 1.0 + job.chunk_count * 0.25)


def test_pictures_are_read_while_frames_are_rendered():
    """Of each chunk only the first picture is waited for, if reading takes less than rendering."""
    job = simulate(1, 50, render=1.0, bytes_read=1e9, bandwidth=5e9, decode=0.1)
    assert job.end == pytest.approx(50 * 1.0 + job.chunk_count * 0.3)


def test_a_full_scheduler_hands_out_one_chunk_after_the_other():
    """A scheduler that takes longer for a chunk than all workers for theirs is never idle: D/D/1. The last worker may
    have two chunks left then, of at most 1000 frames.
    """
    job = simulate(1000, 5000, render=0.001, scheduler=0.05)
    assert job.scheduler.busy == pytest.approx(job.chunk_count * 0.05)
    assert 0.0 <= job.end - job.scheduler.busy <= 2 * 1000 * 0.001


def test_full_storage_gives_its_bytes_at_its_rate():
    job = simulate(200, 4000, render=0.5, bytes_read=30e6, bytes_written=20e6, bandwidth=1e9)
    assert job.end == pytest.approx(4000 * 50e6 / 1e9, rel=0.02)


@pytest.mark.parametrize("workers", [1, 10, 100, 1000])
@pytest.mark.parametrize("megabytes", [0.0, 10.0])
def test_no_part_does_more_than_it_can(workers, megabytes):
    """The bounds of operational analysis hold, and with few workers the lowest one is nearly reached."""
    costs = ClusterCosts(render=0.5, bytes_read=megabytes * 1e6)
    job = ClusterSimulation(costs, workers, 4000).run()
    limits = dict(iterate_limits(costs, workers, 4000 / job.chunk_count))
    assert 4000 / job.end <= min(limits.values()) * (1.0 + 1e-9)
    assert max(job.list_shares().values()) <= 1.0 + 1e-9
    if workers <= 100:
        assert 4000 / job.end > 0.85 * min(limits.values())


def test_each_frame_is_rendered_once():
    job = simulate(7, 1003, render=0.2)
    assert job.list_shares()["workers"] * job.end * 7 == pytest.approx(1003 * 0.2)
    assert job.end >= math.ceil(1003 / 7) * 0.2 - 1e-9
