"""halation export --to python: nodes that read other frames or remember them, against the renderer."""

from __future__ import annotations

import json
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from exr_files import write_exr
from halation import document
from halation.errors import GraphError
from halation.export import ExportOrder
from halation.export.python.script import export_script
from halation.graph import OUTPUTS, Graph, Port
from halation.nodes import Node, Temporal, catalogue
from halation.presets import paths
from halation.renderer import FrameRenderer, Renderer, RenderRequest, open_device
from halation.resources.sandbox import UNRESTRICTED
from numpy_scripts import choose_values, export_output, list_nodes, load_graph, make_graph, run_scripts
from selection import list_cases

FRAMES = (1, 6)
SIZE = (37, 29)
NODES = [
    id
    for id in list_nodes()
    if id != "camera_velocity" and (issubclass(catalogue()[id], Temporal) or catalogue()[id].times is not Node.times)
]


@pytest.fixture(scope="module")
def renderer():
    return Renderer(open_device(sandbox=UNRESTRICTED), sandbox=UNRESTRICTED)


def write_shot(folder: Path) -> Path:
    """Noisy light over moving waves; depths, motion and normals of a plane, and of a disc that moves before it."""
    y, x = np.mgrid[: SIZE[1], : SIZE[0]]
    for frame in range(FRAMES[0], FRAMES[1] + 1):
        random, layers = np.random.default_rng(frame), dict[str, np.ndarray]()
        disc = (x - 8 - 3 * frame) ** 2 + (y - 14) ** 2 < 60
        for number in range(3):
            wave = 0.5 + 0.5 * np.sin(0.3 * x[..., None] + (0.2 + number) * y[..., None] + frame + np.arange(3))
            light = wave * random.gamma(2.0, 0.5, (*x.shape, 3)) * np.where(disc, 4.0, 1.0)[..., None]
            alpha = np.where(x + 3 * number < 9, 0.0, np.where(y < 8, random.random(x.shape), 1.0))
            layers[f"Image{number}"] = np.dstack([light * alpha[..., None], alpha])
            layers[f"Field{number}"] = np.where(disc, 2.0, np.where(y < 4, 1e10, 5.0 + 0.05 * y))[..., None]
            normal = np.where(disc[..., None], [0.0, 0.0, 1.0], [0.0, 0.6, 0.8])
            layers[f"Vector{number}"] = np.where(y[..., None] < 4, 0.0, normal)
        layers["Motion"] = np.where(disc[..., None], [3.0, 0.0, 3.0, 0.0], [0.0, 0.4, 0.0, 0.4])
        pixels = {name: layer.astype(np.float32) for name, layer in layers.items()}
        write_exr(folder / f"shot.{frame:04}.exr", pixels, dict.fromkeys(pixels, "float"))
    return folder / "shot.####.exr"


@pytest.fixture(scope="module")
def shot(tmp_path_factory) -> Path:
    return write_shot(tmp_path_factory.mktemp("shot"))


def make_shot_graph(shot: Path, id: str, values: dict[str, Any], linked: tuple[str, ...] = ()) -> dict[str, Any]:
    graph = make_graph(shot, catalogue()[id], values, linked)
    graph["settings"] |= {"frames": list(FRAMES), "rate": 12.0}
    for name, given in graph["inputs"].items():
        given["file"] = str(shot)
        given["layer"] = "Motion" if name == "velocity" else given["layer"]
    return graph


def render_frames(
    renderer: Renderer, graph: Graph, port: Port, frames: range, size: tuple[int, int] | None = None
) -> list[np.ndarray]:
    frame_renderer = FrameRenderer(renderer, graph, RenderRequest({}, {"out": port}, size, precision="float"))
    try:
        return [frame_renderer.render_frame(frame)["out"].copy() for frame in frames]
    finally:
        frame_renderer.close()


def compare_frames(renderer: Renderer, graph: Graph, folder: Path, port: Port) -> str:
    """The script of a port, whose pictures at all frames are those of the renderer within 1e-3."""
    script, made = folder / f"{port.socket}.py", folder / f"{port.socket}.####.npy"
    text = export_output(graph, port.socket, script, port.node)
    frames = range(FRAMES[0], FRAMES[1] + 1)
    run_scripts([(script, made)], is_fresh=False, options=("--frames", *map(str, FRAMES)))
    for frame, ours in zip(frames, render_frames(renderer, graph, port, frames), strict=True):
        theirs = np.broadcast_to(np.load(folder / f"{port.socket}.{frame:04}.npy"), ours.shape)
        errors = np.abs(theirs - ours) / np.maximum(1.0, np.abs(ours))
        assert errors.max() <= 1e-3, f"{port} at {frame}: {errors.max()}, {(errors > 1e-3).mean()} of all"
    run_scripts([(script, folder / "alone.npy")], is_fresh=False, options=("--frame", str(FRAMES[1])))
    np.testing.assert_array_equal(np.load(folder / "alone.npy"), np.load(folder / f"{port.socket}.{FRAMES[1]:04}.npy"))
    return text


@pytest.mark.parametrize("turn", list_cases((0, 1), ((2,), (3,), (4,))))
@pytest.mark.parametrize("id", NODES)
def test_frames_are_those_of_the_node(renderer, shot: Path, tmp_path: Path, id: str, turn: int) -> None:
    """All outputs at each of six frames, at the defaults and at values at random; odd turns link all inputs."""
    node = catalogue()[id]
    values = choose_values(node, np.random.default_rng((turn, zlib.crc32(id.encode())))) if turn else {}
    linked = tuple(name for name, socket in node.inputs.items() if socket.optional) if turn % 2 else ()
    if id in ("freeze", "time_offset", "time_speed"):
        linked = ("image", "field", "vector")
    made = make_shot_graph(shot, id, values, linked)
    graph = load_graph(tmp_path / "graph.json", made)
    for name in node.outputs:
        compare_frames(renderer, graph, tmp_path, Port("it", name))


MODES = {
    "echo": ({"mode": mode, "spacing": -1} for mode in ("brightest", "add", "screen", "average", "behind", "in front")),
    "feedback": (
        {"mode": mode, "edge": edge, "scale": scale, "position": [9.3, -5.2]}
        for mode, edge, scale in (
            ("brightest", "black", 1.1),
            ("add", "mirror", 0.8),
            ("screen", "wrap", 1.02),
            ("over", "clamp", 0.3),
            ("mix", "reflect", 1.0),
        )
    ),
    "frame_average": (
        {"weights": weights, "frames": frames, "window": window}
        for weights, frames, window in (
            ("box", 4, "centered"),
            ("tent", 5, "centered"),
            ("gaussian", 2, "centered"),
            ("exponential", 4, "trailing"),
        )
    ),
    "frame_blend": ({"mode": mode} for mode in ("time", "persistence")),
    "freeze": ({"frame": 3}, {"frame": 2, "every": 2}),
    "light_trails": ({"fade": "never"}, {"threshold": 0.0, "time": 0.05}),
    "time_speed": ({"speed": -0.5, "pivot": 4, "between": "blend"}, {"mode": "source", "source": 3.6}),
    "eye_adaptation": ({"model": "natural"}, {"scale": "light"}, {"minimum": -1.0, "maximum": 0.5}),
    "temporal_aa": ({"kernel": "catmull-rom", "weigh_light": False}, {"gamma": 3.0, "share": 0.4}),
    "temporal_accumulation": ({"gamma": 0.0}, {"frames": 2, "angle": 5.0}),
}


@pytest.mark.parametrize(("id", "values"), [(id, values) for id, each in MODES.items() for values in each], ids=str)
def test_each_mode_is_that_of_the_node(renderer, shot: Path, tmp_path: Path, id: str, values: dict[str, Any]) -> None:
    linked = ("image",) if id in ("freeze", "time_speed") else ("depth", "normal") if id.startswith("temporal") else ()
    graph = load_graph(tmp_path / "graph.json", make_shot_graph(shot, id, values, linked))
    compare_frames(renderer, graph, tmp_path, Port("it", "out"))


def make_chain(shot: Path, nodes: dict[str, Any], links: dict[str, str], **more: Any) -> dict[str, Any]:
    settings = {"size": list(SIZE), "frames": list(FRAMES)} | more.pop("settings", {})
    inputs = {"shot": {"type": "Image", "file": str(shot), "layer": "Image0"}}
    return {"halation": 1, "settings": settings, "inputs": inputs, "nodes": nodes, "links": links, **more}


GRAIN = {
    "nodes": {
        "bright": {"type": "exposure"},
        "glow": {"type": "gaussian_blur", "values": {"sigma": 1.5}},
        "later": {"type": "time_offset", "values": {"frames": 2}},
        "ghosts": {"type": "echo", "values": {"echoes": 2, "decay": 0.5, "mode": "add"}},
        "trails": {"type": "light_trails", "values": {"threshold": 0.2}},
        "part": {"type": "luminance"},
        "slow": {"type": "frame_blend"},
        "sum": {"type": "merge", "values": {"mode": "screen"}},
    },
    "links": {
        "bright.image": "inputs.shot",
        "glow.image": "bright.out",
        "later.image": "glow.out",
        "ghosts.image": "later.out",
        "trails.image": "ghosts.out",
        "slow.image": "trails.out",
        "part.image": "later.out",
        "slow.mask": "part.out",
        "sum.a": "slow.out",
        "sum.b": "glow.out",
    },
    "animation": {"bright.stops": {"expression": "sin(frame)"}},
}


@pytest.mark.parametrize("preroll", [None, 2])
def test_memories_and_other_frames_work_together(renderer, shot: Path, tmp_path: Path, preroll: int | None) -> None:
    """Keys before the first frame and after the last, a memory of a memory, and a picture that two parts read."""
    settings = {} if preroll is None else {"preroll": preroll}
    graph = load_graph(tmp_path / "graph.json", make_chain(shot, **GRAIN, settings=settings))
    text = compare_frames(renderer, graph, tmp_path, Port("sum", "out"))
    assert text.count(" gaussian_blur(") == 2, "it is defined once and called once"
    assert text.count("def glow_at(frame") == 1 and "slow_memory" in text


def test_a_number_that_is_no_picture_is_the_same_at_all_frames(renderer, shot: Path, tmp_path: Path) -> None:
    """A Field for an Image, a picture of another size, and an input that is a number."""
    nodes = {
        "gray": {"type": "luminance"},
        "small": {"type": "resize", "values": {"scale": [0.5, 0.5]}},
        "ghosts": {"type": "echo", "values": {"echoes": 1}},
        "held": {"type": "freeze", "values": {"frame": 2}},
        "both": {"type": "mix_images", "values": {"factor": 0.3}},
    }
    links = {
        "gray.image": "inputs.shot",
        "small.image": "inputs.shot",
        "ghosts.image": "gray.out",
        "held.image": "small.out",
        "held.field": "inputs.level",
        "both.a": "ghosts.out",
        "both.b": "held.out",
        "both.factor": "held.field_out",
    }
    made = make_chain(shot, nodes, links)
    made["inputs"]["level"] = {"type": "Field", "default": 0.25}
    compare_frames(renderer, load_graph(tmp_path / "graph.json", made), tmp_path, Port("both", "out"))


@pytest.mark.parametrize(
    "name", list_cases(["light_painting"], ["feedback_tunnel", "ink_boil", "long_exposure", "out_of_the_tunnel"])
)
def test_presets_that_move_in_time(renderer, tmp_path: Path, name: str) -> None:
    """Their first six frames, small."""
    path = next(path for path in paths() if path.stem == name)
    graph = document.load(path, sandbox=UNRESTRICTED)
    port = Port(OUTPUTS, next(iter(graph.outputs)))
    script, size = tmp_path / f"{name}.py", (97, 55)
    export_script(ExportOrder(graph, name, port, UNRESTRICTED, lambda: renderer, script, size=size))
    run_scripts([(script, tmp_path / "made.#.npy")], options=("--frames", *map(str, FRAMES)))
    frames = range(FRAMES[0], FRAMES[1] + 1)
    for frame, ours in zip(frames, render_frames(renderer, graph, port, frames, size), strict=True):
        errors = np.abs(np.load(tmp_path / f"made.{frame}.npy") - ours) / np.maximum(1.0, np.abs(ours))
        assert errors.max() <= 1e-3, f"{frame}: {errors.max()}, {(errors > 1e-3).mean()} of all"


def test_what_remembers_is_not_read_at_other_frames(shot: Path, tmp_path: Path) -> None:
    nodes = {"trails": {"type": "light_trails"}, "later": {"type": "time_offset"}}
    graph = make_chain(shot, nodes, {"trails.image": "inputs.shot", "later.image": "trails.out"})
    with pytest.raises(GraphError, match="node 'trails': it remembers the frame before"):
        export_output(load_graph(tmp_path / "graph.json", graph), "out", tmp_path / "no.py", "later")


def test_a_script_reads_numbered_files_and_writes_them(cli, shot: Path, tmp_path: Path) -> None:
    """Where a file is missing, the one before; a frame that the graph does not have is refused."""
    nodes = {"bright": {"type": "exposure"}}
    links = {"bright.image": "inputs.shot", "outputs.image": "bright.out"}
    animation = {"bright.stops": {"expression": "frame / 4"}}
    outputs = {"image": {"type": "Image"}}
    made = make_chain(shot, nodes, links, outputs=outputs, animation=animation, settings={"frames": [1, 8]})
    (tmp_path / "graph.json").write_text(json.dumps(made))
    assert cli("export", tmp_path / "graph.json", "--to", "python", "-o", tmp_path / "look.py").code == 0
    run_scripts([(tmp_path / "look.py", tmp_path / "a.##.npy")], options=("--frames", "5", "8"))
    files = sorted(path.name for path in tmp_path.glob("a.*.npy"))
    assert files == ["a.05.npy", "a.06.npy", "a.07.npy", "a.08.npy"]
    sixth, eighth = (np.load(tmp_path / f"a.{frame:02}.npy")[..., :3] for frame in (6, 8))
    np.testing.assert_allclose(eighth, sixth * 2.0**0.5, rtol=1e-6)
