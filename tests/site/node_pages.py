"""The page of a node: what it does, before and after, its values, what it costs, and presets that use it."""

from __future__ import annotations

import tempfile
from collections.abc import Collection, Iterable, Iterator
from pathlib import Path

from halation import document
from halation.cli.facts import plan_facts
from halation.cli.gallery import render_display_frames, render_node
from halation.cli.manual import write_node_section
from halation.cli.specimen import drawable_outputs, sample_graph
from halation.graph import Graph
from halation.graph.graph import Group
from halation.media.comparison.contact_sheet import write_sheet
from halation.nodes import Node
from halation.presets import paths, sample
from halation.renderer import Renderer, open_device
from halation.resources.sandbox import UNRESTRICTED

BEFORE = "pictures/nodes/sample.jpg"
"""The picture that nodes are shown on."""


def write_node_page(node: type[Node], presets: Iterable[str], pictures: Collection[str]) -> str:
    """The Markdown of the page of a node."""
    _, summary, *rest = write_node_section(node)
    blocks = [f"# {node.title}", f"`{node.id}` in the menu {node.category}", summary]
    picture = _name_picture(node)
    if picture in pictures:
        before = f"![The sample before](../{BEFORE}){{ .half }} "
        after = f"![{node.title} at its defaults](../{picture}){{ .half }}"
        blocks.append(before + after if "image" in node.inputs else after)
    blocks += rest
    blocks += ["## What it costs", _describe_cost(node)]
    if presets := list(presets):
        links = ", ".join(f"[{name}](../presets.md#{name})" for name in presets)
        blocks += ["## Presets that use it", links]
    return "\n\n".join(blocks) + "\n"


def _describe_cost(node: type[Node]) -> str:
    """How many passes a node takes at its defaults, and the memory that they need."""
    facts = plan_facts(node)
    count = len(facts["passes"])
    if not count:
        return "It draws nothing itself."
    width, height = facts["size"]
    passes = "1 pass" if count == 1 else f"{count} passes"
    return f"At its defaults {passes}, and {facts['peak_bytes'] / 2**20:.0f} MiB of textures at {width} x {height}."


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
    """Pictures of the sample and of each node at its defaults on it, as JPEG with their paths in the site."""
    renderer = Renderer(open_device(sandbox=UNRESTRICTED), sandbox=UNRESTRICTED)
    try:
        with tempfile.TemporaryDirectory() as name:
            file = Path(name, "picture.jpg")
            (before,) = render_display_frames(sample_graph(sample()), renderer, (1,)).values()
            write_sheet(file, before, sandbox=UNRESTRICTED)
            yield BEFORE, file.read_bytes()
            for node in nodes:
                if drawable_outputs(node):
                    write_sheet(file, render_node(node, renderer, sample()), node.title, sandbox=UNRESTRICTED)
                    yield _name_picture(node), file.read_bytes()
    finally:
        renderer.close()


def _name_picture(node: type[Node]) -> str:
    return f"pictures/nodes/{node.id}.jpg"
