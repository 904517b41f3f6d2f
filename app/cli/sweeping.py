"""What is typed for a sweep: `blur.sigma=1,2,4`, `glow=0..1/5`, `merge.mode=*`, `fill.color=1,0,0,1;0,0,1,1`."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from .options import override_value

if TYPE_CHECKING:
    from halation.nodes import Value

    from ..graph import Graph
    from ..renderer.jobs.sweep import Axis

_RANGE = re.compile(r"\s*(?P<first>[^.].*?)\.\.(?P<last>.+?)/(?P<count>[0-9]+)(?P<log>log)?\s*")
_MOST = 400


def axes(graph: Graph, sets: Sequence[str], frames: Sequence[int]) -> tuple[Graph, tuple[Axis, ...]]:
    """What is swept, rows before columns as they were typed, frames last; values that are given once are set.

    Raises UsageError.
    """
    from ..errors import UsageError
    from ..renderer.jobs.sweep import FRAME, Axis, SweepStep, choose_labels

    typed: dict[str, list[str]] = {}
    for item in sets:
        name, equals, text = item.partition("=")
        if not equals or not name or not text:
            raise UsageError(f"--set {item}: write --set NAME=VALUE,VALUE,...")
        typed.setdefault(name, []).append(text)
    steps: dict[str, tuple[str, ...]] = {}
    labels = {FRAME: FRAME}
    for name, texts in typed.items():
        value = _value(graph, name)
        labels[name] = (value.label or value.name) if value else name.rpartition(".")[2]
        steps[name] = tuple(dict.fromkeys(part for text in texts for part in _parts(name, text, value)))
        if len(steps[name]) == 1:
            graph = override_value(graph, name, steps.pop(name)[0])
    if len(frames) > 1:
        steps[FRAME] = tuple(map(str, frames))
    labels_used = choose_labels(tuple(steps), labels)

    def step(name: str, text: str) -> SweepStep:
        if name == FRAME and len(frames) > 1:
            return SweepStep(text, lambda graph: graph, int(text))
        override_value(graph, name, text)  # what cannot be set is refused before anything is rendered
        return SweepStep(text, lambda graph: override_value(graph, name, text))

    swept = (Axis(name, labels_used[name], tuple(step(name, text) for text in texts)) for name, texts in steps.items())
    return graph, tuple(swept)


def _value(graph: Graph, name: str) -> Value | None:
    """What a name stands for; None if for nothing, which is said when it is set."""
    from ..errors import GraphError
    from ..graph import Group, declared
    from ..graph.graph import control_value

    head, dot, rest = name.partition(".")
    try:
        if not dot:
            return control_value(graph, name) if name in graph.controls else None
        item = graph.node(head)
        if "." in rest:
            return _value(item.body(), rest) if isinstance(item, Group) else None
        return declared(item, rest, head)
    except GraphError:
        return None


def _parts(name: str, text: str, value: Value | None) -> Iterator[str]:
    """The settings in a text, each as `--set` has it."""
    from ..errors import UsageError

    if value is not None and text.strip() == "*":
        if value.type == "bool":
            yield from ("false", "true")
        elif value.choices:
            yield from value.choices
        else:
            raise UsageError(f"--set {name}=*: only choices and switches can be swept whole; list values or a range")
        return
    is_list = value is not None and value.type in ("color", "vector", "matrix", "curve", "ramp", "lights")
    plain = value is not None and value.type in ("float", "int", "bool", "choice")
    whole = text.startswith("=") or "@" in text or not plain
    for part in text.split(";"):
        for one in (part,) if whole or ";" in text else part.split(","):
            if not one.strip():
                raise UsageError(f"--set {name}={text}: there is nothing between two separators; leave one out")
            if value is not None and plain and (match := _RANGE.fullmatch(one)):
                yield from _range(name, match, value.type == "int")
            elif value is not None and is_list:
                yield _vector(name, text, one, value)
            else:
                yield one.strip()


def _vector(name: str, text: str, numbers: str, value: Value) -> str:
    """One list of numbers. Raises UsageError for several in a row."""
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


def _range(name: str, match: re.Match[str], whole: bool) -> Iterator[str]:
    """Numbers at even distances, or at even ratios. Raises UsageError."""
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
        part = place / (count - 1)
        number = first * (last / first) ** part if match["log"] else first + (last - first) * part
        yield str(round(number)) if whole else f"{float(f'{number:.4g}'):g}"
