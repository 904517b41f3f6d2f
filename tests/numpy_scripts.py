"""Graphs of one node with values at random, as scripts of numpy, and what a plain Python makes of these."""

from __future__ import annotations

import os
import subprocess
import sys
import traceback
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from exr_files import write_exr
from halation import document
from halation.export import ExportOrder
from halation.export.python.library import load_library
from halation.export.python.numbers import DERIVED
from halation.export.python.script import export_script
from halation.graph import Graph, Port
from halation.nodes import Kind, Node, Value, catalogue
from halation.renderer import Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED

WIDTH, HEIGHT = 37, 29
FOREIGN = ("halation", "moderngl", "msgspec", "cv2", "glfw")
"""Libraries that a script may not import, whether or not they are installed."""

PLAIN_PYTHON = f"""
import runpy, sys

FOREIGN = {FOREIGN!r}

class NoHalation:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] not in sys.stdlib_module_names | {{"numpy", "scipy", "OpenImageIO"}}:
            if name.partition(".")[0] in FOREIGN:
                raise ImportError(name + ": a script may import numpy, scipy and OpenImageIO only")

sys.meta_path.insert(0, NoHalation())
count = int(sys.argv[1])
options, pairs = sys.argv[2 : 2 + count], sys.argv[2 + count :]
for script, out in zip(pairs[::2], pairs[1::2]):
    sys.argv = [script, "-o", out, *options]
    runpy.run_path(script, run_name="__main__")
"""
"""A Python in which Halation and what it stands on cannot be imported. It runs pairs of scripts and outputs.

All have the same options, whose number comes first."""


def list_nodes() -> list[str]:
    """The nodes that have a function."""
    library = load_library()
    return [id for id in catalogue() if library.find_function(id)]


def has_pictures(id: str) -> bool:
    """True for a node that makes pictures; others make cameras, which other nodes read."""
    return any(not output.socket.kind.is_planned for output in catalogue()[id].outputs.values())


def write_pictures(folder: Path) -> Path:
    """Light from -0.1 to 5 with holes, half-covered pixels and glows; fields; and normals, some of them mixed."""
    random = np.random.default_rng(5)
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    layers: dict[str, np.ndarray] = {}
    for number in range(3):
        color = 0.5 + 0.5 * np.sin(x[..., None] * 0.3 + y[..., None] * (0.2 + 0.1 * number) + np.arange(3) * 1.7)
        color = color + 0.3 * random.random((HEIGHT, WIDTH, 3)) - 0.05
        color[random.random((HEIGHT, WIDTH)) > 0.97] *= 5.0
        alpha = np.where(x + 3 * number < 9, 0.0, np.where(y < 8, 0.25 + 0.5 * random.random((HEIGHT, WIDTH)), 1.0))
        glow = np.where((alpha == 0.0) & (y > 20), 0.3, alpha)
        layers[f"Image{number}"] = np.concatenate([color * glow[..., None], alpha[..., None]], axis=-1)
        layers[f"Field{number}"] = np.clip(0.6 + 0.6 * np.cos(x * 0.35 + number) * np.sin(y * 0.3), 0.0, 1.0)[..., None]
        vector = random.standard_normal((HEIGHT, WIDTH, 3))
        vector /= np.linalg.norm(vector, axis=-1, keepdims=True)
        vector[::5, number::4] *= 0.9  # as antialiasing shortens normals
        vector[:3, :5] = 0.0
        layers[f"Vector{number}"] = vector
    pixels = {name: layer.astype(np.float32) for name, layer in layers.items()}
    return write_exr(folder / "pictures.exr", pixels, dict.fromkeys(pixels, "float"))


def make_graph(file: Path, node: type[Node], values: dict[str, Any], linked: tuple[str, ...] = ()) -> dict[str, Any]:
    """A graph of one node whose inputs, but for optional ones that are not named, read layers of a file.

    A Number is the average light of one, and a camera one of the node of that name.
    """
    inputs: dict[str, Any] = {}
    links: dict[str, str] = {}
    nodes: dict[str, Any] = {"it": {"type": node.id, "values": values}}
    for number, (name, socket) in enumerate(node.inputs.items()):
        if socket.optional and name not in linked:
            continue
        if socket.kind is Kind.CAMERA:
            nodes[name] = {"type": "camera", "values": {"eye": [0.3, -3.0 - 0.2 * number, 0.7], "focal": 30.0 + number}}
            links[f"it.{name}"] = f"{name}.camera"
            continue
        if socket.kind is Kind.NUMBER:
            inputs["measured"] = {"type": "Image", "file": file.name, "layer": "Image2"}
            nodes["meter"] = {"type": "luminance_statistics"}
            links |= {"meter.image": "inputs.measured", f"it.{name}": "meter.average"}
            continue
        kind = {Kind.IMAGE: "Image", Kind.FIELD: "Field", Kind.VECTOR: "Vector"}[socket.kind]
        inputs[name] = {"type": kind, "file": file.name, "layer": f"{kind}{number % 3}"}
        if kind == "Vector" and socket.channels != 3:
            layer = "Image" if socket.channels == 4 else "Vector"
            inputs[name] |= {"type": f"Vector{socket.channels}", "layer": f"{layer}{number % 3}"}
        links[f"it.{name}"] = f"inputs.{name}"
    return {
        "halation": 1,
        "settings": {"size": [WIDTH, HEIGHT]},
        "inputs": inputs,
        "outputs": {},
        "nodes": nodes,
        "links": links,
    }


def choose_values(node: type[Node], random: np.random.Generator) -> dict[str, Any]:
    """Values at random in their soft ranges, as a graph file holds them; lengths are small, as the picture is.

    Corners stay convex: beside a horizon places lie 10,000 pixels away, where floats of 32 bits have hundredths.
    """
    function = load_library().definitions[node.id]
    known = {parameter.name: parameter for parameter in function.parameters}
    chosen: dict[str, Any] = {}
    for name, value in node.values.items():
        if name in known and known[name].choices:
            chosen[name] = known[name].choices[random.integers(len(known[name].choices))]
        elif name in known or (value.type == "choice" and name in DERIVED.get(node.id, ((),))[0]):
            chosen[name] = choose_value(value, random)
            if node.id == "corner_pin" and value.type == "vector":
                place: Any = value.default
                chosen[name] = [at + 0.4 * (part - 0.5) for at, part in zip(place, chosen[name], strict=True)]
    return {name: value for name, value in chosen.items() if value is not None}


def find_choices(id: str) -> dict[str, tuple[str, ...]]:
    """All choices that a function knows, or else those of its node, by the name of their value."""
    values, parameters = catalogue()[id].values, load_library().definitions[id].parameters
    known = [each for each in parameters if each.name in values]
    choices = {each.name: (*map(str, each.choices or values[each.name].choices),) for each in known}
    return {name: words for name, words in choices.items() if words}


def choose_value(value: Value, random: np.random.Generator) -> Any:
    """One value at random."""
    low = max(value.low, -4.0)
    high = max(min(value.high, 12.0), min(low * 4.0, value.high))
    if value.unit in ("deg", "K"):
        low, high = value.low, value.high
    match value.type:
        case "float":
            return float(random.uniform(low, high))
        case "int":
            return int(random.integers(int(low), int(high) + 1))
        case "bool":
            return bool(random.random() < 0.5)
        case "choice":
            return str(random.choice(value.choices))
        case "color":
            return [*random.uniform(0.05, 1.2, 3).tolist(), 1.0]
        case "vector":
            return random.uniform(max(low, -2.0), min(high, 8.0), value.length).tolist()
        case "curve":
            ends = max(value.low, 0.0), min(value.high, 1.0)
            return [part for x in (0.0, 0.3, 0.7, 1.0) for part in (x, float(random.uniform(*ends)))]
        case _:
            return None


def render_outputs(graph: Graph, renderer: Renderer, names: list[str]) -> dict[str, np.ndarray]:
    """What the renderer makes of the outputs of the node, with 32 bits."""
    targets = {name: Port("it", name) for name in names}
    return renderer.render(graph, RenderRequest({}, targets, precision="float"))


def export_output(graph: Graph, name: str, path: Path, node: str = "it") -> str:
    """Export an output of the node as a script, and return its text."""
    order = ExportOrder(graph, path.stem, Port(node, name), UNRESTRICTED, lambda: None, path)  # pyright: ignore
    export_script(order)
    return path.read_text("utf-8")


def run_scripts(pairs: list[tuple[Path, Path]], is_fresh: bool = True, options: Sequence[str] = ()) -> None:
    """Run scripts in a process of a plain Python.

    One that is not fresh is a copy of this process, where the system has copies: numpy, scipy and OpenImageIO, which
    take half a second to start, are there, and Halation cannot be imported either.
    """
    words = [str(len(options)), *options, *(str(path) for pair in pairs for path in pair)]
    if is_fresh or sys.platform != "linux":
        subprocess.run([sys.executable, "-c", PLAIN_PYTHON, *words], check=True, timeout=600)
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of threads: the copy draws nothing
        number = os.fork()
    if number:
        assert os.waitstatus_to_exitcode(os.waitpid(number, 0)[1]) == 0, "a script has failed: see above"
        return
    code = 1
    try:
        sys.argv = ["-c", *words]
        for name in [name for name in sys.modules if name.partition(".")[0] in FOREIGN]:
            del sys.modules[name]
        exec(PLAIN_PYTHON, {})
        code = 0
    except BaseException:
        traceback.print_exc()
    finally:
        os._exit(code)


def load_graph(path: Path, tree: dict[str, Any]) -> Graph:
    """A graph of a tree, saved beside its pictures."""
    import json

    path.write_text(json.dumps(tree))
    return document.load(path, sandbox=UNRESTRICTED)


def measure(ours: np.ndarray, theirs: np.ndarray) -> np.ndarray:
    """Differences, relative for light above 1."""
    theirs = np.broadcast_to(theirs, ours.shape)
    return np.abs(theirs - ours) / np.maximum(1.0, np.abs(ours))


def compare_outputs(renderer: Renderer, folder: Path, made: dict, share: float = 0.0) -> None:
    """All outputs of a graph of one node, within 1e-3 of the renderer.

    But for a share: at the corners of a cube three faces are equally near, and rounding decides.
    """
    graph = load_graph(folder / "it.json", made)
    item = graph.nodes["it"]
    assert isinstance(item, Node)
    pictures = render_outputs(graph, renderer, list(item.outputs))
    for name, ours in pictures.items():
        script = folder / f"{name}.py"
        export_output(graph, name, script)
        run_scripts([(script, script.with_suffix(".npy"))], is_fresh=False)
        errors = measure(ours, np.load(script.with_suffix(".npy")))
        assert (errors > 1e-3).mean() <= share and errors.max() < 0.02, (
            f"{name}: {errors.max()}, {(errors > 1e-3).mean()} of all"
        )
