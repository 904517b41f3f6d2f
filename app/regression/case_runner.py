"""Runs regression cases: renders each graph and compares its pictures with the goldens."""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Mapping
from functools import reduce
from pathlib import Path
from typing import Any

from msgspec import Struct
from msgspec.structs import replace

from .. import document
from ..compiler import find_named_files
from ..errors import GraphError, HalationError
from ..graph import Expression, Graph, Port, find_node_output, problems
from ..graph.frames import Pattern
from ..media.layers import split_layer
from ..media.pictures.stored import StoredPart, copy_picture
from ..renderer import FrameRenderer, Renderer, RenderRequest
from ..renderer.jobs.job import OutputSettings, run_job
from ..resources.sandbox import Sandbox
from .cases import Case, Golden
from .comparison import PictureParts, add_slow_measures, find_unusable, judge_picture
from .pictures import make_views, write_failure_pictures
from .results import Outcome, PictureCheck


class RunOptions(Struct, frozen=True):
    """The settings of a run. `update` writes goldens that are missing or differ; `out` is a folder for failed pictures.

    With `pictures`, failed checks get views for a report.
    """

    sandbox: Sandbox
    update: bool = False
    out: Path | None = None
    pictures: bool = False
    deterministic: bool = True


def run_case(case: Case, renderer: Renderer, options: RunOptions) -> Outcome:
    """The outcome of a case. A faulty case is an outcome, too; only `out` raises OutputError."""
    started = time.perf_counter()
    if case.skip:
        return Outcome(case, "skipped", case.skip)
    try:
        outcome = _run_failing(case, renderer, options) if case.error else _run_rendering(case, renderer, options)
    except HalationError as fault:
        outcome = Outcome(case, "failed", str(fault))
    return replace(outcome, seconds=time.perf_counter() - started)


def _run_failing(case: Case, renderer: Renderer, options: RunOptions) -> Outcome:
    try:
        _render_only(case, renderer, options)
    except HalationError as fault:
        message = str(fault)
        if case.error.casefold() in message.casefold():
            return Outcome(case, "passed", message)
        return Outcome(case, "failed", f"it fails as it should, but not with '{case.error}': {message}")
    return Outcome(case, "failed", f"it should fail with '{case.error}', but it renders")


def _run_rendering(case: Case, renderer: Renderer, options: RunOptions) -> Outcome:
    if not case.goldens:
        return _render_only(case, renderer, options)
    graph = _load_graph(case, sandbox=options.sandbox)
    request = _make_request(case, graph, options)
    frames = case.frames or (renderer.find_frames(graph, request)[0],)
    with tempfile.TemporaryDirectory(prefix="halation-", dir=options.sandbox.root or None) as name:
        folders = [Path(name) / str(index) for index in range(len(case.goldens))]
        for folder in folders:
            folder.mkdir()
        actual = [folder / golden.path.name for folder, golden in zip(folders, case.goldens, strict=True)]
        files = tuple((golden.output, path) for golden, path in zip(case.goldens, actual, strict=True))
        precision = "float" if case.precision == "float" else "half"
        run_job(renderer, graph, request, OutputSettings(files, case.view, precision=precision, dither="none"), frames)
        checks, blessed = list[PictureCheck](), list[str]()
        for frame in frames:
            for golden, path in zip(case.goldens, actual, strict=True):
                check, blessing = _check_picture(case, graph, golden, _name_at_frame(path, frame), frame, options)
                checks.append(check)
                blessed += [blessing] if blessing else []
    faults = [check for check in checks if check.sentence]
    if faults:
        more_faults = f" (and {len(faults) - 1} more pictures)" if len(faults) > 1 else ""
        note = f"; {faults[0].elsewhere}" if faults[0].elsewhere else ""
        return Outcome(case, "failed", f"{faults[0].sentence}{note}{more_faults}", checks=tuple(checks))
    return Outcome(case, "blessed" if blessed else "passed", "; ".join(blessed), checks=tuple(checks))


def _check_picture(
    case: Case, graph: Graph, golden: Golden, actual: Path, frame: int, options: RunOptions
) -> tuple[PictureCheck, str]:
    """The check of one picture, and a sentence on its golden if that was written."""
    path = _name_at_frame(golden.path, frame)
    check, actual_parts, golden_parts = judge_picture(case, actual, path, frame, sandbox=options.sandbox)
    if not check.sentence:
        return check, ""
    if options.update:
        refusal = find_unusable(case, actual_parts) or _explain_conflict(graph, case, path)
        if not refusal:
            old = check.sentence.removeprefix(f"{path}: ") if golden_parts else "new"
            copy_picture(path, actual, sandbox=options.sandbox)
            return judge_picture(case, actual, path, frame, sandbox=options.sandbox)[0], f"{path}: {old}"
        check = replace(check, sentence=f"{path} is not blessed: {refusal}")
    if options.pictures or options.out is not None:
        check = _add_views(check, case, graph, actual_parts, golden_parts)
    if options.out is not None:
        check = write_failure_pictures(
            check, case, actual, actual_parts, golden_parts, options.out, sandbox=options.sandbox
        )
    return check, ""


def _add_views(
    check: PictureCheck, case: Case, graph: Graph, actual_parts: PictureParts, golden_parts: PictureParts
) -> PictureCheck:
    outputs = list(graph.outputs.values())
    check = add_slow_measures(case, check, actual_parts, golden_parts)
    return replace(
        check, views=make_views(check, actual_parts, golden_parts, case.view or (outputs[0].view if outputs else ""))
    )


def _render_only(case: Case, renderer: Renderer, options: RunOptions) -> Outcome:
    """A case without goldens: it must render, in finite numbers, and not only black."""
    graph = _load_graph(case, sandbox=options.sandbox)
    request = _make_request(case, graph, options)
    frame_renderer = FrameRenderer(renderer, graph, request)
    try:
        for frame in case.frames or (frame_renderer.frames[0],):
            pictures = frame_renderer.render_frame(frame)
            if not case.error and (fault := _find_fault(case, graph, request, pictures)):
                return Outcome(case, "failed", f"frame {frame}: {fault}")
    finally:
        frame_renderer.close()
    return Outcome(case, "passed")


def _find_fault(case: Case, graph: Graph, request: RenderRequest, pictures: Mapping[str, Any]) -> str:
    letters = {1: ("Y",), 2: ("X", "Y"), 3: ("X", "Y", "Z"), 4: ("R", "G", "B", "A")}
    return find_unusable(
        case,
        {
            name: StoredPart(array, letters.get(array.shape[2], ("X",)), is_encoded=False)
            for name, array in pictures.items()
        },
    )


def _load_graph(case: Case, sandbox: Sandbox) -> Graph:
    """The graph with the values of the case. Raises GraphError, also for errors that `halation check` reports."""
    graph = reduce(_set_value, case.values.items(), document.load(case.graph, sandbox=sandbox))
    errors = [problem for problem in problems(graph) if problem.severity == "error"]
    if errors:
        raise GraphError(f"{case.graph}: {errors[0].sentence}")
    return graph


def _set_value(graph: Graph, setting: tuple[str, Any]) -> Graph:
    name, value = setting
    try:
        is_expression = isinstance(value, str) and value.startswith("=")
        return graph.override(name, Expression(value[1:].strip()) if is_expression else value)
    except GraphError as fault:
        raise GraphError(f"set.{name}: {str(fault).removeprefix(f'{name}: ')}") from None


def _make_request(case: Case, graph: Graph, options: RunOptions) -> RenderRequest:
    targets: dict[str, Port] = {case.node: find_node_output(graph, case.node)} if case.node else {}
    precision = "float" if options.deterministic else None
    return RenderRequest(case.inputs, targets, case.size, case.scale, precision=precision)


def _explain_conflict(graph: Graph, case: Case, golden: Path) -> str:
    """Why a golden must not be written: the graph reads that file; "" if it does not."""
    read = [path for path, _, _ in find_named_files(graph, {})]
    read += [split_layer(item)[0] for item in case.inputs.values() if isinstance(item, str)]
    if any(os.path.realpath(path) == os.path.realpath(golden) for path in read):
        return "the graph reads this file; name another"
    return ""


def _name_at_frame(path: Path, frame: int) -> Path:
    pattern = Pattern.parse(str(path))
    return path if pattern is None else Path(pattern.name(frame))
