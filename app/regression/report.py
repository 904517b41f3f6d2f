"""Outcomes as one HTML page that needs nothing but itself."""

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
_MOST = 200 * 2**20
"""Bytes of pictures; what fails after that is a row without pictures."""


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
        "cases": _cases(session),
    }
    # A script element ends at its end tag and nowhere else, wherever that stands.
    return template.replace(_MARK, json.dumps(data, separators=(",", ":")).replace("<", "\\u003c"))


def _cases(session: RegressionRun) -> list[dict[str, Any]]:
    room = _MOST
    found: list[dict[str, Any]] = []
    for outcome in session.outcomes:
        checks: list[dict[str, Any]] = []
        for check in outcome.checks:
            views, room = _views(check.views, room)
            checks.append(_check(outcome, check) | views)
        found.append(_case(outcome) | {"checks": checks})
    return found


def _case(outcome: Outcome) -> dict[str, Any]:
    case, worst = outcome.case, outcome.worst
    value = "" if worst is None or worst.value is None else format_number(worst.value)
    return {
        "suite": case.suite.as_posix(),
        "name": case.name,
        "status": outcome.status,
        "said": outcome.sentence,
        "seconds": round(outcome.seconds, 3),
        "graph": case.graph.as_posix(),
        "metric": _metric(outcome),
        "value": value,
    }


def _metric(outcome: Outcome) -> str:
    case = outcome.case
    if case.error:
        return "must fail"
    if not case.goldens:
        return "must render"
    share = f", {format_number(case.failing)} % may fail" if case.failing else ""
    sign = "\u2265" if METRICS[case.metric].least else "\u2264"
    return f"{case.metric} {sign} {format_number(case.tolerance)}{METRICS[case.metric].unit}{share}"


def _check(outcome: Outcome, check: PictureCheck) -> dict[str, Any]:
    found = check.compared
    said: dict[str, Any] = {
        "golden": check.golden.as_posix(),
        "frame": check.frame,
        "layer": check.layer,
        "said": check.sentence,
        "goldenBy": check.golden_by,
        "madeBy": check.made_by,
        "elsewhere": bool(check.elsewhere),
        "files": [path.as_posix() for path in check.files],
    }
    if found is not None and outcome.status == "failed":
        names = ("max_rel", "max_abs", "rms", "psnr", "ssim", "flip")
        values = {name: getattr(found, name) for name in names}
        said["measures"] = {name: format_number(value) for name, value in values.items() if value == value}
        said["share"] = format_number(100.0 * found.failing)
        if found.worst:
            said["worst"] = list(found.worst)
            said["numbers"] = [[format_number(part) for part in side] for side in (found.actual, found.expected)]
    return said


def _views(views: PictureViews | None, room: int) -> tuple[dict[str, Any], int]:
    if views is None:
        return {}, room
    pictures = {"actual": views.actual, "expected": views.expected, "difference": views.difference}
    size = sum(map(len, pictures.values()))
    if size > room:
        return {"left": True}, room
    inside = {name: f"data:image/png;base64,{b64encode(data).decode()}" for name, data in pictures.items() if data}
    return {"views": inside, "gain": format_number(views.gain)}, room - size
