"""Compares a rendered file with its golden."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf
from pathlib import Path

import numpy as np
from msgspec.structs import replace

from ..errors import HalationError
from ..media.comparison.metrics import EIGHT_BIT_STEP, PictureDifference, compare_pictures
from ..media.pictures.stored import StoredPart, describe_maker, read_stored_parts
from ..resources.sandbox import Sandbox
from .cases import METRICS, PER_PIXEL, Case, format_number
from .results import PictureCheck

PictureParts = Mapping[str, StoredPart]


def judge_picture(
    case: Case, actual: Path, golden: Path, frame: int, sandbox: Sandbox
) -> tuple[PictureCheck, PictureParts, PictureParts]:
    """The check of a picture, and the parts of both files. A golden that cannot be read is a failed check, no error."""
    actual_parts, made_by = read_stored_parts(actual, sandbox=sandbox), describe_maker(actual, sandbox=sandbox)
    check = PictureCheck(golden, frame, made_by=made_by)
    if not golden.is_file():
        return replace(check, sentence=f"the golden {golden} is missing: --update makes it"), actual_parts, {}
    try:
        golden_parts, golden_by = read_stored_parts(golden, sandbox=sandbox), describe_maker(golden, sandbox=sandbox)
    except HalationError as fault:
        return replace(check, sentence=str(fault)), actual_parts, {}
    check = replace(check, golden_by=golden_by)
    if list(actual_parts) != list(golden_parts):
        sentence = f"{golden}: the layers are {_join_names(actual_parts)}, and {_join_names(golden_parts)} are expected"
        return replace(check, sentence=sentence), actual_parts, golden_parts
    checks = [_measure_layer(case, check, name, actual_parts[name], golden_parts[name]) for name in actual_parts]
    return max(checks, key=lambda check: (bool(check.sentence), _rank(case, check))), actual_parts, golden_parts


def find_unusable(case: Case, parts: PictureParts) -> str:
    """Why a picture can neither become a golden nor pass without one: it is black or not finite; "" if it can."""
    if "nonfinite" not in case.allow:
        for name, part in parts.items():
            if part.count_unusable:
                of = f" of '{name}'" if name else ""
                return f'{part.count_unusable} pixels{of} are not finite; allow = ["nonfinite"] if they may be'
    if "black" not in case.allow and not any(part.array[..., :3].any() for part in parts.values()):
        return 'the picture is all black; allow = ["black"] if it may be'
    return ""


def add_slow_measures(
    case: Case, check: PictureCheck, actual_parts: PictureParts, golden_parts: PictureParts
) -> PictureCheck:
    """The same check with all measures, also the slow ones (SSIM, FLIP), for a report."""
    if check.compared is None or check.layer not in actual_parts or check.layer not in golden_parts:
        return check
    return replace(
        check, compared=_compare(case, actual_parts[check.layer], golden_parts[check.layer], perceptual=True)
    )


def _compare(case: Case, actual: StoredPart, golden: StoredPart, perceptual: bool) -> PictureDifference:
    threshold = case.tolerance if case.metric in PER_PIXEL else EIGHT_BIT_STEP
    return compare_pictures(
        actual.array,
        golden.array,
        threshold=threshold,
        relative=case.metric != "max_abs",
        linear=actual.is_linear and golden.is_linear,
        perceptual=perceptual,
    )


def _measure_layer(case: Case, fresh: PictureCheck, name: str, actual: StoredPart, golden: StoredPart) -> PictureCheck:
    difference = _compare(case, actual, golden, perceptual=case.metric in ("ssim", "flip"))
    check = replace(fresh, layer=name, compared=difference)
    if difference.fault:
        return replace(check, sentence=f"{_name_layer(check)}{difference.fault}")
    value = float(getattr(difference, case.metric))
    return replace(check, value=value, sentence=_describe_failure(case, check, difference, value))


def _describe_failure(case: Case, check: PictureCheck, difference: PictureDifference, value: float) -> str:
    metric = METRICS[case.metric]
    if metric.allows(value, case.tolerance):
        return ""
    worst = _describe_worst_pixel(difference)
    if case.failing and case.metric in PER_PIXEL:
        if 100.0 * difference.failing <= case.failing:
            return ""
        share = (
            f"{format_number(100.0 * difference.failing)} % of the pixels are beyond {format_number(case.tolerance)}"
        )
        return f"{_name_layer(check)}{share} where {format_number(case.failing)} % may be{worst}"
    return f"{_name_layer(check)}{metric.describe(value, case.tolerance)}{worst}"


def _name_layer(check: PictureCheck) -> str:
    layer = f" '{check.layer}'" if check.layer else ""
    return f"{check.golden}{layer}: "


def _describe_worst_pixel(difference: PictureDifference) -> str:
    """The worst pixel in words."""
    if difference.worst is None:
        return ""
    actual, expected = (
        " ".join(format_number(part) for part in side) for side in (difference.actual, difference.expected)
    )
    broken = f"; {difference.broken} pixels are not finite on one side" if difference.broken else ""
    return f"; worst at {difference.worst[0]},{difference.worst[1]}: {actual} instead of {expected}{broken}"


def _rank(case: Case, check: PictureCheck) -> float:
    if check.value is None:
        return inf
    value = -check.value if METRICS[case.metric].least else check.value
    return inf if np.isnan(value) else value


def _join_names(parts: PictureParts) -> str:
    return ", ".join(name or "(unnamed)" for name in parts)
