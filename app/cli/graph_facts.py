"""What `halation info` says about a graph or a preset: what it takes, what can be changed, and what it gives."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..reference.facts import default_text, format_value, soft_range
from ..resources.sandbox import Sandbox
from .outcome import write_count

if TYPE_CHECKING:
    from ..graph import Graph, Input


def find_graph_facts(path: Path, sandbox: Sandbox) -> dict[str, Any]:
    """The description, inputs, controls, outputs and frames of a graph. Raises DocumentError."""
    from ..document import load
    from ..document.about import find_about
    from ..graph import Group

    graph = load(path, sandbox=sandbox)
    about = find_about(graph)
    return {
        "graph": str(path),
        "doc": about.doc,
        "tags": list(about.tags),
        "nodes": len(graph.nodes),
        "inputs": {name: _describe_input(graph, name, end) for name, end in graph.inputs.items()},
        "controls": {
            name: {
                "value": default_text(value),
                "range": ", ".join(filter(None, value.choices)) or soft_range(value),
                "unit": value.unit or "",
                "doc": value.doc,
                "target": str(graph.controls[name].target),
            }
            for name, value in Group(graph).signature.values.items()
        },
        "outputs": {name: {"type": str(end.kind), "view": end.view} for name, end in graph.outputs.items()},
        "frames": list(graph.settings.frames) if graph.settings.frames else None,
        "rate": float(graph.settings.rate),
    }


def format_graph_facts(facts: dict[str, Any]) -> str:
    """The facts as lines, in columns, with what to type."""
    lines = [f"{facts['graph']}: {facts['doc'] or 'a graph'}"]
    inputs = [[name, item["type"], item["source"], item["doc"]] for name, item in facts["inputs"].items()]
    controls = [
        [name, item["value"], " ".join(filter(None, (item["range"], item["unit"]))), item["doc"]]
        for name, item in facts["controls"].items()
    ]
    outputs = [[name, item["type"]] for name, item in facts["outputs"].items()]
    for title, rows in (
        ("inputs (-i NAME=FILE)", inputs),
        ("controls (--set NAME=VALUE)", controls),
        ("outputs", outputs),
    ):
        if rows:
            lines += ["", title, *_align(rows)]
    first, last = facts["frames"] or (1, 1)
    time = f", frames {first}-{last} at {facts['rate']:g} per second" if last > first else ""
    return "\n".join([*lines, "", f"{write_count(facts['nodes'], 'node')}{time}; halation explain shows its passes"])


def _describe_input(graph: Graph, name: str, end: Input) -> dict[str, str]:
    source = f"{end.layer} of {Path(end.file).name}" if end.layer else Path(end.file).name
    if not end.file:
        source = "" if end.default is None else format_value(end.default)
    return {"type": str(end.kind), "file": end.file, "layer": end.layer, "source": source, "doc": end.doc}


def _align(rows: list[list[str]]) -> list[str]:
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    return ["  " + "  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]
