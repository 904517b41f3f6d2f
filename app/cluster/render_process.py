"""Warm processes beside a worker, each of which renders one chunk after the other.

A worker of Dask cannot render itself: OpenGL wants one thread, a driver may crash, and a task that runs cannot be
ended. So each chunk goes as a line to a process of its own, which answers with a line for each frame. It is kept for
the next chunk of the same kind, with its device, programs and graph, and ends when no chunk comes for some time.
"""

from __future__ import annotations

import contextlib
import json
import os
import queue
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from msgspec import Struct, field

from ..renderer.jobs.render_job import RenderJob, worker_command
from ..resources.heartbeat import Watchdog
from ..resources.machine import available_cores, resident_memory
from ..resources.struct_json import write_struct
from ..resources.typed_data import convert_data
from .chunk import ChunkReport, EntryOutcome, FrameChunk, StageReport

CHECK_INTERVAL = 0.1
"""Seconds between two looks whether a chunk is still needed, and how much memory its process takes: a choice."""

IDLE_SECONDS = 120.0
"""Seconds after which a process ends for which there is no chunk: a choice, longer than a user takes to correct a value
and render again."""

_PATIENCE = 1.0
"""Seconds that a process may take to remove what it has begun to write: a frame is encoded in less, mostly."""

_INTERRUPTED = "halation: interrupted"
"""How the sentence of a command begins that was told to end."""

ProcessKind = tuple[bool, str, int, str]


def find_kind(job: RenderJob) -> ProcessKind:
    """What a process is opened for; jobs of one kind share its device."""
    return job.deterministic, job.form or "", job.memory, job.sandbox.root


class ProcessLimits(Struct, frozen=True):
    """What a process may take for a line: `seconds` for code of a graph, 0 for any time; `memory` bytes for such code,
    0 for half of the machine's; and `resident` bytes in all, 0 for any number.
    """

    seconds: float
    memory: int = 0
    resident: int = 0


class DeviceRequest(Struct, frozen=True):
    """Asks a process to open the device of a job, of which nothing else is said."""

    device: RenderJob


class ProcessAnswer(Struct, frozen=True):
    """What a process has answered, or why it has not."""

    facts: Mapping[str, Any] = field(default_factory=dict[str, Any])
    death: str = ""
    is_cancelled: bool = False


class RenderProcess:
    """A process that renders chunks. `threads` are those of its software rasterizer."""

    def __init__(self, threads: int) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="halation-")
        self._heartbeat = Path(self._folder.name, "heartbeat")
        beacon = Watchdog(self._heartbeat, 0.0, tries_first=True).environment
        environment = {**os.environ, **beacon, "PYTHONIOENCODING": "utf-8"}
        for name in ("LP_NUM_THREADS", "OPENIMAGEIO_THREADS"):
            environment.setdefault(name, str(threads))
        self._process = subprocess.Popen(
            [*worker_command(), "--chunks"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            encoding="utf-8",
            errors="surrogateescape",
            env=environment,
        )
        self._lines = queue.SimpleQueue[str | None]()
        for work in (self._listen, self._pass_on):
            threading.Thread(target=work, name="render process", daemon=True).start()

    @property
    def number(self) -> int:
        """Its number in the system."""
        return self._process.pid

    @property
    def is_alive(self) -> bool:
        """True if it can take another chunk."""
        return self._process.poll() is None

    def render(
        self,
        chunk: FrameChunk,
        report_frame: Callable[[dict[str, Any]], None],
        is_cancelled: Callable[[], bool],
        memory_limit: int,
    ) -> ChunkReport:
        """Render a chunk and report each frame; `memory_limit` is how many bytes the process may take, 0 for any."""
        limits = ProcessLimits(chunk.job.timeout, chunk.job.memory, memory_limit)
        seconds: dict[int, float] = {}
        kept: list[int] = []
        entries: dict[int, EntryOutcome] = {}

        def note_frame(event: dict[str, Any]) -> None:
            seconds[event["frame"]] = event["seconds"]
            kept.extend([event["frame"]] * bool(event["kept"]))
            if "entry" in event:
                entries[event["frame"]] = convert_data(event["entry"], EntryOutcome)
            report_frame(event)

        answer = self.ask(chunk.to_json(), note_frame, is_cancelled, limits)
        faults = {int(frame): fault for frame, fault in answer.facts.get("faults", {}).items()}
        entries |= {
            int(number): convert_data(entry, EntryOutcome) for number, entry in answer.facts.get("entries", {}).items()
        }
        costs, refusal = answer.facts.get("costs", {}), answer.facts.get("refusal", "")
        stage = convert_data(answer.facts["stage"], StageReport, strict=False) if "stage" in answer.facts else None
        return ChunkReport(
            "", seconds, tuple(kept), faults, costs, answer.death, refusal, answer.is_cancelled, stage, entries
        )

    def open_device(self, job: RenderJob) -> None:
        """Have the device opened that a job needs, before there is a chunk of it. Whether it can be is said then."""
        facts = RenderJob(sandbox=job.sandbox, deterministic=job.deterministic, form=job.form, memory=job.memory)
        self._send(write_struct(DeviceRequest(facts)))

    def ask(
        self,
        line: str,
        note_frame: Callable[[dict[str, Any]], None],
        is_cancelled: Callable[[], bool],
        limits: ProcessLimits,
    ) -> ProcessAnswer:
        """Send a line of JSON and wait for the answer, which lines about frames may precede."""
        watchdog = Watchdog(self._heartbeat, limits.seconds, limits.memory, tries_first=True)
        self._send(line)
        checked_at = time.monotonic()
        while True:
            answer_line = self._read_line()
            if time.monotonic() - checked_at > CHECK_INTERVAL:
                checked_at = time.monotonic()
                if is_cancelled():
                    self.stop()
                    return ProcessAnswer(is_cancelled=True)
                if fault := watchdog.check(self._process.pid):
                    self.stop()
                    return ProcessAnswer(death=str(fault))
                if 0 < limits.resident < resident_memory(self._process.pid):
                    self.stop()
                    return ProcessAnswer(
                        death=f"it takes more than the {limits.resident / 2**30:.1f} GiB of its worker"
                    )
            if answer_line == "":
                continue
            if answer_line is None:
                return ProcessAnswer(death=self._describe_end())
            try:
                event: dict[str, Any] = json.loads(answer_line)
            except ValueError:  # the report of an error that ends the process
                continue
            if "frame" not in event:
                return ProcessAnswer(event)
            note_frame(event)

    def finish(self) -> None:
        """Send no more chunks, so that the process ends."""
        assert self._process.stdin is not None
        with contextlib.suppress(OSError):
            self._process.stdin.close()

    def stop(self) -> None:
        """Ask the process to end, which leaves no unfinished file, and kill it if it does not."""
        deadline = time.monotonic() + _PATIENCE
        assert self._process.stdin is not None
        if not self._process.stdin.closed:
            self._process.terminate()
            self.finish()
        while self.is_alive and time.monotonic() < deadline:
            time.sleep(CHECK_INTERVAL / 10)
        if self.is_alive:
            self._process.kill()
        self._process.wait()
        self._folder.cleanup()

    def _send(self, line: str) -> None:
        assert self._process.stdin is not None
        with contextlib.suppress(OSError):
            self._process.stdin.write(f"{line}\n")
            self._process.stdin.flush()

    def _read_line(self) -> str | None:
        """The next line; "" if none comes for a moment, None after the last one."""
        try:
            return self._lines.get(timeout=CHECK_INTERVAL)
        except queue.Empty:
            return ""

    def _listen(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as lines:
            for line in lines:
                self._lines.put(line)
        self._lines.put(None)

    def _pass_on(self) -> None:
        """Show what drivers and libraries say, and not that the process was told to end: who tells it knows."""
        assert self._process.stderr is not None
        with self._process.stderr as lines:
            for line in lines:
                if not line.startswith(_INTERRUPTED):
                    print(line, end="", file=sys.stderr, flush=True)

    def _describe_end(self) -> str:
        code = self._process.wait()
        if code >= 0:
            return f"its process ended by itself (exit code {code})"
        try:
            return f"its process was ended by {signal.Signals(-code).name}"
        except ValueError:
            return f"its process was ended by signal {-code}"


class RenderProcessPool:
    """The processes of one or several workers, lent to one chunk at a time."""

    def __init__(self) -> None:
        self._idle: list[tuple[ProcessKind, RenderProcess]] = []
        self._lock = threading.Lock()

    @contextmanager
    def lend_process(self, kind: ProcessKind, threads: int) -> Iterator[RenderProcess]:
        """A warm process of a kind, started with so many `threads` if none is free."""
        process = self._take(kind) or RenderProcess(threads)
        try:
            yield process
        except BaseException:
            process.stop()
            raise
        if not process.is_alive:
            process.stop()
            return
        with self._lock:
            self._idle.append((kind, process))

    def warm(self, job: RenderJob, count: int) -> None:
        """Start processes before there are chunks for them: they load what they need meanwhile, and open a device."""
        threads = max(1, available_cores() // count)
        processes = [(find_kind(job), RenderProcess(threads)) for _ in range(min(count, available_cores()))]
        for _, process in processes:
            if not job.sandbox.root:  # another folder with `--map`, which chunks tell
                process.open_device(job)
        with self._lock:
            self._idle += processes

    def close(self) -> None:
        """End all processes that are free."""
        with self._lock:
            idle, self._idle = self._idle, []
        for _, process in idle:
            process.finish()
        for _, process in idle:
            process.stop()

    def _take(self, kind: ProcessKind) -> RenderProcess | None:
        with self._lock:
            for _, process in self._idle:
                if not process.is_alive:
                    process.stop()
            self._idle = [(other, process) for other, process in self._idle if process.is_alive]
            place = next((place for place, (other, _) in enumerate(self._idle) if other == kind), None)
            return None if place is None else self._idle.pop(place)[1]


def find_machine(address: str) -> str:
    """The name of the machine in the address of a worker; "" for a worker inside of the sending process."""
    return "" if address.startswith("inproc") else urlsplit(address).hostname or ""


def share_cores(slots: Mapping[str, int], address: str) -> int:
    """Threads for a process where several on one machine render side by side; each using all cores is slower."""
    return max(1, available_cores() // max(1, slots.get(find_machine(address), 1)))
