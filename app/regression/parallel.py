"""All cases: here, or shared among processes."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing, contextmanager
from dataclasses import dataclass
from functools import cache
from multiprocessing import get_context
from threading import current_thread, main_thread

from .. import renderer as engine
from ..errors import RenderError
from ..resources.sandbox import Sandbox
from ..version import VERSION
from .case_runner import RunOptions, run_case
from .cases import Case
from .results import Outcome, RegressionRun

OutcomeListener = Callable[[Outcome], None]


@dataclass(frozen=True)
class _CaseResult:
    """A case, and what it ran on."""

    outcome: Outcome
    device: str
    software: bool


def run_cases(
    cases: Sequence[Case],
    how: RunOptions,
    *,
    jobs: int = 1,
    stop_early: bool = False,
    hears: OutcomeListener | None = None,
) -> RegressionRun:
    """Run cases and tell of each as it ends. With `stop_early` the first failure is the last case to be told of.

    Raises DeviceError without OpenGL, OutputError for a folder that cannot be written.
    """
    started = time.perf_counter()
    found: dict[str, Outcome] = {}
    device, software = "", True
    crew = min(jobs, len(cases))
    with closing(_run_shared(cases, how, crew) if crew > 1 else _run_alone(cases, how)) as made:
        for done in made:
            found[done.outcome.case.id], device, software = done.outcome, done.device, done.software
            if hears is not None:
                hears(done.outcome)
            if stop_early and done.outcome.status == "failed":
                break
    ordered = [found[case.id] for case in cases if case.id in found]
    remark = (
        ""
        if software or not how.deterministic
        else (f"no software rasterizer was found: {device} rendered, so only tolerances can be relied on")
    )
    return RegressionRun(
        ordered, device, time.perf_counter() - started, how.deterministic and software, remark, VERSION
    )


def _run_alone(cases: Iterable[Case], how: RunOptions) -> Generator[_CaseResult, None, None]:
    renderer = _open_renderer(how.deterministic, how.sandbox)
    for case in cases:
        yield _run_and_describe(case, renderer, how)


def _run_shared(cases: Sequence[Case], how: RunOptions, jobs: int) -> Generator[_CaseResult, None, None]:
    # Processes that each used all cores would only get into each other's way.
    threads = str(max(1, (os.cpu_count() or 1) // jobs))
    pool = ProcessPoolExecutor(jobs, get_context("spawn"), _limit_threads, (threads,))
    try:
        with _ignore_interrupts():
            waiting: list[Future[_CaseResult]] = [pool.submit(_run_in_worker, case, how) for case in cases]
        for done in as_completed(waiting):
            yield done.result()
    except BrokenProcessPool:
        raise RenderError("a process was ended from outside, perhaps for want of memory: use fewer, -j 1") from None
    finally:
        pool.shutdown(cancel_futures=True)


def run_here(case: Case, how: RunOptions) -> Outcome:
    """What becomes of a case; the device stays open for the next one."""
    return run_case(case, _open_renderer(how.deterministic, how.sandbox), how)


@contextmanager
def _ignore_interrupts() -> Iterator[None]:
    """Processes that are started inside do not hear Ctrl-C, of which the one that started them takes care."""
    if current_thread() is not main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _limit_threads(threads: str) -> None:
    os.environ.setdefault("LP_NUM_THREADS", threads)


def _run_in_worker(case: Case, how: RunOptions) -> _CaseResult:
    return _run_and_describe(case, _open_renderer(how.deterministic, how.sandbox), how)


def _run_and_describe(case: Case, renderer: engine.Renderer, how: RunOptions) -> _CaseResult:
    return _CaseResult(run_case(case, renderer, how), renderer.device.description, renderer.device.target.software)


@cache
def _open_renderer(deterministic: bool, sandbox: Sandbox) -> engine.Renderer:
    """One device for all cases of a process; it ends with the process."""
    return engine.Renderer(
        engine.open_pinned(sandbox=sandbox) if deterministic else engine.open_device(sandbox=sandbox),
        budget=0,
        sandbox=sandbox,
    )
