"""What the page of a type of nodes says beside its declaration, on the site and in the editor."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Any, cast

import msgspec
import numpy as np
from halation.nodes import Node, Reader, Value
from halation.presets import paths, sample

from ..errors import InputError
from ..graph import Graph, Port
from ..language.translation import translate, translate_plural
from ..resources.input_files import read_bytes
from ..resources.sandbox import UNRESTRICTED
from .examples import EXAMPLES
from .facts import format_value, plan_facts
from .program_words import PROGRAMS
from .specimen import NODE, show_on_sample

STEPS = 5
"""Pictures of a strip. Chosen by eye."""

_WHOLE_MILLISECONDS = 10.0
"""From here on times are written without a fraction: below, two digits are what repeats."""


def make_example(node: type[Node]) -> Graph:
    """The graph that shows a node on the sample, with values that change it."""
    graph = show_on_sample(node, sample())
    for name, value in EXAMPLES.get(node.id, {}).items():
        graph = graph.set(Port(NODE, name), value)
    return graph


def describe_example(node: type[Node]) -> str:
    """The values with which a node is shown, where they are not its defaults; names are between backticks."""
    parts = (
        translate("`{name}` at {value}", name=name, value=_write_value(value))
        for name, value in EXAMPLES.get(node.id, {}).items()
    )
    return ", ".join(parts)


def _write_value(value: object) -> str:
    """A value in a sentence; of named items how many there are."""
    if isinstance(value, Mapping):
        return translate_plural("{count} item", "{count} items", len(cast("Mapping[str, object]", value)))
    text = format_value(value)
    return f"({text})" if isinstance(value, tuple) else text


def find_main_value(node: type[Node]) -> Value | None:
    """The first value with a slider, None for a node without one."""
    sliders = (value for value in node.values.values() if value.type in ("float", "int") and not value.folded)
    return next((value for value in sliders if math.isfinite(value.low) and math.isfinite(value.high)), None)


def list_steps(value: Value) -> list[float]:
    """Numbers from the low to the high end of a slider: with equal ratios where it covers two powers of ten."""
    has_ratios = value.low > 0.0 and value.high >= 100.0 * value.low
    numbers = (np.geomspace if has_ratios else np.linspace)(value.low, value.high, STEPS).tolist()
    return [round(number) for number in numbers] if value.type == "int" else [float(f"{x:.3g}") for x in numbers]


def describe_cost(node: type[Node]) -> str:
    """How many passes a node takes in full HD with the values of its example, and the memory that they need."""
    facts = plan_facts(node, EXAMPLES.get(node.id, {}))
    count, (width, height) = len(facts["passes"]), facts["size"]
    textures = translate(
        "{mebibytes:.0f} MiB of textures at {width} x {height}",
        mebibytes=facts["peak_bytes"] / 2**20,
        width=width,
        height=height,
    )
    if count:
        passes = translate_plural("{count} pass", "{count} passes", count)
        if node.id in EXAMPLES:
            return translate("With these values {passes}, and {textures}.", passes=passes, textures=textures)
        return translate("At its defaults {passes}, and {textures}.", passes=passes, textures=textures)
    if "image" in node.inputs:
        return translate("At its defaults it leaves the picture as it is, and costs nothing.")
    if issubclass(node, Reader):
        return translate("No pass: the processor decodes the file, whose layers take {textures}.", textures=textures)
    return translate("No pass: the processor computes what it gives.")


def describe_time(seconds: float, device: str) -> str:
    """How long a node takes in full HD with the values of its example, on a device with this description."""
    milliseconds = 1e3 * seconds
    digits = f"{milliseconds:.0f}" if milliseconds >= _WHOLE_MILLISECONDS else f"{milliseconds:.2g}"
    return translate("It takes {milliseconds} ms with {device}.", milliseconds=digits, device=device)


def list_names(node: type[Node]) -> tuple[tuple[str, str], ...]:
    """Each program whose menus have the node, and its names there, which commas separate."""
    rows: list[tuple[str, str]] = []
    for program, words in PROGRAMS:
        names = [name for name, wanted in words.items() if node.id in wanted.partition(":")[0].split()]
        if names:
            rows.append((program, ", ".join(names)))
    return tuple(rows)


@cache
def find_users() -> Mapping[str, tuple[str, ...]]:
    """Type of node -> the presets of Halation that use it, also inside groups."""
    users: dict[str, list[str]] = {}
    for path in paths():
        for id in sorted(_read_types(path)):
            users.setdefault(id, []).append(path.stem)
    return {id: tuple(names) for id, names in users.items()}


def _read_types(path: Path) -> set[str]:
    """The types of the nodes of a preset, as its file names them. To load all presets takes twenty times as long."""
    try:
        return set(_list_types(msgspec.json.decode(read_bytes(path, sandbox=UNRESTRICTED))))
    except (InputError, msgspec.MsgspecError):  # a file that somebody has damaged
        return set()


def _list_types(body: object) -> Iterable[str]:
    """The types of the nodes of a graph, and those of the graphs of its groups."""
    nodes = cast("Mapping[str, Any]", body).get("nodes", {}) if isinstance(body, Mapping) else {}
    for item in nodes.values():
        if "graph" in item:
            yield from _list_types(item["graph"])
        elif isinstance(id := item.get("type"), str):
            yield id
