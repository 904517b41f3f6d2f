"""Writes outcomes as one HTML page that needs no other file."""

from __future__ import annotations

import json
from base64 import b64encode
from importlib import resources
from pathlib import Path
from typing import Any

from ..errors import OutputError, UsageError
from ..resources.atomic_write import check_replaceable, write_text_atomically
from ..resources.sandbox import Sandbox
from .cases import METRICS, format_number
from .results import Outcome, PictureCheck, PictureViews, RegressionRun

_MARK = "/*DATA*/null"
_MAX_PICTURE_BYTES = 200 * 2**20
"""Bytes of pictures in a page; later failures have no pictures. Chosen by judgement: in base64 they take 280 MB, and
browsers struggle with larger pages."""


def check_report(*paths: Path | None, sandbox: Sandbox) -> None:
    """Refuse what cannot be written, before anything is rendered. Raises UsageError."""
    for path in paths:
        if path is None:
            continue
        try:
            check_replaceable(path, sandbox)
        except OutputError as fault:
            raise UsageError(str(fault)) from None
        if not path.parent.is_dir():
            raise UsageError(f"{path}: there is no such folder: create it first")


def write_report(session: RegressionRun, path: Path, sandbox: Sandbox) -> None:
    """Write the page, whole or not at all. Raises OutputError."""
    write_text_atomically(path, make_page(session), sandbox=sandbox)


def make_page(session: RegressionRun) -> str:
    """The page as text. Pictures are inside, those of failures only."""
    template = resources.files(__package__ or "").joinpath("report.html").read_text("utf-8")
    data = {
        "device": session.device,
        "deterministic": session.deterministic,
        "remark": session.remark,
        "version": session.version,
        "seconds": round(session.seconds, 2),
        "cases": _describe_cases(session),
    }
    # HTML ends a script at the first "</script", even inside a string, so no "<" may be in the data.
    return template.replace(_MARK, json.dumps(data, separators=(",", ":")).replace("<", "\\u003c"))


def _describe_cases(session: RegressionRun) -> list[dict[str, Any]]:
    room = _MAX_PICTURE_BYTES
    cases: list[dict[str, Any]] = []
    for outcome in session.outcomes:
        checks: list[dict[str, Any]] = []
        for check in outcome.checks:
            views, room = _embed_views(check.views, room)
            checks.append(_describe_check(outcome, check) | views)
        cases.append(_describe_case(outcome) | {"checks": checks})
    return cases


def _describe_case(outcome: Outcome) -> dict[str, Any]:
    case, worst = outcome.case, outcome.worst
    value = "" if worst is None or worst.value is None else format_number(worst.value)
    return {
        "suite": case.suite.as_posix(),
        "name": case.name,
        "status": outcome.status,
        "said": outcome.sentence,
        "seconds": round(outcome.seconds, 3),
        "graph": case.graph.as_posix(),
        "metric": _describe_metric(outcome),
        "value": value,
    }


def _describe_metric(outcome: Outcome) -> str:
    case = outcome.case
    if case.error:
        return "must fail"
    if not case.goldens:
        return "must render"
    share = f", {format_number(case.failing)} % may fail" if case.failing else ""
    sign = "\u2265" if METRICS[case.metric].least else "\u2264"
    return f"{case.metric} {sign} {format_number(case.tolerance)}{METRICS[case.metric].unit}{share}"


def _describe_check(outcome: Outcome, check: PictureCheck) -> dict[str, Any]:
    difference = check.compared
    description: dict[str, Any] = {
        "golden": check.golden.as_posix(),
        "frame": check.frame,
        "layer": check.layer,
        "said": check.sentence,
        "goldenBy": check.golden_by,
        "madeBy": check.made_by,
        "elsewhere": bool(check.elsewhere),
        "files": [path.as_posix() for path in check.files],
    }
    if difference is not None and outcome.status == "failed":
        names = ("max_rel", "max_abs", "rms", "psnr", "ssim", "flip")
        values = {name: getattr(difference, name) for name in names}
        description["measures"] = {name: format_number(value) for name, value in values.items() if value == value}
        description["share"] = format_number(100.0 * difference.failing)
        if difference.worst:
            description["worst"] = list(difference.worst)
            description["numbers"] = [
                [format_number(part) for part in side] for side in (difference.actual, difference.expected)
            ]
    return description


def _embed_views(views: PictureViews | None, room: int) -> tuple[dict[str, Any], int]:
    if views is None:
        return {}, room
    pictures = {"actual": views.actual, "expected": views.expected, "difference": views.difference}
    size = sum(map(len, pictures.values()))
    if size > room:
        return {"left": True}, room
    inside = {name: f"data:image/png;base64,{b64encode(data).decode()}" for name, data in pictures.items() if data}
    return {"views": inside, "gain": format_number(views.gain)}, room - size
