"""`halation worker`: a render job that another process of Halation has sent."""

from __future__ import annotations

from .execute import execute
from .options import AsJson, standard_input


def worker(as_json: AsJson = True) -> int:
    """Render the job that comes as JSON on standard input, and report in JSON."""
    from ..renderer.jobs.render_job import RenderJob

    return execute(RenderJob.from_json(standard_input()), "json", as_json)
