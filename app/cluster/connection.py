"""Reaches the scheduler of a cluster, or starts one with workers inside of this process."""

from __future__ import annotations

import contextlib
import logging
import os
import re
import socket
import time
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.util import find_spec
from typing import TYPE_CHECKING, cast
from urllib.parse import urlsplit

from ..errors import RenderError, UsageError
from .worker_task import open_pool

if TYPE_CHECKING:
    from distributed import Client, Future, LocalCluster

    from ..renderer.jobs.render_job import RenderJob

CONNECT_SECONDS = 5.0
"""Seconds until somebody must listen at an address: a choice, many times what a connection across a continent takes.
"""

ANSWER_SECONDS = 30.0
"""Seconds until a scheduler that listens must answer: with eight busy processes for each core, it may take more than
five (seen in `tests/cluster/campaign.py`)."""

RETURN_SECONDS = 30.0
"""Seconds that a job waits for a scheduler that has gone: a choice. Supervisors such as systemd start it again within a
second, a container within ten or twenty."""

_RETRY_INTERVAL = 0.5
"""Seconds between two tries to reach a scheduler again: a choice."""

_QUIET = {
    "distributed.worker.profile.enabled": False,
    "distributed.admin.tick.interval": "1s",
    "distributed.admin.system-monitor.interval": "10s",
}
"""Settings of Dask for workers here. It looks at its threads a hundred times a second, at its delay fifty times, and at
the machine twice: with two workers 28 to 50 ms of a processor each second, 5 with these settings."""

_BROKEN = (OSError, AssertionError)
"""What Dask raises where a connection breaks while it is opened. It asserts that the first words of a scheduler greet:
one that ends at that moment says something else."""

_LOCAL = re.compile(r"local(?::(?P<count>\d+))?")


@contextmanager
def open_client(address: str, job: RenderJob | None = None) -> Iterator[Client]:
    """A connection to the scheduler at an address such as tcp://farm:8786, or `local:4` for four workers here.

    Workers here begin to load what a `job` needs before Dask is there.

    Raises UsageError for another text, RenderError if no scheduler answers.
    """
    local = _LOCAL.fullmatch(address)
    if local is None and "://" not in address:
        raise UsageError(f"--cluster {address}: write tcp://HOST:PORT of a Dask scheduler, or local:4 for four workers")
    count = int(local["count"] or os.cpu_count() or 1) if local else 0
    if local and not count:
        raise UsageError(f"--cluster {address}: at least one worker is needed: write local:1")
    with contextlib.ExitStack() as stack:
        if local:
            stack.callback(open_pool().close)
            if job is not None:
                open_pool().warm(job, min(count, len(job.frames) or count))
        yield stack.enter_context(_connect(address, count))


@contextmanager
def _connect(address: str, count: int) -> Iterator[Client]:
    """A connection to a scheduler; with a `count` to one here, with so many workers."""
    if find_spec("distributed") is None:
        raise UsageError("--cluster needs Dask: pip install 'halation[cluster]'")
    # Dask writes pages about what it tries again; the user gets one sentence for it.
    for name in ("distributed", "distributed.client", "distributed.scheduler", "distributed.worker", "tornado"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    warnings.filterwarnings("ignore", module=r"distributed(\..*)?")
    with contextlib.ExitStack() as stack:
        target: str | LocalCluster = stack.enter_context(start_cluster(count)) if count else address
        try:
            client = _open_client(target)
        except (*_BROKEN, ValueError, TypeError) as fault:
            reason = "" if isinstance(fault, _BROKEN) else f" ({fault})"
            raise RenderError(
                f"--cluster {address}: no scheduler answers there{reason}: start one with 'dask scheduler', or check "
                "the address"
            ) from None
        try:
            yield client
        finally:
            with contextlib.suppress(Exception):  # whatever Dask says of a connection that is gone anyway
                client.close(timeout=1)


def _open_client(target: str | LocalCluster) -> Client:
    """A client of a cluster, tried again where a connection is closed at once, as by a scheduler that just starts.

    Raises what is `_BROKEN`, and what Dask raises for what is no address.
    """
    import distributed

    deadline = time.monotonic() + CONNECT_SECONDS
    while True:
        try:
            if isinstance(target, str):
                _await_listener(target)
            return distributed.Client(target, timeout=ANSWER_SECONDS, set_as_default=False)
        except _BROKEN:
            if time.monotonic() > deadline:
                raise
        time.sleep(_RETRY_INTERVAL)


def _await_listener(address: str) -> None:
    """Wait until somebody listens at an address. Raises OSError, or ValueError for what is no address."""
    parts = urlsplit(address)
    if parts.scheme not in ("tcp", "tls") or not parts.hostname or not parts.port:
        return  # of a kind that only Dask knows
    deadline = time.monotonic() + CONNECT_SECONDS
    while True:
        try:
            socket.create_connection((parts.hostname, parts.port), CONNECT_SECONDS).close()
            return
        except OSError:
            if time.monotonic() > deadline:
                raise
        time.sleep(_RETRY_INTERVAL)


@contextmanager
def reopen_client(address: str, fault: RenderError) -> Iterator[Client]:
    """A connection to a scheduler that has gone, as soon as it is there again. Raises `fault` if it does not return."""
    deadline = time.monotonic() + RETURN_SECONDS
    with contextlib.ExitStack() as stack:
        while True:
            try:
                client = stack.enter_context(_connect(address, 0))
                break
            except RenderError:
                if time.monotonic() > deadline:
                    raise fault from None
                time.sleep(_RETRY_INTERVAL)
        yield client


def find_dashboard(client: Client) -> str:
    """The address of Dask's page about a scheduler; "" for one inside of this process, which has none."""
    from distributed import LocalCluster

    return "" if isinstance(client.cluster, LocalCluster) else str(client.dashboard_link or "")


def iterate_finished(client: Client, futures: Sequence[Future[str]]) -> Iterator[Future[str]]:
    """The futures of tasks as they end."""
    from distributed import as_completed

    return cast("Iterator[Future[str]]", iter(as_completed(futures, loop=client.loop)))


@contextmanager
def start_cluster(count: int) -> Iterator[LocalCluster]:
    """A scheduler with workers on threads of this process: each renders in a process beside it anyway."""
    import dask.config
    from distributed import LocalCluster

    with dask.config.set(_QUIET):
        cluster = LocalCluster(
            n_workers=count,
            threads_per_worker=1,
            processes=False,
            dashboard_address=cast("str", None),
            worker_dashboard_address=None,
            memory_limit=0,
            silence_logs=logging.CRITICAL,
        )
    try:
        # On a busy machine Dask returns before they are there, and the job would believe that it has none.
        with contextlib.suppress(TimeoutError):
            cluster.wait_for_workers(count, timeout=ANSWER_SECONDS)
        yield cluster
    finally:
        with contextlib.suppress(Exception):
            cluster.close(timeout=1)
