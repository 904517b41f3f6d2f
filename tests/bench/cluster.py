"""Measures `render --cluster`, and computes what a large cluster would reach: the figures of docs/cluster.md.

.venv/bin/python tests/bench/cluster.py measure     # minutes, on an idle machine
.venv/bin/python tests/bench/cluster.py overhead    # the same of 100 frames of half a second
.venv/bin/python tests/bench/cluster.py interrupt
.venv/bin/python tests/bench/cluster.py simulate    # a cluster of a thousand workers
.venv/bin/python tests/bench/cluster.py check       # the simulation against real jobs whose workers only wait
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

from cluster_simulation import ClusterCosts, ClusterSimulation

WORKERS = os.cpu_count() or 1

HALATION = (sys.executable, "-m", "halation.cli")
TRIVIAL = {
    "halation": 1,
    "nodes": {"c": {"type": "constant"}},
    "outputs": {"image": {"type": "Image"}},
    "links": {"outputs.image": "c.out"},
    "settings": {"size": [16, 9]},
}
SHOT = {
    "halation": 1,
    "nodes": {
        "ramp": {"type": "ramp"},
        "noise": {"type": "noise"},
        "mix": {"type": "merge"},
        "blur": {"type": "gaussian_blur"},
    },
    "outputs": {"image": {"type": "Image"}},
    "links": {"mix.a": "noise.out", "mix.b": "ramp.out", "blur.image": "mix.out", "outputs.image": "blur.out"},
    "animation": {"blur.sigma": {"keys": [{"frame": 1, "value": 20}, {"frame": 400, "value": 40}]}},
}
"""A value changes with each frame: of a graph that stands still, only the first frame would be rendered."""


def run(folder: Path, *words: object) -> tuple[float, float, dict[str, object]]:
    """The seconds that a render takes, those of processors, and its report. Each process draws with one thread."""
    before, started = os.times(), time.perf_counter()
    command = [*HALATION, "render", *map(str, words), "--json"]
    environment = {**os.environ, "LP_NUM_THREADS": "1"}
    ended = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=True)
    seconds, after = time.perf_counter() - started, os.times()
    processor = after.children_user + after.children_system - before.children_user - before.children_system
    return seconds, processor, json.loads(ended.stdout)


def measure_overhead(folder: Path, size: str, counts: tuple[int, int], rounds: int) -> None:
    """Seconds that a frame adds by -j and by as many workers, in turn: any number of frames has the same start."""
    (folder / "shot.json").write_text(json.dumps(SHOT))
    local = f"local:{WORKERS}"
    shares = {f"-j {WORKERS}": ("-j", WORKERS), f"--cluster {local}": ("--cluster", local)}
    measured: dict[tuple[str, int], list[tuple[float, float]]] = {}
    for _ in range(rounds):
        for count in counts:
            for name, share in shares.items():
                words = ("shot.json", "--size", size, "--frames", f"1-{count}", "-o", "f.####.exr")
                measured.setdefault((name, count), []).append(run(folder, *words, *share)[:2])
        alone, shared = (measured[name, counts[1]][-1] for name in shares)
        print(f"{counts[1]} frames: {alone[0]:.2f} s by -j, {shared[0]:.2f} s: {shared[0] / alone[0]:.3f}", flush=True)
    processors: list[float] = []
    for name in shares:
        few, many = (measured[name, count] for count in counts)
        per_frame = [
            (min(pair[part] for pair in many) - min(pair[part] for pair in few)) / (counts[1] - counts[0])
            for part in (0, 1)
        ]
        processors.append(per_frame[1])
        print(f"{name}: {per_frame[0]:.4f} s a frame, {per_frame[1]:.4f} s of processors", few, many)
    wholes = [min(pair[0] for pair in measured[name, counts[1]]) for name in shares]
    print(f"{counts[1]} frames take {wholes[1] / wholes[0]:.3f} of the time on the cluster (wanted: at most 1.05)")
    print(f"a frame takes {processors[1] / processors[0]:.3f} of processors there")


def measure_scaling(folder: Path, frames: int, size: str) -> None:
    """The same frames by one, two and four workers with a thread each."""
    words = ("shot.json", "--size", size, "--frames", f"1-{frames}", "-o", "f.####.exr")
    for count in (1, 2, 4)[: WORKERS.bit_length()]:
        print(f"local:{count}: {run(folder, *words, '--cluster', f'local:{count}')[0]:.2f} s for {frames} frames")


def measure_rate(folder: Path, frames: int) -> None:
    """Frames that cost nothing, and as many empty tasks of plain Dask."""
    from distributed import Client, LocalCluster

    (folder / "trivial.json").write_text(json.dumps(TRIVIAL))
    words = ("trivial.json", "-o", "t.####.exr", "--cluster", f"local:{WORKERS}")
    start = run(folder, *words, "--frames", "1-1")[0]
    print(f"start: {start:.2f} s for one frame that costs nothing")
    seconds, _, report = run(folder, *words, "--frames", f"1-{frames}")
    rates = f"{frames / seconds:.0f} frames a second, {frames / (seconds - start):.0f} after the start"
    print(f"--cluster local:{WORKERS}: {rates}, {report['chunks']} chunks")
    cluster = LocalCluster(WORKERS, threads_per_worker=1, processes=False, dashboard_address=":0")
    with cluster, Client(cluster) as dask:
        started = time.perf_counter()
        dask.gather(dask.map(abs, range(frames), pure=False))
        print(f"plain Dask: {frames / (time.perf_counter() - started):.0f} empty tasks a second")


def measure_interrupt(folder: Path, rounds: int) -> None:
    """Seconds from Ctrl-C to the end of the command, with a scheduler and a worker that are processes of their own."""
    sys.path.insert(0, str(Path(__file__).parents[1]))
    from farms import Farm, find_port, start_scheduler

    (folder / "shot.json").write_text(json.dumps(SHOT))
    # A shell that starts this in the background has it ignore Ctrl-C, which commands would inherit.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    port = find_port()
    farm = Farm(folder, f"tcp://127.0.0.1:{port}", start_scheduler(folder, port))
    farm.start_worker()
    try:
        for share in (("-j", "2"), ("--cluster", "local:2"), ("--cluster", farm.address)):
            measured = [interrupt_render(folder, share) for _ in range(rounds)]
            left = len(list(folder.glob(".halation-*")))
            seconds = ", ".join(f"{one:.2f}" for one in measured)
            print(f"{' '.join(share)}: {seconds} s until the command has ended, {left} unfinished files")
    finally:
        farm.stop()


def interrupt_render(folder: Path, share: tuple[str, ...]) -> float:
    """Send SIGINT to a render when two frames are written; the seconds until it has ended."""
    for path in folder.glob("i.*.exr"):
        path.unlink()
    words = ("render", "shot.json", "--size", "1280x720", "--frames", "1-999", "-o", "i.####.exr", *share)
    with subprocess.Popen([*HALATION, *words], cwd=folder, stderr=subprocess.DEVNULL) as process:
        while len(list(folder.glob("i.*.exr"))) < 2:
            time.sleep(0.02)
        began = time.perf_counter()
        process.send_signal(signal.SIGINT)
        process.wait()
        return time.perf_counter() - began


def measure_costs(workers: int, chunks: int) -> ClusterCosts:
    """What sender and scheduler take for a chunk, both together, measured with frames that take no time."""
    from cluster_stand_in import open_waiting_cluster, run_job

    with open_waiting_cluster(workers) as client:
        run_job(client, 2 * workers, 0.0)
        seconds, used, _ = run_job(client, chunks, 0.0, singly=True)
    print(f"{chunks} chunks: {seconds / chunks * 1e3:.2f} ms each, {used / chunks * 1e3:.2f} ms of processors")
    return ClusterCosts(sender=0.0, scheduler=seconds / chunks, report=0.0, decode=0.0, encode=0.0)


def check_simulation() -> None:
    """Compare the simulation with real jobs whose workers only wait, on this machine."""
    from cluster_stand_in import open_waiting_cluster, run_job

    costs = replace(measure_costs(16, 500), render=0.25)
    for workers in (4, 16, 64):
        frames = 40 * workers
        with open_waiting_cluster(workers) as client:
            seconds, _, chunks = run_job(client, frames, costs.render)
        simulated = ClusterSimulation(costs, workers, frames).run()
        facts = f"{seconds:.2f} s in {chunks} chunks, simulated {simulated.end:.2f} s in {simulated.chunk_count}"
        print(f"{workers} workers, {frames} frames of {costs.render} s: {facts}")


def print_simulation() -> None:
    """A table for docs/cluster.md: 100,000 frames."""
    print("| seconds a frame | MB read | workers | frames a second | share of the ideal | busiest |")
    for render, megabytes in ((0.1, 0.0), (0.5, 0.0), (0.5, 10.0), (5.0, 10.0), (5.0, 50.0)):
        for workers in (10, 100, 1000):
            costs = ClusterCosts(render=render, bytes_read=megabytes * 1e6)
            job = ClusterSimulation(costs, workers, 100_000).run()
            shares = job.list_shares()
            busiest = max(shares, key=lambda part: shares[part])
            facts = f"{100_000 / job.end:.0f} | {shares['workers']:.0%} | {busiest} {shares[busiest]:.0%}"
            print(f"| {render} | {megabytes:g} | {workers} | {facts} |")


def main() -> None:
    """Do what the first word says."""
    if sys.argv[1:2] == ["simulate"]:
        print_simulation()
        return
    if sys.argv[1:2] == ["check"]:
        check_simulation()
        return
    print(f"{WORKERS} cores, load {os.getloadavg()[0]:.1f}")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if sys.argv[1:2] == ["interrupt"]:
            measure_interrupt(folder, 5)
            return
        if sys.argv[1:2] == ["overhead"]:
            measure_overhead(folder, "2880x1620", (4, 100), int(sys.argv[2]) if sys.argv[2:] else 4)
            return
        measure_rate(folder, 10_000)
        measure_overhead(folder, "1280x720", (4, 44), 3)
        measure_scaling(folder, 24, "1280x720")


if __name__ == "__main__":
    main()
