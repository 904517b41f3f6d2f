"""`halation worker`: a render job that another process of Halation has sent."""

from __future__ import annotations

from .execute import execute
from .options import AsJson, standard_input


def worker(as_json: AsJson = True) -> int:
    """Render the job that comes as JSON on standard input, and report in JSON."""
    from ..renderer.jobs.render_job import RenderJob
    from ..resources.sandbox import fenced

    job = RenderJob.from_json(standard_input())
    with fenced(job.root or None):
        return execute(job, "json", as_json)
