"""Fits a graph to a reference: a small proxy first, then the full size."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from math import sqrt
from typing import Literal

from msgspec import Struct

from ..errors import UsageError
from ..media.comparison.metrics import Array
from ..media.pictures.thumbnail import resize_by_area
from .evolution import evolve
from .least_squares import descend
from .likeness import LookLikeness, PixelLikeness
from .results import FitResult, describe_result
from .search import BudgetSpent, FitMeter, FitSearch
from .search_space import SearchSpace
from .shown_output import ShownOutput

_ROUGHER = 10.0
"""How much earlier the descent at full size ends than the one by the proxy, which has found the place already: each
step takes a render for each value. Chosen by judgement: with half and twice as much a blur and an exposure are found
with the same 29 renders."""

_SAME_ASPECT = 0.02
"""How much the aspect of the reference may differ: sides of a small picture are rounded to whole pixels, 1 of 50."""

Comparison = Literal["pixels", "look"]

_PROXY = 192
"""The longer side of a proxy in pixels. Chosen by judgement: wide blurs and grain can still be told apart, and a
frame of 1920x1080 is 100 times as large. With half and twice as much a blur and an exposure are found too."""

_LARGEST_PROXY = 0.7
"""The scale from which on a proxy is not worth its own search."""

_PROXY_SHARE, _SEARCH_SHARE = 0.65, 0.9
"""Up to where the budget goes to the proxy, and to the search as a whole. The rest is for the slopes at the end."""

_TOLERANCE = 1e-4
"""The share of the squared error by which a step must improve it. Chosen by measurement: what is left then, rounding to
8 bits hides."""

_MOST_EVOLVED = 12
"""Numbers that are looked for by evolution, at most: with more it takes thousands of renders."""

_ARRIVED = 0.1
"""The share of the first error below which a descent has arrived. Else it may lie in a wrong valley."""


class FitTask(Struct, frozen=True):
    """What is fitted, the reference as light [h, w, 3], how it is compared, and how much it may take."""

    space: SearchSpace
    output: ShownOutput
    reference: Array
    comparison: Comparison
    seconds: float
    renders: int


def fit_values(
    task: FitTask,
    should_stop: Callable[[], bool] = lambda: False,
    report: Callable[[FitMeter], None] = lambda meter: None,
) -> FitResult:
    """Find values that make the picture like the reference, at full size never less like it than before.

    `should_stop` is asked before each render: then the best values so far are the result. Raises UsageError for a
    reference that cannot be compared, and the errors of rendering.
    """
    if not task.space.numbers:
        raise UsageError("there is nothing to fit: name values, such as --values grade.*")
    meter = FitMeter(task.seconds, task.renders, should_stop, report)
    meter.count += 1
    before = task.output.render(task.space.graph, 1.0)
    scale = _find_full_scale(before, task)
    if scale < 1.0:
        meter.count += 1
        before = task.output.render(task.space.graph, scale)
    full, reference = _start_search(task, meter, scale, before, _SEARCH_SHARE)
    start_error = full.best_error
    slopes = _search(task, meter, full, _PROXY / max(before.shape[:2]))
    point = task.space.round(full.best_point)
    after = task.output.render(task.space.graph_at(point), scale)
    pictures, errors = (before, after, reference), (start_error, full.rate(after))
    return describe_result(task.space, point, slopes, pictures, errors, task.comparison == "pixels", meter)


def _search(task: FitTask, meter: FitMeter, full: FitSearch, shrink: float) -> Array | None:
    """Look for better values by the proxy, then at full size; return the slopes of the picture at the best point."""
    proxy = full
    if shrink < _LARGEST_PROXY:
        meter.count += 1
        picture = task.output.render(task.space.graph, full.scale * shrink)
        proxy, _ = _start_search(task, meter, full.scale * shrink, picture, _PROXY_SHARE)
    _run(meter, lambda: _improve(proxy, task.space.start))
    if proxy is not full:
        full.measure(proxy.best_point, is_last=True)
        if not meter.is_spent:
            _run(meter, lambda: descend(full, proxy.best_point, _ROUGHER * _TOLERANCE))
    proxy.share = 1.0
    with suppress(BudgetSpent):
        return proxy.measure_central_slopes(full.best_point)
    return proxy.slopes if full.slopes is None else full.slopes


def _run(meter: FitMeter, work: Callable[[], None]) -> None:
    try:
        work()
    except BudgetSpent:
        meter.note_end()


def _improve(search: FitSearch, start: Array) -> None:
    """Descend, and if that ends far from the reference, try by evolution and descend again."""
    first_error = search.best_error
    descend(search, start, _TOLERANCE)
    has_whole = bool(search.space.whole.any())
    if len(search.space.numbers) <= _MOST_EVOLVED and (has_whole or search.best_error > _ARRIVED * first_error):
        evolve(search, search.best_point)
        descend(search, search.best_point, _TOLERANCE)


def _start_search(
    task: FitTask, meter: FitMeter, scale: float, picture: Array, share: float
) -> tuple[FitSearch, Array]:
    """A search at a scale, and the reference in the size of its pictures. `picture` is that of the graph as it is."""
    reference = _match_size(task.reference, picture, task.comparison)
    likeness = PixelLikeness(reference) if task.comparison == "pixels" else LookLikeness(reference)
    return FitSearch(task.space, task.output, likeness, scale, meter, share, likeness.measure(picture)), reference


def _find_full_scale(picture: Array, task: FitTask) -> float:
    """The scale at which a picture is as large as the reference, at most 1."""
    (height, width), (wanted_height, wanted_width) = picture.shape[:2], task.reference.shape[:2]
    if task.comparison == "look":
        return min(1.0, sqrt(wanted_height * wanted_width / (height * width)))
    if abs(wanted_width / wanted_height * height / width - 1.0) > _SAME_ASPECT:
        raise UsageError(
            f"the reference is {wanted_width}x{wanted_height}, and the picture {width}x{height}: to compare pixel by "
            "pixel both must show the same frame; for the look of another picture add --by look"
        )
    return min(1.0, wanted_width / width)


def _match_size(reference: Array, picture: Array, comparison: Comparison) -> Array:
    """The reference in the size of the picture; for a look in its own shape, with at most as many pixels."""
    height, width = picture.shape[:2]
    if comparison == "look":
        shrink = min(1.0, sqrt(height * width / (reference.shape[0] * reference.shape[1])))
        height, width = (max(1, round(side * shrink)) for side in reference.shape[:2])
    return reference if reference.shape[:2] == (height, width) else resize_by_area(reference, width, height)
