"""Runs all cases, in this process or in several."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing, contextmanager
from functools import cache
from multiprocessing import get_context, parent_process
from pathlib import Path
from threading import Thread, current_thread, main_thread
from typing import Protocol

from .. import renderer as engine
from ..errors import RenderError
from ..resources.heartbeat import BEACON_FILE, BEACON_TRIALS
from ..resources.machine import available_cores, available_memory
from ..resources.sandbox import Sandbox
from ..version import VERSION
from .case_runner import RunOptions, run_case
from .cases import Case
from .results import CaseResult, Outcome, RegressionRun

OutcomeListener = Callable[[Outcome], None]

CaseSharing = Callable[[Sequence[Case], RunOptions], Generator[CaseResult, None, None]]
"""Runs cases elsewhere, in any order."""

_CHECK_INTERVAL = 0.05
"""Seconds between two looks at processes that work."""


class Supervisor(Protocol):
    """What watches processes that share cases, because code in a graph may block one."""

    folder: Path
    """Where each process writes its heartbeat, to a file with its number as name."""

    def check(self) -> None:
        """Raise DeviceError for code that must not go on; its process has been killed."""
        ...


_LEAST_CASES = 8
"""Cases of a process at least: it starts in the time that several small ones take. A choice."""

_PROCESS_BYTES = 512 << 20
"""Bytes that a process takes: about 400 MB with Mesa 22.3 beside its pictures, which are small in most suites."""


def choose_processes(case_count: int) -> int:
    """How many processes share so many cases where nobody says: as many as there are cores, memory and work for."""
    by_memory = int(min(available_memory() / _PROCESS_BYTES, case_count))
    return max(1, min(available_cores(), case_count // _LEAST_CASES, by_memory))


def run_cases(
    cases: Sequence[Case],
    options: RunOptions,
    *,
    jobs: int = 1,
    stop_early: bool = False,
    report_outcome: OutcomeListener | None = None,
    supervisor: Supervisor | None = None,
    share: CaseSharing | None = None,
) -> RegressionRun:
    """Run cases; `report_outcome` is called with each as it ends. `stop_early` stops after the first failure.

    If there are several processes, `supervisor` watches them. `share` runs the cases elsewhere. Raises DeviceError
    without OpenGL and for code that the supervisor stopped, OutputError for a folder that cannot be written.
    """
    started = time.perf_counter()
    outcomes: dict[str, Outcome] = {}
    device, software = "", True
    processes = min(jobs, len(cases))
    shared = processes > 1
    run_shared = share or (lambda cases, options: _run_shared(cases, options, processes, supervisor))
    with closing(run_shared(cases, options) if shared or share else _run_alone(cases, options)) as results:
        for result in results:
            outcomes[result.outcome.case.id], device, software = result.outcome, result.device, result.software
            if report_outcome is not None:
                report_outcome(result.outcome)
            if stop_early and result.outcome.status == "failed":
                break
    ordered = [outcomes[case.id] for case in cases if case.id in outcomes]
    remark = (
        ""
        if software or not options.deterministic
        else (f"no software rasterizer was found: {device} rendered, so only tolerances can be relied on")
    )
    return RegressionRun(
        ordered, device, time.perf_counter() - started, options.deterministic and software, remark, VERSION
    )


def _run_alone(cases: Iterable[Case], options: RunOptions) -> Generator[CaseResult, None, None]:
    renderer = _open_renderer(options.deterministic, options.sandbox)
    for case in cases:
        yield _run_and_describe(case, renderer, options)


def _run_shared(
    cases: Sequence[Case], options: RunOptions, jobs: int, supervisor: Supervisor | None
) -> Generator[CaseResult, None, None]:
    # If each process used all cores, they would only slow each other down.
    threads = str(max(1, available_cores() // jobs))
    folder = supervisor.folder if supervisor else None
    pool = ProcessPoolExecutor(jobs, get_context("spawn"), _prepare_worker, (threads, folder))
    try:
        with _ignore_interrupts():
            waiting = {pool.submit(run_in_worker, case, options) for case in cases}
        while waiting:
            ended, waiting = wait(waiting, _CHECK_INTERVAL if supervisor else None, FIRST_COMPLETED)
            for future in ended:
                yield future.result()
            if supervisor is not None:
                supervisor.check()
    except BrokenProcessPool:
        raise RenderError(
            "a process was ended from outside, probably because memory ran out: use fewer processes, such as -j 1"
        ) from None
    finally:
        pool.shutdown(cancel_futures=True)


def run_in_process(case: Case, options: RunOptions) -> Outcome:
    """The outcome of a case; the device stays open for the next case of this process."""
    return run_case(case, _open_renderer(options.deterministic, options.sandbox), options)


@contextmanager
def _ignore_interrupts() -> Iterator[None]:
    """Processes that are started in this block ignore Ctrl-C: their parent handles it."""
    if current_thread() is not main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _prepare_worker(threads: str, heartbeats: Path | None) -> None:
    """Limit the threads of the driver, say where the heartbeat goes if it is watched, and end this process with its
    parent: it would wait for work for ever.
    """
    os.environ.setdefault("LP_NUM_THREADS", threads)
    if heartbeats is not None:
        os.environ[BEACON_FILE], os.environ[BEACON_TRIALS] = str(heartbeats / str(os.getpid())), "1"
    parent = parent_process()

    def end() -> None:
        if parent is not None:
            parent.join()
            os._exit(1)

    Thread(target=end, name="parent", daemon=True).start()


def run_in_worker(case: Case, options: RunOptions) -> CaseResult:
    """The outcome of a case in a process of its own, whose device stays open for the next one."""
    return _run_and_describe(case, _open_renderer(options.deterministic, options.sandbox), options)


def _run_and_describe(case: Case, renderer: engine.Renderer, options: RunOptions) -> CaseResult:
    return CaseResult(run_case(case, renderer, options), renderer.device.description, renderer.device.target.software)


@cache
def _open_renderer(deterministic: bool, sandbox: Sandbox) -> engine.Renderer:
    """One device for all cases of a process; it ends with the process."""
    return engine.Renderer(
        engine.open_pinned(sandbox=sandbox) if deterministic else engine.open_device(sandbox=sandbox),
        budget=0,
        sandbox=sandbox,
    )
