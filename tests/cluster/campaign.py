"""Renders shots again and again while a cluster is harmed at random, and compares all frames with one process.

.venv/bin/python tests/cluster/campaign.py --runs 100 --seed 1 -j 3

Workers are killed (SIGKILL), the scheduler is started again, connections of the sender and of some workers are closed,
one worker has a full disk, and one frame ends each process that renders it. Three kinds of graphs take turns. A run
depends on the seed and its number only: `--first 17 --runs 1` repeats one.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import subprocess
import sys
import tempfile
import time
import traceback
from collections import Counter, deque
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from queue import SimpleQueue

from msgspec import Struct, field

sys.path.insert(0, str(Path(__file__).parents[1]))

from farms import PYTHON, Farm, Proxy, end_group, find_port, list_written, start_scheduler

FRAMES = 24
WORKERS = 3
HARMS = ("kill", "kill", "kill", "cut", "cut", "restart")
EARLY_HARMS = ("kill", "cut")
"""What may happen before a job has begun: without a scheduler it is refused, with a sentence."""

QUIET = {
    "DASK_DISTRIBUTED__WORKER__PROFILE__ENABLED": "False",
    "DASK_DISTRIBUTED__ADMIN__TICK__INTERVAL": "1s",
    "DASK_DISTRIBUTED__ADMIN__SYSTEM_MONITOR__INTERVAL": "10s",
}
"""What docs/cluster.md advises, so that Dask takes less of the processors."""

SECONDS = 600.0
"""How long a job may take on a busy machine: a choice, many times what it takes on a quiet one."""

SHARED = {
    "halation": 1,
    "outputs": {"image": {"type": "Image"}},
    "settings": {"size": [320, 180], "frames": [1, FRAMES]},
}
BLURRED = {"blur.sigma": {"keys": [{"frame": 1, "value": 0.0}, {"frame": FRAMES, "value": 9.0}]}}
MOVING = {"c.evolution": {"keys": [{"frame": 1, "value": 0.0}, {"frame": FRAMES, "value": 6.0}]}}
NOISE, BLUR, TRAIL = {"type": "noise"}, {"type": "gaussian_blur"}, {"type": "feedback"}
GRAPHS = {
    "free": {
        "nodes": {"c": NOISE, "blur": BLUR},
        "links": {"blur.image": "c.out", "outputs.image": "blur.out"},
        "animation": BLURRED,
    },
    "stages": {
        "nodes": {"c": NOISE, "paint": {"type": "kuwahara"}, "trail": TRAIL, "blur": BLUR},
        "links": {
            "paint.image": "c.out",
            "trail.image": "paint.out",
            "blur.image": "trail.out",
            "outputs.image": "blur.out",
        },
        "animation": {**BLURRED, **MOVING},
    },
    "chain": {
        "nodes": {"c": NOISE, "trail": TRAIL},
        "links": {"trail.image": "c.out", "outputs.image": "trail.out"},
        "animation": MOVING,
    },
}
"""Frames by themselves, a memory whose results workers share, and one that is all of a frame, for one worker."""

HARMED = """
import errno, os, sys, time
if "--chunks" in sys.orig_argv:
    from halation.renderer.jobs import item_session
    plan, reserve = item_session.ItemSession.plan_task, os.posix_fallocate
    def plan_task(self, frame):
        time.sleep(0.2)
        with open(os.environ["CRASH_AT"]) as file:
            if file.read() == str(frame):
                os.kill(os.getpid(), 9)
        return plan(self, frame)
    def posix_fallocate(*words):
        if os.path.exists(os.environ["IS_FULL"]):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return reserve(*words)
    item_session.ItemSession.plan_task, os.posix_fallocate = plan_task, posix_fallocate
"""
"""Loaded by each Python of a worker (`sitecustomize`): frames take a moment, one of them ends its process, and the disk
is full while a file is there."""


class Plan(Struct, frozen=True):
    """What happens in a run."""

    graph: str
    has_full_disk: bool
    crash_at: int
    """The frame that ends its processes; 0 for none."""
    seed: str
    early: tuple[tuple[float, str], ...]
    late: tuple[tuple[float, str], ...]
    """Seconds to wait and what to do then: since the command is started, and since the first file is there."""


class Ending(Struct):
    """What came of a run. `fault` says what is wrong, "" for nothing."""

    number: int
    harms: list[str] = field(default_factory=list[str])
    fault: str = ""
    seconds: float = 0.0


def plan_run(seed: int, number: int) -> Plan:
    """What happens in a run of this number."""
    draw = random.Random(f"{seed}.{number}")
    has_full_disk, crashes = draw.random() < 0.5, draw.random() < 0.3
    crash_at = draw.randint(3, FRAMES) if crashes else 0
    early = [(draw.uniform(0.0, 3.0), draw.choice(EARLY_HARMS)) for _ in range(draw.random() < 0.3)]
    late = [(draw.uniform(0.0, 3.0), draw.choice(HARMS)) for _ in range(draw.randint(1, 3))]
    graph = tuple(GRAPHS)[number % len(GRAPHS)]
    return Plan(graph, has_full_disk, crash_at, f"{seed}.{number}.harm", tuple(early), tuple(late))


def is_running(group: int) -> bool:
    """True if there are processes of a group."""
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True


class HarmedFarm:
    """A farm whose sender and some of whose workers reach the scheduler through a proxy, for one run at a time."""

    def __init__(self, folder: Path) -> None:
        self._port = find_port()
        self._proxy = Proxy(self._port)
        self._direct, self.address = (f"tcp://127.0.0.1:{port}" for port in (self._port, self._proxy.port))
        self._farm = Farm(folder, self._direct, start_scheduler(folder, self._port))
        self._crash_at, self._marks = folder / "crash_at", dict[int, Path]()
        self._draw = random.Random()
        (folder / "sitecustomize.py").write_text(HARMED)

    def prepare(self, plan: Plan) -> None:
        """Have as many workers as needed, and a full disk and a crashing frame where a run wants them."""
        self._draw = random.Random(plan.seed)
        self._crash_at.write_text(str(plan.crash_at))
        self.fill()
        for mark in self._marks.values():
            mark.unlink(missing_ok=True)
        if plan.has_full_disk:
            self._marks[self._draw.choice(self._farm.workers)].touch()

    def fill(self) -> None:
        """Start workers that are missing, as whoever supervises a farm does. One that is cut off ends by itself."""
        self._farm.workers[:] = filter(is_running, self._farm.workers)
        for _ in range(WORKERS - len(self._farm.workers)):
            self._farm.address = self._draw.choice((self._direct, self.address))
            mark, folder = self._farm.folder / f"full{len(self._marks)}", self._farm.folder
            variables = {"PYTHONPATH": str(folder), "CRASH_AT": str(self._crash_at), "IS_FULL": str(mark)}
            self._marks[self._farm.start_worker("--no-nanny", **variables)] = mark

    def harm(self, kind: str) -> None:
        """Do one thing that may not lose a frame."""
        if kind == "kill":
            end_group(self._farm.workers.pop(self._draw.randrange(len(self._farm.workers))))
        elif kind == "cut":
            self._proxy.cut()
        else:
            for group in (self._farm.scheduler, *self._farm.workers):
                end_group(group)
            self._farm.workers.clear()
            self._farm.scheduler = start_scheduler(self._farm.folder, self._port)
        self.fill()

    def stop(self) -> None:
        """End everything."""
        self._farm.stop()
        self._proxy.close()


def render(folder: Path, *words: str, log: Path) -> subprocess.Popen[bytes]:
    """Start a render of all frames in a folder."""
    command = [PYTHON, "-m", "halation.cli", "render", *words, "--deterministic"]
    environment = {**os.environ, "HALATION_DEBUG": "1"}
    with log.open("wb") as errors:
        return subprocess.Popen(command, cwd=folder, env=environment, stdout=subprocess.DEVNULL, stderr=errors)


def try_once(folder: Path, number: int, plan: Plan, farm: HarmedFarm) -> Ending:
    """Render on a cluster that is harmed."""
    started, log = time.monotonic(), folder / f"run{number}.log"
    (folder / f"run{number}").mkdir()
    farm.prepare(plan)
    words = (f"{plan.graph}.json", "-o", f"run{number}/f.####.exr", "--cluster", farm.address)
    process = render(folder, *words, log=log)
    ending = Ending(number, ["full disk"] * plan.has_full_disk + ["crashing frame"] * bool(plan.crash_at))
    try:
        ending.harms += harm_in_turn(farm, process, folder / f"run{number}", plan)
        ending.fault = find_fault(folder, number, plan, process.wait(), log.read_text())
    except TimeoutError:
        ending.fault = f"it does not end:\n{log.read_text()}"
    except Exception:  # the run has a fault, and the others are tried
        ending.fault = traceback.format_exc()
    finally:
        process.kill()
    ending.seconds = round(time.monotonic() - started, 1)
    return ending


def harm_in_turn(farm: HarmedFarm, process: subprocess.Popen[bytes], output: Path, plan: Plan) -> list[str]:
    """Do one thing after the other until a job ends, and say what was done. Raises TimeoutError."""
    deadline, done, late = time.monotonic() + SECONDS, list[str](), deque(plan.late)
    early, since, is_late = deque(plan.early), time.monotonic(), False
    while process.poll() is None:
        if time.monotonic() > deadline:
            raise TimeoutError
        if not is_late and not early and any(output.iterdir()):
            is_late, since = True, time.monotonic()
        harms = late if is_late else early
        if harms and time.monotonic() - since > harms[0][0]:
            _, kind = harms.popleft()
            farm.harm(kind)
            done.append(kind)
            since = time.monotonic()
        farm.fill()
        time.sleep(0.1)
    return done


def find_fault(folder: Path, number: int, plan: Plan, code: int, err: str) -> str:
    """What is wrong with the frames of a run and what its command has said, or ""."""
    output = folder / f"run{number}"
    if code != bool(plan.crash_at):
        return f"exit code {code}:\n{err}"
    if plan.crash_at and f"frame {plan.crash_at}: on 3 tries, the last on " not in err:
        return f"frame {plan.crash_at} is not named:\n{err}"
    wanted = [frame for frame in range(1, FRAMES + 1) if frame != plan.crash_at]
    if list_written(output) != wanted:
        return f"other frames than wanted are there: {list_written(output)}\n{err}"
    for name in (f"f.{frame:04d}.exr" for frame in wanted):
        if (output / name).read_bytes() != (folder / plan.graph / name).read_bytes():
            return f"{name} differs\n{err}"
    left = [path.name for path in output.iterdir() if path.name.startswith(".halation-shared-")]
    return f"{left} is left" if left else ""


def run_all(folder: Path, options: argparse.Namespace) -> Iterator[Ending]:
    """Make all runs, some of them side by side, each side with a farm of its own that goes from run to run."""
    farms = SimpleQueue[HarmedFarm]()
    for _ in range(options.j):
        farms.put(HarmedFarm(Path(tempfile.mkdtemp(prefix="farm", dir=folder))))

    def run(number: int) -> Ending:
        farm = farms.get()
        try:
            return try_once(folder, number, plan_run(options.seed, number), farm)
        finally:
            farms.put(farm)

    try:
        with ThreadPoolExecutor(options.j) as threads:
            runs = [threads.submit(run, options.first + number) for number in range(options.runs)]
            yield from (future.result() for future in as_completed(runs))
    finally:
        for _ in range(options.j):
            farms.get().stop()


def main() -> None:
    """Run as many times as the command line says."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--runs", type=int, default=100)
    parser.add_argument("--first", type=int, default=0, help="the number of the first run")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-j", type=int, default=1, help="runs side by side")
    options = parser.parse_args()
    os.environ.update(QUIET)
    faults, total = 0, Counter[str]()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for graph, document in GRAPHS.items():
            (folder / f"{graph}.json").write_text(json.dumps({**SHARED, **document}))
            (folder / graph).mkdir()
            words = (f"{graph}.json", "-o", f"{graph}/f.####.exr")
            assert render(folder, *words, log=folder / f"{graph}.log").wait(SECONDS) == 0
        for ending in run_all(folder, options):
            faults += bool(ending.fault)
            total.update(ending.harms)
            words = f"run {ending.number}, {ending.seconds} s ({', '.join(ending.harms)})"
            print(f"{words}: {ending.fault or 'all frames are those of one process'}", flush=True)
    print(f"{options.runs} runs, {faults} faults: {dict(total)}")
    raise SystemExit(bool(faults))


if __name__ == "__main__":
    main()
