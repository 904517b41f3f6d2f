"""The page of a node: what it does, before and after, its values, what it costs, and presets that use it."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path
from typing import cast

import numpy as np
from halation import document
from halation.cli.facts import format_value, plan_facts
from halation.cli.gallery import render_display_frames, render_specimen
from halation.cli.manual import write_node_section
from halation.cli.outcome import write_count
from halation.cli.specimen import FULL_HD, NODE, drawable_outputs, sample_graph, show_on_sample
from halation.graph import Graph, Port
from halation.graph.graph import Group
from halation.media.comparison.contact_sheet import make_sheet, write_sheet
from halation.nodes import Node, Reader, Value
from halation.presets import paths, sample
from halation.renderer import Renderer, RenderRequest, open_device
from halation.renderer.bench import measure_graph
from halation.resources.sandbox import UNRESTRICTED
from menu_words import PROGRAMS
from node_examples import EXAMPLES

PHOTOGRAPH = Path(__file__).with_name("photograph.jpg")
"""A cup of coffee by Rachel Michetti, who has waived all rights (CC0), made smaller; scikit-image has it."""

BEFORE = {"": "pictures/nodes/sample.jpg", "_photograph": "pictures/nodes/photograph.jpg"}
"""The pictures that nodes are shown on, by how names of pictures of nodes end: a render, and a photograph."""

_STEPS, _STEP_WIDTH = 5, 192
"""Pictures of a strip, and pixels of the width of each: a strip is as wide as the text of a page. Chosen by eye."""


def write_node_page(
    node: type[Node], presets: Iterable[str], pictures: Collection[str], times: Mapping[str, str]
) -> str:
    """The Markdown of the page of a node."""
    _, summary, *rest = write_node_section(node)
    blocks = [f"# {node.title}", f"`{node.id}` in the menu {node.category}", summary]
    shown = _describe_example(node)
    if shown:
        blocks.append(f"At its defaults it changes nothing. The pictures show {shown}:")
    for ending, before in BEFORE.items():
        if (picture := _name_picture(node, ending)) in pictures:
            words = shown.replace("`", "") if shown else "its defaults"
            after = f"![{node.title} with {words}](../{picture}){{ .half }}"
            blocks.append(f"![Before](../{before}){{ .half }} {after}" if "image" in node.inputs else after)
    value = _find_main_value(node)
    if value and (strip := _name_picture(node, "_strip")) in pictures:
        numbers = ", ".join(f"{number:g}" for number in _list_steps(value))
        blocks += [f"`{value.name}` at {numbers}:", f"![{value.name} at {numbers}](../{strip})"]
    blocks += rest
    if names := _list_names(node):
        blocks += ["## In other programs", "\n".join(["| program | name |", "|---|---|", *names])]
    blocks += ["## What it costs", f"{_describe_cost(node)} {times.get(node.id, '')}".strip()]
    if presets := list(presets):
        links = ", ".join(f"[{name}](../presets.md#{name})" for name in presets)
        blocks += ["## Presets that use it", links]
    return "\n\n".join(blocks) + "\n"


def _describe_example(node: type[Node]) -> str:
    """The values with which its pictures are made, where they are not its defaults."""
    return " and ".join(f"`{name}` at {_write_value(value)}" for name, value in EXAMPLES.get(node.id, {}).items())


def _write_value(value: object) -> str:
    """A value in a sentence; of named items how many there are."""
    if isinstance(value, Mapping):
        return write_count(len(cast("Mapping[str, object]", value)), "item")
    text = format_value(value)
    return f"({text})" if isinstance(value, tuple) else text


def _make_example(node: type[Node]) -> Graph:
    """The graph that shows a node on the sample, with values that change it."""
    graph = show_on_sample(node, sample())
    for name, value in EXAMPLES.get(node.id, {}).items():
        graph = graph.set(Port(NODE, name), value)
    return graph


def _list_names(node: type[Node]) -> list[str]:
    """A row for each program whose menus have the node, with its names there."""
    rows: list[str] = []
    for program, words in PROGRAMS:
        names = [name for name, wanted in words.items() if node.id in wanted.partition(":")[0].split()]
        if names:
            rows.append(f"| {program} | {', '.join(names)} |")
    return rows


def _find_main_value(node: type[Node]) -> Value | None:
    """The first value with a slider."""
    sliders = (value for value in node.values.values() if value.type in ("float", "int") and not value.folded)
    return next((value for value in sliders if math.isfinite(value.low) and math.isfinite(value.high)), None)


def _list_steps(value: Value) -> list[float]:
    """Numbers from the low to the high end of a slider: with equal ratios where it covers two powers of ten."""
    has_ratios = value.low > 0.0 and value.high >= 100.0 * value.low
    numbers = (np.geomspace if has_ratios else np.linspace)(value.low, value.high, _STEPS).tolist()
    return [round(number) for number in numbers] if value.type == "int" else [float(f"{x:.3g}") for x in numbers]


def _describe_cost(node: type[Node]) -> str:
    """How many passes a node takes at its defaults, and the memory that they need."""
    facts = plan_facts(node, EXAMPLES.get(node.id, {}))
    count = len(facts["passes"])
    width, height = facts["size"]
    textures = f"{facts['peak_bytes'] / 2**20:.0f} MiB of textures at {width} x {height}"
    if count:
        passes = "1 pass" if count == 1 else f"{count} passes"
        return f"{'With these values' if node.id in EXAMPLES else 'At its defaults'} {passes}, and {textures}."
    if "image" in node.inputs:
        return "At its defaults it leaves the picture as it is, and costs nothing."
    if issubclass(node, Reader):
        return f"No pass: the processor decodes the file, whose layers take {textures}."
    return "No pass: the processor computes what it gives."


def find_users() -> dict[str, list[str]]:
    """Type of node -> the presets that use it, also inside groups."""
    users: dict[str, list[str]] = {}
    for path in paths():
        for id in sorted(_list_types(document.load(path, sandbox=UNRESTRICTED))):
            users.setdefault(id, []).append(path.stem)
    return users


def _list_types(graph: Graph) -> set[str]:
    """The types of the nodes of a graph and its groups."""
    bodies = [item.graph for item in graph.nodes.values() if isinstance(item, Group)]
    types = {item.id for item in graph.nodes.values() if isinstance(item, Node)}
    return types.union(*map(_list_types, bodies))


def render_pictures(nodes: Iterable[type[Node]]) -> Iterator[tuple[str, bytes]]:
    """Pictures of nodes as JPEG with their paths in the site: on the sample, on a photograph, and as a strip."""
    renderer = Renderer(open_device(sandbox=UNRESTRICTED), sandbox=UNRESTRICTED)
    try:
        with tempfile.TemporaryDirectory() as name:
            file = Path(name, "picture.jpg")
            (before,) = render_display_frames(sample_graph(sample()), renderer, (1,)).values()
            write_sheet(file, before, sandbox=UNRESTRICTED)
            yield BEFORE[""], file.read_bytes()
            yield BEFORE["_photograph"], PHOTOGRAPH.read_bytes()
            for node in nodes:
                if not drawable_outputs(node):
                    continue
                for ending, light in _render_node(node, renderer).items():
                    write_sheet(file, light, node.title, sandbox=UNRESTRICTED)
                    yield _name_picture(node, ending), file.read_bytes()
    finally:
        renderer.close()


def _render_node(node: type[Node], renderer: Renderer) -> dict[str, np.ndarray]:
    """The pictures of a node by how their names end. A photograph has no other layers."""
    graph = _make_example(node)
    pictures = {"": render_specimen(node, graph, renderer, sample())}
    if graph.inputs.keys() == {"beauty"}:
        photograph = {"beauty": str(PHOTOGRAPH)}
        pictures["_photograph"] = render_specimen(node, graph, renderer, sample(), photograph)
    if value := _find_main_value(node):
        steps = {f"{x:g}": graph.set(Port(NODE, value.name), x) for x in _list_steps(value)}
        strip = {text: render_specimen(node, step, renderer, sample()) for text, step in steps.items()}
        pictures["_strip"] = make_sheet(strip, _STEPS, _STEP_WIDTH)
    return pictures


def measure_times(nodes: Iterable[type[Node]]) -> dict[str, str]:
    """How long each node takes at its defaults in full HD, by its type: a sentence with the device."""
    renderer = Renderer(open_device(sandbox=UNRESTRICTED), budget=0, sandbox=UNRESTRICTED)
    times: dict[str, str] = {}
    try:
        for node in filter(drawable_outputs, nodes):
            benchmark = measure_graph(renderer, _make_example(node), RenderRequest(size=FULL_HD), (1,), 1, 1)
            seconds = sum(timing.median for timing in benchmark.passes if NODE in timing.nodes)
            if seconds:
                times[node.id] = f"It takes {1e3 * seconds:.0f} ms with {renderer.device.description}."
    finally:
        renderer.close()
    return times


def _name_picture(node: type[Node], ending: str) -> str:
    return f"pictures/nodes/{node.id}{ending}.jpg"
