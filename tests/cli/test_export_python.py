"""halation export --to python: scripts that a Python without Halation runs, against the renderer."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
import zlib
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from exr_files import read, write_exr
from halation import document
from halation.errors import GraphError
from halation.export import ExportOrder
from halation.export.python.library import load_library
from halation.export.python.missing import list_explained
from halation.export.python.script import export_script
from halation.graph import OUTPUTS, Port
from halation.nodes import MASK, Node, catalogue
from halation.presets import paths
from halation.renderer import Renderer, RenderRequest, open_device
from halation.resources.sandbox import UNRESTRICTED
from numpy_scripts import (
    choose_values,
    compare_outputs,
    export_output,
    find_choices,
    has_pictures,
    list_nodes,
    load_graph,
    make_graph,
    measure,
    render_outputs,
    run_scripts,
    write_pictures,
)
from selection import list_cases

PAGE = Path(__file__).parents[2] / "docs" / "export-python.md"

DAILY, NIGHTLY = (0, 3), (1, 2)
"""Which values of each node are tried: 0 its defaults, others at random, 3 with all inputs linked."""

STEPS = {"halftone": 0.005, "distance_field": 0.005, "deferred_lighting": 0.002}
"""Nodes that decide by thresholds or between equally near places: the part of pixels that rounding decides. Among
random normals, inputs that differ by 6e-8 let other neighbors be the surfaces of a pixel: its light differs by .15."""

ROUNDED = ("noise", "panorama")
"""Nodes that are not compared at each choice: a picture of 37 x 29 pixels is no strip of the faces of a cube, and
rounding moves warped noise: see `test_export_noise.py`."""

OFTEN = ["agx_look", "crt_television", "glitch_art", "neon_edges", "risograph", "soft_bloom", "watercolor"]
SELDOM = ["anamorphic_flares", "auto_exposed", "bleach_bypass", "burning_page", "cinematic_grade", "comic_ink",
          "cyanotype", "depth_mist", "film_halation", "fluted_glass", "golden_autumn", "heartbeat", "light_shafts",
          "mandala", "miniature", "night_street", "oil_painting", "pencil_sketch", "rain_on_glass", "silver_print",
          "spotlight", "technicolor", "vintage_photo", "zoom_burst"]  # fmt: skip
"""Presets that are compared by day and by night; more of them can be exported."""


@pytest.fixture(scope="module")
def renderer():
    return Renderer(open_device(sandbox=UNRESTRICTED), sandbox=UNRESTRICTED)


def compare(renderer: Renderer, folder: Path, id: str, graphs: dict[int, dict]) -> None:
    """All outputs of graphs of one node within 1e-3 of the renderer with 32 bits."""
    pairs, pictures = [], []
    for turn, text in graphs.items():
        graph = load_graph(folder / f"{turn}.json", text)
        for name, ours in render_outputs(graph, renderer, list(catalogue()[id].outputs)).items():
            script = folder / f"{turn}_{name}.py"
            export_output(graph, name, script)
            pairs.append((script, script.with_suffix(".npy")))
            pictures.append(ours)
    run_scripts(pairs, is_fresh=False)
    for ours, (script, made) in zip(pictures, pairs, strict=True):
        errors = measure(ours, np.load(made))
        assert (errors > 1e-3).mean() <= STEPS.get(id, 0.0), f"{script.name}: {errors.max()}"


@pytest.mark.parametrize("turns", list_cases([DAILY], [(NIGHTLY,)]), ids=str)
@pytest.mark.parametrize("id", [id for id in list_nodes() if has_pictures(id)])
def test_a_function_does_what_its_node_does(renderer, tmp_path: Path, id: str, turns: tuple[int, ...]) -> None:
    """At the defaults and at values at random."""
    node, file = catalogue()[id], write_pictures(tmp_path)
    known = {parameter.name: parameter for parameter in load_library().definitions[id].parameters}
    graphs = {}
    for turn in turns:
        random = np.random.default_rng((turn, zlib.crc32(id.encode())))
        values = choose_values(node, random) if turn else {}
        values |= {"pattern": "bayer"} if id == "dither" and not turn else {}
        optional = [name for name, socket in node.inputs.items() if socket.optional]
        linked = [name for name in optional if turn == DAILY[-1] and (name in known or name == MASK)]
        graphs[turn] = make_graph(file, node, values, tuple(linked))
    compare(renderer, tmp_path, id, graphs)


@pytest.mark.parametrize(
    "id", [id for id in list_nodes() if has_pictures(id) and id not in ROUNDED and find_choices(id)]
)
def test_a_function_has_every_choice_of_its_node(renderer, tmp_path: Path, id: str) -> None:
    """Each choice of each value at least once, and values at random."""
    node, choices, file, graphs = catalogue()[id], find_choices(id), write_pictures(tmp_path), {}
    for turn in range(max(map(len, choices.values()))):
        random = np.random.default_rng((4, turn, zlib.crc32(id.encode())))
        chosen = {name: words[turn % len(words)] for name, words in choices.items()}
        graphs[turn] = make_graph(file, node, choose_values(node, random) | chosen)
    compare(renderer, tmp_path, id, graphs)


@pytest.mark.parametrize("name", list_cases(OFTEN, SELDOM))
def test_a_script_makes_the_picture_of_a_preset(renderer, tmp_path: Path, name: str) -> None:
    path = next(path for path in paths() if path.stem == name)
    graph = document.load(path, sandbox=UNRESTRICTED)
    script, made = tmp_path / f"{name}.py", tmp_path / "made.npy"
    port, size = Port(OUTPUTS, next(iter(graph.outputs))), (97, 55)
    frame = (graph.settings.frames or (1, 1))[0]
    export_script(ExportOrder(graph, name, port, UNRESTRICTED, lambda: renderer, script, size=size))
    run_scripts([(script, made)])
    request = RenderRequest({}, {"image": port}, size, frame=frame, precision="float")
    errors = measure(renderer.render(graph, request)["image"], np.load(made))
    share = max(STEPS.get(item.id, 0.0) for item in graph.nodes.values() if isinstance(item, Node))
    assert (errors > 1e-3).mean() <= share, errors.max()


@pytest.mark.nightly
def test_how_much_can_be_exported() -> None:
    """The figures of docs/export-python.md."""
    exported = []
    for path in paths():
        graph = document.load(path, sandbox=UNRESTRICTED)
        port = Port(OUTPUTS, next(iter(graph.outputs)))
        try:
            text = export_script(ExportOrder(graph, path.stem, port, UNRESTRICTED, lambda: None)).text  # pyright: ignore
        except GraphError as fault:
            assert "node '" in str(fault)
            continue
        compile(text, path.stem, "exec")
        exported.append(path.stem)
    assert {*OFTEN, *SELDOM} <= {*exported}
    said = re.search(r"functions for (\d+) nodes; (\d+) of (\d+) presets", PAGE.read_text())
    assert said and [int(part) for part in said.groups()] == [len(list_nodes()), len(exported), len(paths())]


LOOK = {
    "nodes": {
        "glow": {"type": "bloom", "values": {"radius": 0.1}},
        "tone": {"type": "tone_map", "values": {"operator": "hable"}},
        "soft": {"type": "gaussian_blur", "values": {"sigma": 2.0}},
        "both": {"type": "mix_images", "values": {"factor": 0.3}},
    },
    "links": {
        "glow.image": "light.out",
        "soft.image": "glow.out",
        "both.a": "glow.out",
        "both.b": "soft.out",
        "tone.image": "both.out",
        "outputs.image": "tone.out",
    },
}


@pytest.fixture
def script(cli, graphs, tmp_path: Path) -> Path:
    result = cli("export", graphs(**LOOK), "-o", tmp_path / "look.py")
    assert result.code == 0, result.err
    return tmp_path / "look.py"


def run(script: Path, *words: object) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, script, *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=100, check=False)


def test_a_script_reads_and_writes_files(cli, graphs, script: Path, tmp_path: Path) -> None:
    """An EXR has light, a PNG has sRGB codes, and another picture is fitted to the size."""
    graph = graphs(**LOOK)
    assert cli("render", graph, "-o", tmp_path / "ours.exr", "--precision", "float").code == 0
    assert run(script, "-o", tmp_path / "theirs.exr").returncode == 0
    np.testing.assert_allclose(read(tmp_path / "theirs.exr"), read(tmp_path / "ours.exr"), atol=2e-5)
    words = ("--view", "none", "--dither", "none")
    assert cli("render", graph, "-o", tmp_path / "ours.png", *words).code == 0
    assert run(script, "-o", tmp_path / "theirs.png").returncode == 0
    codes = [oiio.ImageBuf(str(tmp_path / name)).get_pixels(oiio.FLOAT) for name in ("ours.png", "theirs.png")]
    assert np.abs(codes[0][..., :3] - codes[1][..., :3]).max() <= 1.01 / 255
    assert run(script, "-o", tmp_path / "again.npy", "-i", f"beauty={tmp_path / 'ours.png'}").returncode == 0
    assert cli("render", graph, "-o", tmp_path / "again.exr", "-i", f"beauty={tmp_path / 'ours.png'}",
               "--precision", "float").code == 0  # fmt: skip
    np.testing.assert_allclose(np.load(tmp_path / "again.npy"), read(tmp_path / "again.exr"), atol=2e-5)
    result = run(script, "-i", "nobody=a.exr")
    assert result.returncode == 1 and "choose one of beauty" in result.stderr and "Traceback" not in result.stderr


def test_a_script_has_what_it_needs_and_no_more(script: Path) -> None:
    """Functions in an order that Python takes, each used, and no branch for another choice."""
    text = script.read_text()
    tree = ast.parse(text)
    defined = [node.name for node in tree.body if isinstance(node, ast.FunctionDef)]
    used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)}
    assert {*defined} - used == set() and "hable" in defined
    assert not {"agx", "aces", "tone_luminance", "shrink_steadily", "bright_pass"} & {*defined}
    assert all(ast.get_docstring(node) for node in tree.body if isinstance(node, ast.FunctionDef))
    assert (
        "tone = tone_map(" in text and "radius=0.1 * HEIGHT" in text and "halation" not in text.replace("Halation", "")
    )
    checked = subprocess.run(
        [sys.executable, "-m", "ruff", "check", "--isolated", "--select", "F,E9", script],
        capture_output=True,
        text=True,
    )
    assert checked.returncode == 0, checked.stdout


def test_animated_values_are_tables(cli, graphs, tmp_path: Path) -> None:
    """An expression, frame by frame."""
    moving = {"light.stops": {"expression": "2 * sin(frame)"}}
    graph = graphs(animation=moving, settings={"frames": [1, 6]})
    assert cli("export", graph, "--frame", 2, "-o", tmp_path / "look.py").code == 0
    for words, frame in (((), 2), (("--frame", 5), 5)):
        assert run(tmp_path / "look.py", "-o", tmp_path / "theirs.npy", *words).returncode == 0
        out = tmp_path / f"{frame}.exr"
        assert cli("render", graph, "-o", out, "--frame", frame, "--precision", "float").code == 0
        np.testing.assert_allclose(np.load(tmp_path / "theirs.npy"), read(out), atol=1e-5)


def test_links_to_values_masks_groups_and_sizes(cli, graphs, tmp_path: Path) -> None:
    """A Field as a value, a Field through a blur, a mask, a muted node, and a picture of another size."""
    nodes = {
        "ramp": {"type": "ramp"},
        "soft": {"type": "gaussian_blur", "values": {"sigma": 3.0}},
        "half": {"type": "resize", "values": {"scale": [0.5, 0.5]}},
        "off": {"type": "invert", "muted": True},
        "gray": {"type": "saturation", "values": {"saturation": 0.0, "mix": 0.7, "invert_mask": True}},
        "sum": {"type": "merge", "values": {"mode": "screen"}},
    }
    links = {
        "soft.image": "ramp.value",
        "light.stops": "soft.out",
        "half.image": "light.out",
        "off.image": "light.out",
        "gray.image": "off.out",
        "gray.mask": "ramp.value",
        "sum.a": "half.out",
        "sum.b": "gray.out",
        "outputs.image": "sum.out",
    }
    graph = graphs(nodes=nodes, links=links)
    assert cli("export", graph, "-o", tmp_path / "look.py").code == 0
    text = (tmp_path / "look.py").read_text()
    assert "fit(half, WIDTH, HEIGHT)" in text and "mix_by_mask(" in text and "invert(" not in text
    assert run(tmp_path / "look.py", "-o", tmp_path / "theirs.npy").returncode == 0
    assert cli("render", graph, "-o", tmp_path / "a.exr", "--precision", "float").code == 0
    np.testing.assert_allclose(np.load(tmp_path / "theirs.npy"), read(tmp_path / "a.exr"), atol=1e-4)


@pytest.mark.parametrize(
    ("parts", "said"),
    [
        (
            {"nodes": {"odd": {"type": "depth_of_field"}}},
            "node 'odd': there is no numpy text for 'depth_of_field' (its reference is Blender's",
        ),
        ({"nodes": {"odd": {"type": "dither"}}}, "does not know 'pattern': 'blue noise'"),
        ({"nodes": {"odd": {"type": "gaussian_blur", "values": {"edge": "panorama"}}}}, "'edge': 'panorama'"),
        ({"nodes": {"odd": {"type": "invert"}}, "settings": {"color": {"working": "ACEScg"}}}, "working space"),
        ({"nodes": {"odd": {"type": "invert"}}, "settings": {"overscan": 0.1}}, "overscan"),
    ],
)
def test_refusals_name_the_node_and_the_reason(cli, graphs, tmp_path: Path, parts, said: str) -> None:
    links = {"odd.image": "light.out", "outputs.image": "odd.out"}
    if parts["nodes"]["odd"]["type"] == "depth_of_field":
        links["odd.depth"] = "depth.out"
        parts["nodes"]["depth"] = {"type": "luminance"}
        links["depth.image"] = "light.out"
    result = cli("export", graphs(**parts, links=links), "-o", tmp_path / "no.py")
    assert result.code == 3 and said in result.err and "Traceback" not in result.err
    assert not (tmp_path / "no.py").exists()


def test_each_node_without_a_function_has_a_reason() -> None:
    """In what a refusal says, and on the page; a node of which only cameras are read needs none."""
    missing = sorted(id for id in catalogue() if id not in list_nodes() and has_pictures(id))
    assert sorted(list_explained()) == missing
    _, _, table = PAGE.read_text("utf-8").partition("## Nodes without a function")
    assert sorted(re.findall(r"`(\w+)`", table.partition("The functions are in")[0])) == missing


def test_two_transforms_that_work_as_one_are_refused(cli, graphs, tmp_path: Path) -> None:
    nodes = {name: {"type": "transform", "values": {"rotation": 10.0}} for name in ("first", "second")}
    links = {"first.image": "light.out", "second.image": "first.out", "outputs.image": "second.out"}
    result = cli("export", graphs(nodes=nodes, links=links), "-o", tmp_path / "no.py")
    assert result.code == 3 and "node 'second': it joins with the transform 'first'" in result.err


def test_names_of_a_graph_are_no_code(cli, tmp_path: Path) -> None:
    """Ids, descriptions and names of files become names and texts of Python, whatever they are."""
    name = "class"
    tree = {
        "halation": 1,
        "settings": {"size": [8, 8]},
        "outputs": {"image": {"type": "Image"}},
        "nodes": {name: {"type": "checker"}, "np": {"type": "exposure", "values": {"stops": 1.0}}},
        "links": {"np.image": f"{name}.out", "outputs.image": "np.out"},
        "ui": {"about": {"doc": 'It ends """ here\\ \nimport os'}},
    }
    path = tmp_path / 'it\'s "odd".json'
    path.write_text(json.dumps(tree))
    assert cli("export", path, "--to", "python", "-o", tmp_path / "odd.py").code == 0
    assert run(tmp_path / "odd.py", "-o", tmp_path / "odd.npy").returncode == 0
    assert np.load(tmp_path / "odd.npy").shape == (8, 8, 4)
    assert not [node for node in ast.walk(ast.parse((tmp_path / "odd.py").read_text()))
                if isinstance(node, ast.Import) and node.names[0].name == "os"]  # fmt: skip


FORMULAS = (
    "a * (1 - b.a) + b",
    "a.r > b.g ? a : 0.5 * b",
    "[a.r ^ 2, sqrt(abs(a.g)), -q]",
    "[u, v * x / width, y / height]",
    "max(a, b, 0.3) / (a + b) - (a % 0.3)",
    "a.r < 0.5 or not (b.g < 1) and true",
    "mix(clamp(a, 0.2, 0.7), smoothstep(0.1, p, a), step(0.4, b.r))",
    "[fit(a.r, 0.2, 0.8, 1, 3), pulse(a.g, 0.2, 0.6), round(5 * a.b - 2), fract(3 * a.r)]",
    "[atan2(a.r, a.g) + asin(a.b) + acos(b.r), log(a.r) - log2(b.r) + 1 / 0]",
)


@pytest.mark.parametrize("formula", FORMULAS)
def test_formulas_become_lambdas(renderer, tmp_path: Path, formula: str) -> None:
    file = write_pictures(tmp_path)
    values = {"formula": formula, "p": 0.9, "q": 3.0}
    made = make_graph(file, catalogue()["pixel_formula"], values, ("a", "b"))
    compare_outputs(renderer, tmp_path, made)
    text = (tmp_path / "out.py").read_text()
    assert "formula=lambda " in text and ("def formula_pow" in text) == ("^" in formula)


def test_formulas_that_read_the_time_are_refused(tmp_path: Path) -> None:
    made = make_graph(write_pictures(tmp_path), catalogue()["pixel_formula"], {"formula": "a * time"}, ("a",))
    with pytest.raises(GraphError, match=r"node 'it': .*does not know 'time'"):
        export_output(load_graph(tmp_path / "it.json", made), "out", tmp_path / "out.py")


@pytest.mark.parametrize("interpolation", ["smooth", "linear"])
@pytest.mark.parametrize("kernel", ["triangle", "mitchell"])
def test_a_grid_is_bent_as_by_the_node(renderer, tmp_path: Path, interpolation: str, kernel: str) -> None:
    """Points that are dragged at random: cells that shrink are the mean of several samples."""
    random = np.random.default_rng(4)
    places = {f"point_{row + 1}{column + 1}": (column / 3, row / 3) for row in range(4) for column in range(4)}
    values = {name: (np.array(place) + random.uniform(-0.09, 0.09, 2)).tolist() for name, place in places.items()}
    values |= {"interpolation": interpolation, "kernel": kernel, "edge": "clamp"}
    compare_outputs(renderer, tmp_path, make_graph(write_pictures(tmp_path), catalogue()["grid_warp"], values))


@pytest.mark.parametrize("repair", ["neighbors", "black"])
def test_broken_pixels_are_repaired_as_sanitize_does(repair: str) -> None:
    """Files are repaired when they are read: here the function gets what a graph may make on the way."""
    names: dict = {"np": np}
    texts = [each.text for each in load_library().collect(["sanitize"])]
    exec("\n\n".join(["from __future__ import annotations", *texts]), names)
    random = np.random.default_rng(7)
    picture = random.uniform(0.0, 3.0, (9, 12, 4))
    picture[random.random(picture.shape) > 0.7] = np.nan
    picture[1:5, 1:5], picture[6, 6:10], picture[8, :] = np.nan, -np.inf, np.inf
    expected = picture.copy()
    for y, x, channel in np.argwhere(~np.isfinite(picture)):
        around = picture[max(y - 1, 0) : y + 2, max(x - 1, 0) : x + 2, channel]
        around = around[np.isfinite(around)]
        expected[y, x, channel] = around.mean() if repair == "neighbors" and around.size else 0.0
    repaired = names["sanitize"](picture, repair, "keep", 1e9, False)
    np.testing.assert_allclose(repaired, expected, rtol=1e-12)


PROJECTIONS = {
    "lat-long": "cube cross",
    "cube strip": "lat-long",
    "cube cross": "perspective",
    "mirror ball": "cube strip",
    "fisheye": "little planet",
    "little planet": "fisheye",
    "perspective": "mirror ball",
}
"""Each projection once as that of the picture, with the projection of the result."""


@pytest.mark.parametrize(("source", "target"), PROJECTIONS.items())
def test_panoramas_are_those_of_the_node(renderer, tmp_path: Path, source: str, target: str) -> None:
    values = {"source": source, "target": target, "yaw": 40.0, "pitch": -25.0, "roll": 10.0, "angle": 100.0}
    width, height = {"cube strip": (66, 11), "cube cross": (44, 33)}.get(source, (37, 29))  # faces are whole pixels
    pixels = np.random.default_rng(6).random((height, width, 4)).astype(np.float32)
    file = write_exr(tmp_path / "panorama.exr", {"Image0": pixels}, {"Image0": "float"})
    made = make_graph(file, catalogue()["panorama"], values)
    compare_outputs(renderer, tmp_path, made, 0.003 if source.startswith("cube") else 0.0)
