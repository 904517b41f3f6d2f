"""One rendered file against its golden."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import inf
from pathlib import Path

import numpy as np

from ..errors import HalationError
from ..media.comparison.metrics import EIGHT_BIT_STEP, PictureDifference, compare_pictures
from ..media.pictures.stored import StoredPart, describe_maker, read_stored_parts
from ..resources.sandbox import Sandbox
from .cases import METRICS, PER_PIXEL, Case, format_number
from .results import PictureCheck

Parts = Mapping[str, StoredPart]


def judge_picture(
    case: Case, actual: Path, golden: Path, frame: int, sandbox: Sandbox
) -> tuple[PictureCheck, Parts, Parts]:
    """What there is to say of a picture, and the parts of both files. Nothing is raised for a bad golden."""
    made, made_by = read_stored_parts(actual, sandbox=sandbox), describe_maker(actual, sandbox=sandbox)
    fresh = PictureCheck(golden, frame, made_by=made_by)
    if not golden.is_file():
        return replace(fresh, sentence=f"the golden {golden} is missing: --update makes it"), made, {}
    try:
        wanted, golden_by = read_stored_parts(golden, sandbox=sandbox), describe_maker(golden, sandbox=sandbox)
    except HalationError as fault:
        return replace(fresh, sentence=str(fault)), made, {}
    fresh = replace(fresh, golden_by=golden_by)
    if list(made) != list(wanted):
        said = f"{golden}: the layers are {_join_names(made)}, and {_join_names(wanted)} are expected"
        return replace(fresh, sentence=said), made, wanted
    checks = [_measure_layer(case, fresh, name, made[name], wanted[name]) for name in made]
    return max(checks, key=lambda check: (bool(check.sentence), _rank(case, check))), made, wanted


def find_unusable(case: Case, parts: Parts) -> str:
    """Why a picture should not become a golden, or pass where none is asked for; "" if nothing speaks against it."""
    if "nonfinite" not in case.allow:
        for name, part in parts.items():
            if part.count_unusable:
                of = f" of '{name}'" if name else ""
                return f'{part.count_unusable} pixels{of} are not finite; allow = ["nonfinite"] if they may be'
    if "black" not in case.allow and not any(part.array[..., :3].any() for part in parts.values()):
        return 'the picture is all black; allow = ["black"] if it may be'
    return ""


def add_slow_measures(case: Case, check: PictureCheck, made: Parts, wanted: Parts) -> PictureCheck:
    """The same check with the measures that take long, for people."""
    if check.compared is None or check.layer not in made or check.layer not in wanted:
        return check
    return replace(check, compared=_compare(case, made[check.layer], wanted[check.layer], perceptual=True))


def _compare(case: Case, made: StoredPart, wanted: StoredPart, perceptual: bool) -> PictureDifference:
    threshold = case.tolerance if case.metric in PER_PIXEL else EIGHT_BIT_STEP
    return compare_pictures(
        made.array,
        wanted.array,
        threshold=threshold,
        relative=case.metric != "max_abs",
        linear=made.is_linear and wanted.is_linear,
        perceptual=perceptual,
    )


def _measure_layer(case: Case, fresh: PictureCheck, name: str, made: StoredPart, wanted: StoredPart) -> PictureCheck:
    found = _compare(case, made, wanted, perceptual=case.metric in ("ssim", "flip"))
    check = replace(fresh, layer=name, compared=found)
    if found.fault:
        return replace(check, sentence=f"{_name_layer(check)}{found.fault}")
    value = float(getattr(found, case.metric))
    return replace(check, value=value, sentence=_describe_failure(case, check, found, value))


def _describe_failure(case: Case, check: PictureCheck, found: PictureDifference, value: float) -> str:
    metric = METRICS[case.metric]
    if metric.allows(value, case.tolerance):
        return ""
    if case.failing and case.metric in PER_PIXEL:
        if 100.0 * found.failing <= case.failing:
            return ""
        share = f"{format_number(100.0 * found.failing)} % of the pixels are beyond {format_number(case.tolerance)}"
        return f"{_name_layer(check)}{share} where {format_number(case.failing)} % may be{_describe_worst_pixel(found)}"
    return f"{_name_layer(check)}{metric.describe(value, case.tolerance)}{_describe_worst_pixel(found)}"


def _name_layer(check: PictureCheck) -> str:
    layer = f" '{check.layer}'" if check.layer else ""
    return f"{check.golden}{layer}: "


def _describe_worst_pixel(found: PictureDifference) -> str:
    """The worst pixel in words."""
    if found.worst is None:
        return ""
    actual, expected = (" ".join(format_number(part) for part in side) for side in (found.actual, found.expected))
    broken = f"; {found.broken} pixels are not finite on one side" if found.broken else ""
    return f"; worst at {found.worst[0]},{found.worst[1]}: {actual} instead of {expected}{broken}"


def _rank(case: Case, check: PictureCheck) -> float:
    if check.value is None:
        return inf
    value = -check.value if METRICS[case.metric].least else check.value
    return inf if np.isnan(value) else value


def _join_names(parts: Parts) -> str:
    return ", ".join(name or "(unnamed)" for name in parts)
