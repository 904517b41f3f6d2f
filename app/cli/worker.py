"""`halation worker`: runs a render job for another process of Halation."""

from __future__ import annotations

from itertools import count
from typing import Annotated

import typer

from .execute import execute, open_job_graph
from .execute_batch import render_entries
from .options import AsJson, read_standard_input
from .outcome import print_json
from .progress import JsonLines
from .signals import end_with_parent
from .watchdog import end_with_watchdog


def worker(
    as_json: AsJson = True,
    chunks: Annotated[
        bool, typer.Option("--chunks", help="Read chunks of frames instead, one per line, and render each.")
    ] = False,
    share: Annotated[
        bool, typer.Option("--share", help="Render a share of the files of another process, which joins the reports.")
    ] = False,
    cluster: Annotated[
        str,
        typer.Option("--on", metavar="ADDRESS", help="Have the workers of a cluster render it, and report as they do."),
    ] = "",
) -> int:
    """Run the render job that is read as JSON from standard input, and report in JSON."""
    from msgspec.structs import replace

    from ..renderer.jobs.render_job import RenderJob
    from ..resources.sandbox import read_process_sandbox

    end_with_parent()
    if chunks:
        from .chunk_worker import render_chunks

        return render_chunks(read_process_sandbox())
    end_with_watchdog()
    job = RenderJob.from_json(read_standard_input())
    if job.sandbox.root:
        job = replace(job, sandbox=read_process_sandbox().narrow(job.sandbox.root))
    if cluster:
        from .execute_cluster import ClusterOptions, execute_on_cluster

        return execute_on_cluster(job, ClusterOptions(cluster), "json", as_json and not job.entries)
    if not (job.entries and share):  # of many files, lines of progress say all that there is to know
        return execute(job, "json", as_json and not job.entries)
    lines, total, counter = JsonLines(), len(job.entries), count(1)
    print_json(render_entries(job, open_job_graph(job), lambda facts: lines.report_entry(facts, next(counter), total)))
    return 0
