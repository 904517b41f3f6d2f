"""A farm of real processes: a scheduler of Dask and workers, each in a folder of its own."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

PYTHON = sys.executable
FRAMES = range(1, 9)

CRASH = """
import os, sys
if "--chunks" in sys.orig_argv:
    from halation.renderer.jobs import item_session
    plan = item_session.ItemSession.plan_task
    def plan_task(self, frame):
        if str(frame) in os.environ.get("CRASH_AT", "").split(","):
            os.kill(os.getpid(), 9)
        return plan(self, frame)
    item_session.ItemSession.plan_task = plan_task
"""
"""Loaded by each Python of a worker (`sitecustomize`): frames that end the process that renders them."""


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


@dataclass
class Farm:
    """A scheduler and its workers, each by the number of its group of processes."""

    folder: Path
    address: str
    scheduler: int
    workers: list[int] = field(default_factory=list)

    def start_worker(self, *words: str, **variables: str) -> int:
        """Start a worker with one thread in a folder of its own."""
        folder = Path(tempfile.mkdtemp(prefix="worker", dir=self.folder))
        command = ["worker", self.address, "--nthreads", "1", "--no-dashboard", "--local-directory", str(folder)]
        self.workers.append(start_dask([*command, *words], folder, {"LP_NUM_THREADS": "1", **variables}))
        return self.workers[-1]

    def wait_for_workers(self) -> None:
        """Wait until the scheduler knows all workers: a job ends if none of those that it finds can render."""
        limit = time.monotonic() + 120.0
        for log in (folder / "worker.log" for folder in self.folder.glob("worker*")):
            while not log.is_file() or "Registered to" not in log.read_text("utf-8"):
                assert time.monotonic() < limit, f"{log}: the worker does not find its scheduler"
                time.sleep(0.1)

    def stop(self) -> None:
        """End all processes."""
        for group in (*self.workers, self.scheduler):
            end_group(group)


def start_dask(words: list[str], folder: Path, variables: dict[str, str]) -> int:
    """Start a program of Dask in a group of its own, and return the number of the group.

    A shell starts it in the background and ends, so that it outlives the test that has started it.
    """
    script = f'"$@" >>{words[0]}.log 2>&1 & echo $$'
    environment = {**os.environ, **variables}
    shell = subprocess.run(
        ["sh", "-c", script, "sh", PYTHON, "-m", "dask", *words],
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        text=True,
        check=True,
        start_new_session=True,
    )
    return int(shell.stdout)


def end_group(group: int) -> None:
    """Kill all processes of a group, and wait a moment until they are gone."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(group, signal.SIGKILL)
        for _ in range(50):
            time.sleep(0.02)
            os.killpg(group, 0)


def find_port() -> int:
    """A free port."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def start_scheduler(folder: Path, port: int) -> int:
    """Start a scheduler and wait until it listens."""
    words = ["scheduler", "--host", "127.0.0.1", "--port", str(port), "--no-dashboard"]
    group = start_dask(words, folder, {})
    for _ in range(2400):  # two minutes: with twenty busy processes for each core half a minute is too short
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", port)) == 0:
                return group
        time.sleep(0.05)
    raise AssertionError((folder / "scheduler.log").read_text())


@dataclass(frozen=True)
class Ending:
    """How a command ended and what it said."""

    code: int
    out: str
    err: str


Halation = Callable[..., Ending]


def start_halation(*words: object, cwd: Path) -> subprocess.Popen[str]:
    """Start a command of Halation."""
    command = [PYTHON, "-m", "halation.cli", *map(str, words)]
    environment = {**os.environ, "LP_NUM_THREADS": "1"}
    return subprocess.Popen(
        command, cwd=cwd, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def make_graph() -> dict[str, object]:
    """The graph of the shot."""
    return {
        "halation": 1,
        "inputs": {"plate": {"type": "Image", "file": "plates/p.####.exr"}},
        "outputs": {"image": {"type": "Image"}},
        "nodes": {
            "inner": {"type": "group", "path": "group.json"},
            "lut": {"type": "lut_file", "values": {"file": "look.cube"}},
            "blur": {"type": "gaussian_blur"},
        },
        "animation": {"blur.sigma": {"keys": [{"frame": 1, "value": 0.0}, {"frame": 8, "value": 3.0}]}},
        "links": {
            "inner.image": "inputs.plate",
            "lut.image": "inner.image",
            "blur.image": "lut.out",
            "outputs.image": "blur.out",
        },
    }


def read_frames(folder: Path, frames: range = FRAMES) -> list[bytes]:
    """The bytes of all frames."""
    return [(folder / f"f.{frame:04d}.exr").read_bytes() for frame in frames]


def customize(folder: Path, text: str) -> dict[str, str]:
    """The environment of a worker all of whose Pythons run a text first."""
    folder.mkdir()
    (folder / "sitecustomize.py").write_text(text)
    return {"PYTHONPATH": str(folder)}


def render_words(farm: Farm, frames: str = "1-8") -> tuple[str, ...]:
    """The words of a command that renders on a farm."""
    words = ("-o", "f.####.exr", "--deterministic", "--frames", frames, "--cluster", farm.address)
    return ("render", "shot.json", *words)


def list_written(shot: Path) -> list[int]:
    """The frames that are written."""
    return sorted(int(path.name[2:6]) for path in shot.glob("f.*.exr"))


def wait_for_frames(shot: Path, count: int, seconds: float = 60.0) -> None:
    """Wait until so many frames are written."""
    for _ in range(int(seconds / 0.02)):
        if len(list_written(shot)) >= count:
            return
        time.sleep(0.02)
    raise AssertionError(f"{list_written(shot)} of {count} frames")


def check_whole(halation: Halation, shot: Path) -> None:
    """All frames are those of one process, and nothing else is left."""
    (shot / "one").mkdir()
    assert halation("render", "shot.json", "-o", "one/f.####.exr", "--deterministic").code == 0
    assert read_frames(shot) == read_frames(shot / "one")
    assert not list(shot.glob(".halation-*"))


class Proxy:
    """Passes bytes between a port here and another one, until its connections are cut."""

    def __init__(self, port: int) -> None:
        self._target = port
        self._server = socket.create_server(("127.0.0.1", 0))
        self.port = self._server.getsockname()[1]
        self._sockets: list[socket.socket] = []
        threading.Thread(target=self._accept, daemon=True).start()

    def cut(self) -> None:
        """Close all connections at once; new ones are accepted."""
        sockets, self._sockets = self._sockets, []
        for each in sockets:
            _shut_down(each)
            each.close()

    def close(self) -> None:
        """Accept no more connections, and cut those that there are."""
        self._server.close()
        self.cut()

    def _accept(self) -> None:
        while True:
            try:
                near, _ = self._server.accept()
            except OSError:
                return
            try:
                far = socket.create_connection(("127.0.0.1", self._target))
            except OSError:
                near.close()
                continue
            self._sockets += [near, far]
            for source, sink in ((near, far), (far, near)):
                threading.Thread(target=self._pass_on, args=(source, sink), daemon=True).start()

    @staticmethod
    def _pass_on(source: socket.socket, sink: socket.socket) -> None:
        with contextlib.suppress(OSError):
            while chunk := source.recv(1 << 16):
                sink.sendall(chunk)
        _shut_down(source)
        _shut_down(sink)


def _shut_down(each: socket.socket) -> None:
    with contextlib.suppress(OSError):
        each.shutdown(socket.SHUT_RDWR)
