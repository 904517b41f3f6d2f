"""Looks that tests export for games: one graph with controls of several kinds, and graphs that no game can draw."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

from halation.cli.program import run
from halation.export.shipped_files import read_shipped_text

SIZE = (96, 64)
SIZE_WORDS = ("--size", "96x64")
FRAMES = (1, 12)
HOSTILE = 'x"\n\tpass\n""" # \\ */ </remarks>'
"""A label that tries to end its text."""

LOOK: Mapping[str, Any] = {
    "nodes": {
        "glow": {"type": "bloom", "values": {"radius": 0.1}},
        "tone": {"type": "saturation", "values": {"saturation": 0.5}},
        "grain": {"type": "film_grain", "values": {"amount": 0.1}},
    },
    "links": {
        "glow.image": "light.out",
        "tone.image": "glow.out",
        "grain.image": "tone.out",
        "outputs.image": "grain.out",
    },
    "controls": {
        "stops": {"target": "light.stops", "label": "Brightness"},
        "glow": {"target": "glow.intensity", "label": HOSTILE, "doc": HOSTILE},
        "size": {"target": "glow.radius"},
        "color": {"target": "tone.saturation"},
    },
    "settings": {"frames": list(FRAMES)},
}
"""Parts of a graph for the fixture `graphs`; `size` changes passes."""

CHOICES: Mapping[str, Any] = {
    "nodes": {"mix": {"type": "merge"}, "paint": {"type": "constant"}},
    "links": {"mix.a": "paint.out", "mix.b": "light.out", "outputs.image": "mix.out"},
    "controls": {
        "stops": {"target": "light.stops"},
        "kind": {"target": "mix.mode"},
        "color": {"target": "paint.color"},
    },
}
"""The same for controls of other types: a number, a choice and a color."""


def write_look(folder: Path) -> Path:
    """The graph of the look, without a file for its picture."""
    graph = {
        "halation": 1,
        "inputs": {"beauty": {"type": "Image"}},
        "outputs": {"image": {"type": "Image"}},
        **LOOK,
        "nodes": {"light": {"type": "exposure"}, **LOOK["nodes"]},
        "links": {"light.image": "inputs.beauty", **LOOK["links"]},
    }
    (folder / "look.json").write_text(json.dumps(graph), encoding="utf-8")
    return folder / "look.json"


def export_look(folder: Path, kind: str) -> Path:
    """The folder that an engine gets."""
    assert run(["export", str(write_look(folder)), "--to", kind, "-o", str(folder / kind), *SIZE_WORDS]) == 0
    return folder / kind


def export(cli: Callable[..., Any], graph: Path, output: Path, kind: str) -> Path:
    """What the command writes, at the size of the pictures."""
    result = cli("export", graph, "--to", kind, "-o", output, *SIZE_WORDS)
    assert result.code == 0, result.err
    return output


def list_unfit_graphs(graphs: Callable[..., Path]) -> Iterator[tuple[Path, str]]:
    """Graphs that no game can draw, and words of the reason."""
    parts: dict[str, Any] = {
        "inputs": {"albedo": {"type": "Image", "file": "shot.exr", "layer": "Cool"}},
        "nodes": {"sum": {"type": "merge"}},
        "links": {"sum.a": "inputs.albedo", "sum.b": "light.out", "outputs.image": "sum.out"},
    }
    yield graphs("layers.json", **parts), "input 'albedo'"
    yield graphs("drawn.json", nodes={"ball": {"type": "scene"}}, links={"outputs.image": "ball.color"}), "draws meshes"
    yield graphs("aces.json", settings={"color": {"working": "ACEScg"}}), "working space"


def refuse_unfit_graphs(cli: Callable[..., Any], graphs: Callable[..., Path], output: Path, kind: str) -> None:
    """Assert that a kind refuses all of them with the reason, and writes nothing."""
    for graph, words in list_unfit_graphs(graphs):
        result = cli("export", graph, "--to", kind, "-o", output, "--size", "16x16")
        assert result.code == 3 and words in result.err and not output.exists(), result.err


def open_reader(folder: Path) -> Any:
    """The reader of packages in numpy, which is proved by its pixels, without a device."""
    reader = ModuleType("package_values")
    exec(compile(read_shipped_text("package_values.py.txt"), "package_values.py", "exec"), reader.__dict__)
    return reader.Package(folder)


def list_knobs(document: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The knobs of a package in their order, the frame last."""
    knobs = [knob for control in document["controls"] for knob in control["knobs"]]
    return [*knobs, {"name": "frame", "low": float(FRAMES[0]), "high": float(FRAMES[1])}]
