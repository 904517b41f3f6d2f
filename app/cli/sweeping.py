"""Parses the values of a sweep: `blur.sigma=1,2,4`, `glow=0..1/5`, `merge.mode=*`, `fill.color=1,0,0,1;0,0,1,1`."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from .options import override_value

if TYPE_CHECKING:
    from halation.nodes import Value

    from ..graph import Graph
    from ..renderer.jobs.sweep import SweepAxis

_RANGE = re.compile(r"\s*(?P<first>[^.].*?)\.\.(?P<last>.+?)/(?P<count>[0-9]+)(?P<log>log)?\s*")
_MOST = 400
"""Values of a range. Chosen by judgement: a sheet of 20 x 20 pictures."""


def parse_axes(graph: Graph, sets: Sequence[str], frames: Sequence[int]) -> tuple[Graph, tuple[SweepAxis, ...]]:
    """The axes of a sweep in the order of the command line, frames last; and the graph with all single values set.

    Raises UsageError.
    """
    from ..errors import UsageError
    from ..renderer.jobs.sweep import FRAME, SweepAxis, SweepStep, choose_labels

    texts_by_name: dict[str, list[str]] = {}
    for item in sets:
        name, equals, text = item.partition("=")
        if not equals or not name or not text:
            raise UsageError(f"--set {item}: write --set NAME=VALUE,VALUE,...")
        texts_by_name.setdefault(name, []).append(text)
    steps: dict[str, tuple[str, ...]] = {}
    labels = {FRAME: FRAME}
    for name, texts in texts_by_name.items():
        value = _find_value(graph, name)
        labels[name] = (value.label or value.name) if value else name.rpartition(".")[2]
        steps[name] = tuple(dict.fromkeys(part for text in texts for part in _split_settings(name, text, value)))
        if len(steps[name]) == 1:
            graph = override_value(graph, name, steps.pop(name)[0])
    if len(frames) > 1:
        steps[FRAME] = tuple(map(str, frames))
    axis_labels = choose_labels(tuple(steps), labels)

    def make_step(name: str, text: str) -> SweepStep:
        if name == FRAME and len(frames) > 1:
            return SweepStep(text, lambda graph: graph, int(text))
        override_value(graph, name, text)  # refuses invalid values before anything is rendered
        return SweepStep(text, lambda graph: override_value(graph, name, text))

    sweep_axes = (
        SweepAxis(name, axis_labels[name], tuple(make_step(name, text) for text in texts))
        for name, texts in steps.items()
    )
    return graph, tuple(sweep_axes)


def _find_value(graph: Graph, name: str) -> Value | None:
    """The value that a name stands for, or None; setting an unknown name raises an error later."""
    from ..errors import GraphError
    from ..graph import Group, Port
    from ..graph.graph import control_value, expand_socket

    head, dot, rest = name.partition(".")
    try:
        if not dot:
            return control_value(graph, name) if name in graph.controls else None
        item = graph.node(head)
        if isinstance(item, Group) and rest.partition(".")[0] in item.graph.nodes:
            return _find_value(item.body(), rest)
        return graph.declaration(Port(head, expand_socket(item, rest)))
    except GraphError:
        return None


def _split_settings(name: str, text: str, value: Value | None) -> Iterator[str]:
    """Split a text into the settings of a sweep, each as `render --set` takes it."""
    from ..errors import UsageError

    if value is not None and text.strip() == "*":
        if value.type == "bool":
            yield from ("false", "true")
        elif value.choices:
            yield from filter(None, value.choices) if value.listed_in else value.choices
        else:
            raise UsageError(f"--set {name}=*: * works only for choices and switches; list values or a range")
        return
    listed = ("color", "vector", "matrix", "curve", "ramp", "spline", "stroke", "point")
    has_numbers = value is not None and value.type in listed
    has_one_number = value is not None and value.type in ("float", "int", "bool", "choice")
    is_single = text.startswith("=") or "@" in text or not has_one_number
    for part in text.split(";"):
        for setting in (part,) if is_single or ";" in text else part.split(","):
            if not setting.strip():
                raise UsageError(f"--set {name}={text}: a value is missing between two separators")
            if value is not None and has_one_number and (match := _RANGE.fullmatch(setting)):
                yield from _expand_range(name, match, value.type == "int")
            elif value is not None and has_numbers:
                yield _check_vector(name, text, setting, value)
            else:
                yield setting.strip()


def _check_vector(name: str, text: str, numbers: str, value: Value) -> str:
    """Check that a text is one color, vector or matrix, not several in a row. Raises UsageError."""
    from ..errors import UsageError

    count = 4 if value.type == "color" else value.length
    given_count = numbers.strip().strip("[]").count(",") + 1
    if (
        value.type in ("color", "vector", "matrix")
        and given_count != count
        and "@" not in numbers
        and not numbers.startswith("=")
    ):
        raise UsageError(
            f"--set {name}={text}: a {value.type} is {count} numbers, and {given_count} are given; separate several of "
            f"them by ';' (in quotes), or repeat --set {name}=..."
        )
    return numbers.strip()


def _expand_range(name: str, match: re.Match[str], is_integer: bool) -> Iterator[str]:
    """The numbers of a range, at even distances or, with `log`, at even ratios. Raises UsageError."""
    from ..errors import UsageError

    count, text = int(match["count"]), match[0].strip()
    try:
        first, last = float(match["first"]), float(match["last"])
    except ValueError:
        raise UsageError(f"--set {name}={text}: a range is FIRST..LAST/COUNT, such as 1..8/4") from None
    if not 2 <= count <= _MOST or not math.isfinite(first) or not math.isfinite(last):
        raise UsageError(f"--set {name}={text}: a range is FIRST..LAST/COUNT of 2 to {_MOST} values")
    if match["log"] and not (first > 0.0 and last > 0.0):
        raise UsageError(f"--set {name}={text}: even ratios need numbers above 0; leave out 'log'")
    for place in range(count):
        fraction = place / (count - 1)
        number = first * (last / first) ** fraction if match["log"] else first + (last - first) * fraction
        yield str(round(number)) if is_integer else f"{float(f'{number:.4g}'):g}"
