"""`halation worker`: runs a render job for another process of Halation."""

from __future__ import annotations

from .execute import execute
from .options import AsJson, read_standard_input
from .signals import end_with_parent
from .watchdog import end_with_watchdog


def worker(as_json: AsJson = True) -> int:
    """Run the render job that is read as JSON from standard input, and report in JSON."""
    from msgspec.structs import replace

    from ..renderer.jobs.render_job import RenderJob
    from ..resources.sandbox import read_process_sandbox

    end_with_parent()
    end_with_watchdog()
    job = RenderJob.from_json(read_standard_input())
    if job.sandbox.root:
        job = replace(job, sandbox=read_process_sandbox().narrow(job.sandbox.root))
    return execute(job, "json", as_json)
