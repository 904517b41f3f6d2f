"""The page of a node: what it does, before and after, its values, what it costs, and presets that use it."""

from __future__ import annotations

import tempfile
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from site import addsitedir

import numpy as np
from halation.cli.gallery import render_display_frames, render_specimen
from halation.cli.manual import write_node_section
from halation.graph import Port
from halation.media.comparison.contact_sheet import make_sheet, write_sheet
from halation.nodes import Node, built_in_nodes
from halation.presets import sample
from halation.reference.node_page import (
    STEPS,
    describe_cost,
    describe_example,
    describe_time,
    find_main_value,
    list_names,
    list_steps,
    make_example,
)
from halation.reference.specimen import FULL_HD, NODE, drawable_outputs, sample_graph
from halation.renderer import Renderer, RenderRequest, open_device
from halation.renderer.bench import measure_graph
from halation.resources.sandbox import UNRESTRICTED

PHOTOGRAPH = Path(__file__).with_name("photograph.jpg")
"""A cup of coffee by Rachel Michetti, who has waived all rights (CC0), made smaller; scikit-image has it."""

BEFORE = {"": "pictures/nodes/sample.jpg", "_photograph": "pictures/nodes/photograph.jpg"}
"""The pictures that nodes are shown on, by how names of pictures of nodes end: a render, and a photograph."""

_BATCH = 24
"""Nodes that one process draws: a driver keeps its programs as long as the process lives."""

_STEP_WIDTH = 192
"""Pixels of the width of a picture of a strip, which is as wide as the text of a page. Chosen by eye."""


def write_node_page(
    node: type[Node], presets: Iterable[str], pictures: Collection[str], times: Mapping[str, str]
) -> str:
    """The Markdown of the page of a node."""
    _, summary, *rest = write_node_section(node)
    blocks = [f"# {node.title}", f"`{node.id}` in the menu {node.category}", summary]
    shown = describe_example(node)
    if shown:
        blocks.append(f"At its defaults it changes nothing. The pictures show {shown}:")
    for ending, before in BEFORE.items():
        if (picture := _name_picture(node, ending)) in pictures:
            words = shown.replace("`", "") if shown else "its defaults"
            after = f"![{node.title} with {words}](../{picture}){{ .half }}"
            blocks.append(f"![Before](../{before}){{ .half }} {after}" if "image" in node.inputs else after)
    value = find_main_value(node)
    if value and (strip := _name_picture(node, "_strip")) in pictures:
        numbers = ", ".join(f"{number:g}" for number in list_steps(value))
        blocks += [f"`{value.name}` at {numbers}:", f"![{value.name} at {numbers}](../{strip})"]
    blocks += rest
    if names := [f"| {program} | {words} |" for program, words in list_names(node)]:
        blocks += ["## In other programs", "\n".join(["| program | name |", "|---|---|", *names])]
    blocks += ["## What it costs", f"{describe_cost(node)} {times.get(node.id, '')}".strip()]
    if presets := list(presets):
        links = ", ".join(f"[{name}](../presets.md#{name})" for name in presets)
        blocks += ["## Presets that use it", links]
    return "\n\n".join(blocks) + "\n"


def illustrate_nodes() -> tuple[dict[str, bytes], dict[str, str]]:
    """Pictures of all nodes with their paths in the site, and the sentences about their times.

    One process after the other draws them, so that what the driver keeps is given back.
    """
    pictures: dict[str, bytes] = {}
    times: dict[str, str] = {}
    ids = list(built_in_nodes())
    batches = [ids[start : start + _BATCH] for start in range(0, len(ids), _BATCH)]
    # MkDocs takes the folder of its hooks out of sys.path again, so each process adds it.
    folder = (str(Path(__file__).parent),)
    with ProcessPoolExecutor(1, get_context("spawn"), addsitedir, folder, max_tasks_per_child=1) as process:
        for drawn, measured in process.map(_illustrate_batch, batches):
            pictures |= drawn
            times |= measured
    return pictures, times


def _illustrate_batch(ids: Sequence[str]) -> tuple[dict[str, bytes], dict[str, str]]:
    nodes = [built_in_nodes()[id] for id in ids]
    return dict(render_pictures(nodes)), measure_times(nodes)


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
    graph = make_example(node)
    pictures = {"": render_specimen(node, graph, renderer, sample())}
    if graph.inputs.keys() == {"beauty"}:
        photograph = {"beauty": str(PHOTOGRAPH)}
        pictures["_photograph"] = render_specimen(node, graph, renderer, sample(), photograph)
    if value := find_main_value(node):
        steps = {f"{x:g}": graph.set(Port(NODE, value.name), x) for x in list_steps(value)}
        strip = {text: render_specimen(node, step, renderer, sample()) for text, step in steps.items()}
        pictures["_strip"] = make_sheet(strip, STEPS, _STEP_WIDTH)
    return pictures


def measure_times(nodes: Iterable[type[Node]]) -> dict[str, str]:
    """How long each node takes at its defaults in full HD, by its type: a sentence with the device."""
    renderer = Renderer(open_device(sandbox=UNRESTRICTED), budget=0, sandbox=UNRESTRICTED)
    times: dict[str, str] = {}
    try:
        for node in filter(drawable_outputs, nodes):
            benchmark = measure_graph(renderer, make_example(node), RenderRequest(size=FULL_HD), (1,), 1, 1)
            seconds = sum(timing.median for timing in benchmark.passes if NODE in timing.nodes)
            if seconds:
                times[node.id] = describe_time(seconds, renderer.device.description)
    finally:
        renderer.close()
    return times


def _name_picture(node: type[Node], ending: str) -> str:
    return f"pictures/nodes/{node.id}{ending}.jpg"
