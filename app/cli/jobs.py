"""`halation jobs`: the jobs on a cluster that go on without who has sent them."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import UsageError
from .options import AsJson
from .outcome import print_json, print_note, write_count

if TYPE_CHECKING:
    from ..cluster.detached import JobBoard, JobStatus

_FOLLOW_INTERVAL = 0.5
"""Seconds between two looks at a job: a choice, as often as its state is sent."""


def jobs(
    cluster: Annotated[str, typer.Option("--cluster", metavar="ADDRESS", help="The Dask scheduler.")],
    follow: Annotated[
        str, typer.Option("--follow", metavar="JOB", help="Show how far a job is until it ends; 1 if frames failed.")
    ] = "",
    cancel: Annotated[
        str, typer.Option("--cancel", metavar="JOB", help="End a job and forget it; finished frames stay.")
    ] = "",
    as_json: AsJson = False,
) -> int:
    """List, follow or cancel the jobs of a cluster.

    These are the jobs that were sent with render --detach.
    """
    from ..cluster.connection import open_client
    from ..cluster.detached import JobBoard

    if cluster.startswith("local"):
        raise UsageError(f"--cluster {cluster}: workers of a single command have no jobs: name a scheduler")
    if follow and cancel:
        raise UsageError("--follow and --cancel: give one of them")
    with open_client(cluster) as client:
        board = JobBoard(client)
        if cancel:
            board.cancel(cancel)
            print_note(f"{cancel} is cancelled")
            return 0
        if follow:
            return _follow(board, follow, as_json)
        statuses = list(board.list_jobs())
        if as_json:
            import msgspec

            print_json({"jobs": msgspec.to_builtins(statuses)})
        for status in () if as_json else statuses:
            print(_describe(status))
        if not statuses:
            print_note("there are no jobs")
    return 0


def _follow(board: JobBoard, name: str, as_json: bool) -> int:
    """Show how far a job is until it ends, and return the exit code."""
    last_line = ""
    while True:
        status = board.find_job(name)
        line = _describe(status)
        if line != last_line and not as_json:
            print(line, flush=True)
        last_line = line
        if status.state != "rendering":
            break
        time.sleep(_FOLLOW_INTERVAL)
    if as_json:
        from ..resources.struct_json import write_struct

        print(write_struct(status))
    for note in status.notes:
        print_note(note)
    for frame, sentence in status.faults.items():
        print_note(f"{status.unit} {frame}: {sentence}" if frame else sentence)
    return 1 if status.state == "failed" else 0


def _describe(status: JobStatus) -> str:
    """A line about a job."""
    parts = [f"{status.name}  {status.state}  {status.done} of {write_count(status.total, status.unit)}"]
    if status.seconds:
        parts.append(f"{status.seconds:.1f} s")
    if status.state == "rendering" and status.workers:
        parts.append(write_count(status.workers, "worker"))
    if status.state == "rendering" and status.done:
        parts.append(f"{status.seconds / status.done * (status.total - status.done):.0f} s left")
    if status.slowest:
        parts.append("slowest " + ", ".join(f"{frame} ({cost:.1f} s)" for frame, cost in status.slowest.items()))
    return f"{', '.join(parts)}  {status.graph}".rstrip()
