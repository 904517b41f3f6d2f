"""Programs with code of users are tried in another process before this one compiles them.

A driver may die of a program, never end, or take all memory while it compiles; then only the other process is lost, and
the node is at fault. What it has compiled this process finds in the driver's cache, so it does not compile twice. From
what a few pixels take follows what a picture takes: code that would run for minutes is refused, because nothing can
stop a device that has begun. The process is started when a graph with such code appears, and stays for the next one.
Where another process watches this one already (`progress_beacon`), nothing is tried.
"""

from __future__ import annotations

import contextlib
import json
import math
import signal
import subprocess
import time
from collections.abc import Callable, Mapping
from concurrent.futures import CancelledError, Future
from queue import Empty, SimpleQueue
from threading import Thread
from typing import Any

from msgspec import Struct, field

from ...compiler import FIRST_TABLE, LOCAL_SIZE, MAX_WEIGHTS, Pass, Plan, Shader
from ...errors import DeviceError, describe_owner
from ...resources.machine import available_cores, machine_memory, resident_memory
from ...resources.program import module_command
from ...resources.render_choices import DEFAULT_TIMEOUT

MAX_TRIALS = 1024
"""Programs whose trials are remembered: twice those that a renderer keeps."""

SIDE = 16
"""Pixels on each side of a picture: two of the blocks of 8 that rasterizers shade at a time, across and down."""

PATIENCE = 2.0
"""Seconds that others wait for a slow program: a choice, about the time in which a user writes the next line."""

CHECK_INTERVAL = 0.05
"""Seconds between two looks at the process: a compiler takes 0.2 GB of memory in that time, measured with Mesa 22.3."""


MARGIN = 4.0
"""How far beyond the time limit an estimate must be: other pixels may be quicker than those of the trial. A choice."""

GPU_PIXELS = 2**14
"""Pixels that a GPU is believed to compute in the time of a few: what a small one keeps in flight."""


class Trial(Struct, frozen=True):
    """What came of a program: the error to raise if any, and the seconds that its few pixels took."""

    fault: DeviceError | None = None
    seconds: float = 0.0


class TrialProcess:
    """The process that tries programs, started when it is first needed and again when it has died.

    `timeout` is how many seconds a program may take to compile and to run on a few pixels. All is done on a thread that
    lives as long as this process: the system ends the other one together with the thread that has started it.
    """

    def __init__(self, timeout: float = DEFAULT_TIMEOUT) -> None:
        self.timeout = timeout
        self._process: subprocess.Popen[str] | None = None
        self._idle_memory = 0
        self._tasks = SimpleQueue[Callable[[], object] | None]()
        self._thread: Thread | None = None

    def start(self) -> None:
        """Have the process ready."""
        self._do(self._find_process)

    def submit(self, program: Mapping[str, Any], nodes: str, *, may_yield: bool) -> Future[Trial]:
        """Begin to try a program.

        With `may_yield` a slow one is cancelled when others wait: the user may have written another text meanwhile.
        """
        outcome = Future[Trial]()
        self._do(lambda: self._settle(outcome, program, nodes, may_yield))
        return outcome

    def close(self) -> None:
        """End the process."""
        if (thread := self.abandon()) is not None:
            thread.join()

    def abandon(self) -> Thread | None:
        """Have the process ended, and return the thread that does it, if there is one."""
        thread, self._thread = self._thread, None
        if thread is not None:
            if (process := self._process) is not None:
                process.kill()
            self._tasks.put(None)
        return thread

    # --- on the thread -----------------------------------------------------------------------------------------------

    def _do(self, task: Callable[[], object]) -> None:
        if self._thread is None:
            self._thread = Thread(target=self._work, name="trial", daemon=True)
            self._thread.start()
        self._tasks.put(task)

    def _work(self) -> None:
        while task := self._tasks.get():
            task()
        self._end_process()

    def _end_process(self) -> int:
        """End the process, if there is one; its exit code."""
        process, self._process = self._process, None
        if process is None:
            return 0
        process.kill()
        for pipe in (process.stdin, process.stdout):
            with contextlib.suppress(OSError):  # what it was sent last may not have gone out
                if pipe:
                    pipe.close()
        return process.wait()

    def _find_process(self) -> subprocess.Popen[str]:
        if self._process is None or self._process.poll() is not None:
            self._end_process()
            self._idle_memory = 0
            self._process = subprocess.Popen(
                module_command("halation.renderer.opengl.trial_worker"),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                text=True,
            )
        return self._process

    def _settle(self, outcome: Future[Trial], program: Mapping[str, Any], nodes: str, may_yield: bool) -> None:
        try:
            outcome.set_result(self._try(program, nodes, may_yield))
        except CancelledError:
            outcome.cancel()

    def _try(self, program: Mapping[str, Any], nodes: str, may_yield: bool) -> Trial:
        """Try a program and wait for the answer. Raises CancelledError where it makes way for others.

        A thread reads the answer, since reading blocks: time and memory are watched meanwhile. The memory that counts
        is what the process takes beyond that of a process without work.
        """
        try:
            process = self._find_process()
        except OSError:
            return Trial()  # no process can be started: the driver is on its own
        assert process.stdin and process.stdout
        with contextlib.suppress(OSError):  # it may have ended: what it answers says so
            process.stdin.write(json.dumps(program) + "\n")
            process.stdin.flush()
        answers = SimpleQueue[str]()
        reader = Thread(target=lambda: answers.put(process.stdout.readline() if process.stdout else ""), daemon=True)
        reader.start()
        began, limit = time.monotonic(), machine_memory() / 2
        while True:
            with contextlib.suppress(Empty):
                if answer := answers.get(timeout=CHECK_INTERVAL):
                    self._idle_memory = resident_memory(process.pid)
                    return Trial(seconds=json.loads(answer)["seconds"])
                process.wait()
                return Trial(_explain(self._end_process(), nodes))
            memory = resident_memory(process.pid)
            self._idle_memory = self._idle_memory or memory
            sentence, spent = "", time.monotonic() - began
            yields = may_yield and spent > PATIENCE and not self._tasks.empty()
            if memory - self._idle_memory > limit:
                sentence = f"takes more than {limit / 2**30:.1f} GiB of memory"
            elif 0.0 < self.timeout < spent:
                sentence = f"has not been compiled and run after {self.timeout:g} seconds"
            if sentence or yields:
                process.kill()
                reader.join()
                self._end_process()
                if not sentence:
                    raise CancelledError
                return Trial(DeviceError(f"{describe_owner(nodes)}: its code {sentence}: make it smaller", node=nodes))


def _explain(code: int, nodes: str) -> DeviceError | None:
    """The error of a program that ended the process; None where there is no OpenGL that it could be tried on."""
    if code >= 0:
        return None
    name = signal.Signals(-code).name
    return DeviceError(
        f"{describe_owner(nodes)}: its code has ended the process ({name}) that compiled it: make it simpler",
        node=nodes,
    )


class Trials(Struct, eq=False):
    """The trials of the programs of one renderer, by their text."""

    process: TrialProcess
    _known: dict[Shader, Future[Trial]] = field(default_factory=dict[Shader, Future[Trial]])

    def begin(self, plan: Plan, render_pass: Pass) -> Future[Trial]:
        """The trial of the program of a pass, which begins if there was none."""
        shader = render_pass.shader
        trial = self._known.get(shader)
        if trial is None or trial.cancelled():
            if len(self._known) >= MAX_TRIALS:
                self._known.pop(next(iter(self._known)))
            nodes = _name_writers(render_pass)
            # What has made way once is waited for: two slow programs would make way for each other for ever.
            trial = self.process.submit(_describe(plan, render_pass), nodes, may_yield=trial is None)
            self._known[shader] = trial
        return trial

    def find_slowness(self, plan: Plan, render_pass: Pass, software: bool) -> DeviceError | None:
        """The error to raise if a pass would take far longer than the time limit, by what its trial took."""
        if not render_pass.writers:
            return None  # nothing of it was tried: the usual case, and looking for a program takes time
        trial, limit = self._known.get(render_pass.shader), MARGIN * self.process.timeout
        if not limit or trial is None or not trial.done() or trial.cancelled():
            return None
        seconds = trial.result().seconds * _count_trials(plan, render_pass, software)
        if seconds <= limit:
            return None
        nodes, (width, height) = _name_writers(render_pass), plan.surfaces[render_pass.targets[0]].size
        return DeviceError(
            f"{describe_owner(nodes)}: its code would run for about {seconds / 60.0:.0f} minutes on {width}x{height} "
            "pixels: make it smaller, or render fewer pixels",
            node=nodes,
        )


def _count_trials(plan: Plan, render_pass: Pass, software: bool) -> float:
    """How many times as long as its trial a pass takes. In a trial one core of a processor works; a GPU does many
    pixels at a time.
    """
    if render_pass.shader.form == "compute":
        groups = float(math.prod(render_pass.groups))
        return groups / available_cores() if software else groups * LOCAL_SIZE / GPU_PIXELS
    width, height = plan.surfaces[render_pass.targets[0]].size
    if software:
        return width * height / (_shrink(width) * _shrink(height)) / available_cores()
    return width * height / GPU_PIXELS


def _name_writers(render_pass: Pass) -> str:
    return ", ".join(dict.fromkeys(render_pass.writers.values()))


def _describe(plan: Plan, render_pass: Pass) -> dict[str, Any]:
    """All that the process needs to compile a program as the renderer will."""
    shader = render_pass.shader
    kinds = [
        [
            (*map(_shrink, surface.size), surface.components, surface.depth, shader.foreign)
            for surface in map(plan.surfaces.__getitem__, numbers)
        ]
        for numbers in (render_pass.textures, render_pass.targets)
    ]
    return {
        "source": shader.source,
        "vertex": shader.vertex,
        "form": shader.form,
        "foreign": shader.foreign,
        "reads_images": shader.reads_images,
        "textures": kinds[0],
        "targets": kinds[1],
        "uniforms": list(render_pass.uniforms),
        "tables": [(table.sampler, unit) for unit, table in enumerate(render_pass.tables, FIRST_TABLE)],
        "weights": MAX_WEIGHTS if render_pass.weights else 0,
    }


def _shrink(length: int) -> int:
    """A short side for a long one: Mesa compiles a program once for powers of two and once for other lengths."""
    return SIDE if length & (length - 1) == 0 else SIDE + SIDE // 2
