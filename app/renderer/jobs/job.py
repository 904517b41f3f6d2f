"""Renders a graph into files: what `halation render` does after its arguments are parsed.

A job has one item, or many: `run_job` renders frames of one graph, `run_batch` many files through one graph. Both are
the same pipeline (`pipeline`).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Sequence

from ...graph import Graph
from ..engine import Renderer, RenderRequest
from .destinations import OutputSettings
from .item_session import JobItem
from .pipeline import FramePipeline, ItemOpener, KeptResults
from .reports import FrameReport, ItemReport, JobProgress, JobReport
from .source_files import FileHashes

__all__ = ["FrameReport", "JobProgress", "JobReport", "KeptResults", "OutputSettings", "run_batch", "run_job"]


def run_job(
    renderer: Renderer,
    graph: Graph,
    request: RenderRequest,
    settings: OutputSettings,
    frames: Sequence[int] | None = None,
    *,
    resume: bool = False,
    progress: JobProgress | None = None,
    todo: deque[int] | None = None,
) -> JobReport:
    """Render frames, by default that of `request`, and write them. Others may take some of those in `todo`.

    Destinations are checked before anything is rendered. With `resume`, files that are up to date are kept. Raises the
    errors of `app.errors`; the files of finished frames stay, and no incomplete file and no video is left behind.
    """
    item = JobItem("", graph, request, settings, tuple(frames or (request.frame,)), todo=todo)
    item_reports: list[ItemReport] = []
    report = run_batch(renderer, [("", lambda: item)], item_reports.append, resume=resume, progress=progress)
    if fault := item_reports[0].fault:
        raise fault
    return report


def run_batch(
    renderer: Renderer,
    items: Iterable[tuple[str, ItemOpener]],
    report_item: Callable[[ItemReport], None],
    *,
    resume: bool = False,
    progress: JobProgress | None = None,
    writers: int = 1,
    hashes: FileHashes | None = None,
    kept: KeptResults | None = None,
) -> JobReport:
    """Render items, given by their names, and write them; the report of all of them together.

    `writers` threads write the files; a video needs a single one. Each item is reported when it is finished. An error
    ends its item, is part of the report of it, and is not raised. `hashes` are those of files that an earlier batch has
    read, and `kept` are its results, in place of which come those that this batch leaves for a later one.
    """
    counters, programs = renderer.runner.counters.passes, renderer.runner.programs.compiled
    item_reports: list[ItemReport] = []

    def collect_report(report: ItemReport) -> None:
        item_reports.append(report)
        report_item(report)

    pipeline = FramePipeline(
        renderer, items, collect_report, resume=resume, progress=progress, writers=writers, hashes=hashes, kept=kept
    )
    try:
        pipeline.run()
    finally:
        pipeline.close()
    return JobReport(
        tuple(frame for item in item_reports for frame in item.frames),
        renderer.runner.counters.passes - counters,
        renderer.runner.programs.compiled - programs,
        renderer.runner.textures.peak,
        dict(renderer.pictures.repaired_pixels),
        tuple(video for item in item_reports for video in item.videos),
        pipeline.seconds,
        dict(renderer.pictures.warnings),
        {output: view for item in item_reports for output, view in item.views.items()},
        tuple(dict.fromkeys(output for item in item_reports for output in item.data_outputs)),
    )
