"""halation export --to glsl and --to web: packages of passes."""

from __future__ import annotations

import itertools
import json
import subprocess
import sys
from pathlib import Path

import moderngl
import numpy as np
import pytest
from exported_looks import LOOK, VALIDATOR, open_page, plan_presets, validate
from exr_files import read
from halation.compiler.knobs import Knob, Point
from halation.export.package.assembly import _describe_skipped  # pyright: ignore[reportPrivateUsage]
from halation.export.package.curves import PLACED, fill_gaps, read_slot, simplify, write_slot
from halation.export.package.dialects import COVERING_VERTEX, DIALECTS
from halation.export.package.exact_functions import use_exact_functions
from halation.export.package.parts import VariantSamples
from halation.export.package.sampling import JUMP_STEP, KnobSampler, Sample, Slot
from halation.export.package.variants import MAX_SPANS, find_axis
from isf_files import IMAGE, isf
from scipy.interpolate import RegularGridInterpolator


@pytest.fixture
def folder(cli, graphs, tmp_path: Path) -> Path:
    """A package of `LOOK`."""
    result = cli("export", graphs(**LOOK), "--to", "glsl", "-o", tmp_path / "look", "--json")
    assert result.code == 0 and result.json["controls"] == 4, result.err
    return tmp_path / "look"


def read_package(folder: Path, *words: str) -> np.ndarray:
    """The picture that the reader in the folder makes, run as a user runs it."""
    out = folder / "out.npy"
    subprocess.run([sys.executable, folder / "read_package.py", folder, out, *words], check=True, timeout=100)
    return np.load(out)


@pytest.mark.parametrize(
    "settings",
    [{}, {"stops": 2.5, "color": 0.3}, {"size": 0.31, "glow": 0.7}, {"color": 1.7, "frame": 7}],
    ids=["at rest", "numbers", "other passes", "another frame"],
)
def test_the_reader_in_the_folder_gives_our_pixels(cli, graphs, folder: Path, tmp_path: Path, settings) -> None:
    words = [f"--{'frame' if name == 'frame' else 'set'}={number if name == 'frame' else f'{name}={number}'}"
             for name, number in settings.items()]  # fmt: skip
    out = tmp_path / "ours.exr"
    assert cli("render", graphs(**LOOK), "-o", out, "--precision", "float", *words).code == 0
    ours = read(out)
    theirs = read_package(folder, *(f"{name}={number}" for name, number in settings.items()))
    assert np.abs(theirs - ours).max() <= 2e-3 * np.abs(ours).max()


def test_on_one_driver_the_pixels_are_the_same_bits(cli, graphs, tmp_path: Path) -> None:
    """Fragment passes with buffers of 32 bits are what a package has, and GLSL 4.1 says where rounding matters."""
    graph = graphs(
        **{**LOOK, "nodes": {**LOOK["nodes"], "tone": {"type": "saturation", "values": {"saturation": 1.4}}}}
    )
    assert cli("export", graph, "--to", "glsl", "-o", tmp_path / "look").code == 0
    words = ("--precision", "float", "--form", "fragment")
    assert cli("render", graph, "-o", tmp_path / "ours.exr", *words).code == 0
    np.testing.assert_array_equal(read_package(tmp_path / "look"), read(tmp_path / "ours.exr"))


def test_a_package_remembers_frames(cli, graphs, tmp_path: Path) -> None:
    """Feedback: the first frame has a plan of its own, and the fourth one is made of all before it."""
    nodes = {"back": {"type": "feedback"}}
    graph = graphs(
        nodes=nodes, links={"back.image": "light.out", "outputs.image": "back.out"}, settings={"frames": [1, 5]}
    )
    assert cli("export", graph, "--to", "glsl", "-o", tmp_path / "look").code == 0
    plans = json.loads((tmp_path / "look/passes.json").read_text())["plans"]
    assert len(plans) == 2 and plans[1][0]["memories"]
    assert cli("render", graph, "-o", tmp_path / "a.exr", "--frame", 4, "--precision", "float").code == 0
    ours = read(tmp_path / "a.exr")
    assert np.abs(read_package(tmp_path / "look", "frame=4") - ours).max() <= 2e-3 * np.abs(ours).max()


def test_a_control_may_keep_the_passes_in_a_part_of_its_range(cli, tmp_path: Path) -> None:
    """Short shafts have other passes for most places of the light."""
    size = ("--size", "480x270")
    result = cli("export", "light_shafts", "--to", "glsl", "-o", tmp_path / "look", *size)
    assert result.code == 0, result.err
    words = ("--precision", "float", "--set", "length=0.005", "--set", "beams=3")
    assert cli("render", "light_shafts", "-o", tmp_path / "ours.exr", *size, *words).code == 0
    ours = read(tmp_path / "ours.exr")
    theirs = read_package(tmp_path / "look", "length=0.005", "beams=3")
    assert np.abs(theirs - ours).max() <= 2e-3 * np.abs(ours).max()


def test_what_a_package_says(folder: Path) -> None:
    package = json.loads((folder / "passes.json").read_text())
    controls = {control["name"]: control for control in package["controls"]}
    assert controls["color"]["label"] == "Color" and controls["color"]["knobs"][0]["rest"] == 1.0
    assert controls["size"]["kind"] == "slider" and package["axes"][0]["knob"] == "size"
    assert {name.name for name in folder.iterdir()} >= {*DIALECTS, "README.md", "read_package.js", "pixels"}
    for names in (["read_package.py", "package_values.py"], ["read_package.js"]):
        lines = [line for name in names for line in (folder / name).read_text().splitlines()]
        assert len(lines) <= 200 and max(map(len, lines)) <= 120
    for plan in package["plans"][0]:
        made = {number for each in plan["passes"] for number in each["targets"]}
        read_first = {number for each in plan["passes"] for number in each["textures"]} - made
        assert all("source" in plan["surfaces"][number] for number in read_first) and plan["output"] in made


def test_a_control_is_held_with_all_its_parts(cli, graphs, tmp_path: Path) -> None:
    """Both sides of the squares change passes, in more ways than a package holds: then no plan may ask for either."""
    graph = graphs(
        nodes={"squares": {"type": "pixelate", "values": {"size": [16.0, 16.0]}}},
        links={"squares.image": "light.out", "outputs.image": "squares.out"},
        controls={"squares": {"target": "squares.size"}, "frame": {"target": "light.stops"}},
    )
    assert cli("export", graph, "--to", "glsl", "-o", tmp_path / "look").code == 0
    package = json.loads((tmp_path / "look/passes.json").read_text())
    offered = {knob["name"] for control in package["controls"] for knob in control["knobs"]} | {"frame"}
    asked = {axis["knob"] for axis in package["axes"]}
    asked |= {curve["knob"] for slot in package["slots"] for curve in slot.get("curves", ())}
    assert asked <= offered and "frame.0" in offered
    assert cli("render", graph, "-o", tmp_path / "a.exr", "--precision", "float").code == 0
    np.testing.assert_allclose(read_package(tmp_path / "look"), read(tmp_path / "a.exr"), atol=2e-3)


@pytest.mark.skipif(VALIDATOR is None, reason="glslangValidator is not installed")
@pytest.mark.parametrize("dialect", ["glsl410", "es300", "vulkan450"])
def test_the_reference_compiler_takes_the_programs_of_all_presets(dialect: str, tmp_path: Path) -> None:
    """It checks GLSL 3.30 too, but with the rules of later versions, so a driver tries those: see the readers."""
    write, words = DIALECTS[dialect], ("-V", "--no-link") if dialect == "vulkan450" else ()
    texts = {"cover.vert": write(COVERING_VERTEX)}
    sources = {(each.shader.source, each.shader.vertex) for plan in plan_presets() for each in plan.passes}
    for number, (fragment, vertex) in enumerate(sorted(sources)):
        texts[f"{number}.frag"] = write(fragment)
        if vertex:
            texts[f"{number}.vert"] = write(vertex)
    assert len(texts) > 150
    assert not validate(texts, tmp_path, *words)


@pytest.mark.parametrize(
    ("name", "numbers"),
    [
        *((name, np.linspace(-40.0, 40.0, 4001)) for name in ("sin", "cos", "atan")),
        ("tan", np.linspace(-1.5, 1.5, 1001)),
        *((name, np.linspace(-1.0, 1.0, 1001)) for name in ("asin", "acos")),
    ],
)
def test_angles_in_browsers_are_exact(name: str, numbers: np.ndarray) -> None:
    """Against numpy: also of two arguments, and of vectors."""
    inverse = name.replace("a", "arc", 1) if name in ("atan", "asin", "acos") else name
    x = numbers.astype(np.float32)
    exact = [getattr(np, inverse)(x.astype(np.float64))] * 2
    calls = [f"{name}(x)", f"{name}(vec3(x)).z"]
    if name == "atan":
        exact.append(np.arctan2(x.astype(np.float64), -3.0))
        calls.append("atan(vec2(x), vec2(-3.0)).y")
    main, functions = use_exact_functions(f"void main() {{ {''.join(f'y{n} = {c}; ' for n, c in enumerate(calls))}}}")
    outputs = [f"y{number}" for number in range(len(calls))]
    head = f"#version 330\nin float x;\n{''.join(f'out float {y};' for y in outputs)}\n"
    context = moderngl.create_standalone_context(backend="egl")
    context.simple_framebuffer((1, 1)).use()  # without any, nothing is transformed
    program = context.program(f"{head}{functions}{main}", varyings=outputs)
    sink = context.buffer(reserve=4 * len(outputs) * len(x))
    context.vertex_array(program, [(context.buffer(x.tobytes()), "1f", "x")]).transform(sink, moderngl.POINTS)
    shown = np.frombuffer(sink.read(), np.float32).reshape(-1, len(outputs)).T
    context.release()
    np.testing.assert_allclose(shown, exact, rtol=1e-6, atol=2e-6)


def test_a_page_holds_everything(cli, graphs, tmp_path: Path) -> None:
    page = tmp_path / "look.html"
    figures = cli("export", graphs(**LOOK), "-o", page, "--json").json
    text = page.read_text()
    content, blobs = open_page(text)
    assert "http:" not in text and "https:" not in text and "import " not in text.replace("!important", "")
    assert figures["controls"] == 4 and len(text) < 200_000
    (source,) = content["document"]["sources"]
    width, height = source["size"]
    pixels = np.frombuffer(blobs[source["blob"]], np.float16).reshape(height, width, 4)
    rising = np.linspace(0.0, 1.0, width, dtype=np.float32).astype(np.float16)
    np.testing.assert_array_equal(pixels[..., 0], np.broadcast_to(rising, pixels.shape[:2]))
    assert pixels[0, -1].tolist() == [1.0, 0.25, 0.5, 1.0] and source["is_input"]
    assert all(program["fragment"].startswith("#version 300 es") for program in content["programs"])


def test_a_shader_of_another_format_is_refused(cli, graphs, tmp_path: Path) -> None:
    (tmp_path / "a.fs").write_text(isf("gl_FragColor = IMG_THIS_PIXEL(inputImage);", IMAGE))
    graph = graphs(
        nodes={"odd": {"type": "isf", "file": "a.fs"}},
        links={"odd.inputImage": "light.out", "outputs.image": "odd.out"},
    )
    for words in (("-o", tmp_path / "no.html"), ("--to", "glsl", "-o", tmp_path / "no")):
        result = cli("export", graph, *words)
        assert result.code == 3 and "node 'odd' is a shader of another format" in result.err
        assert not words[-1].exists()


def test_curves_are_polygons_and_grids_are_bilinear() -> None:
    """Against numpy and scipy."""
    random = np.random.default_rng(3)
    xs, ys = np.sort(random.random(7)), np.sort(random.random(5))
    rows, values = random.random((7, 2)), random.random((7, 5, 2))
    curve = {"knob": "a", "at": xs.tolist(), "values": rows.tolist()}
    grid = {"knobs": ["a", "b"], "at": [xs.tolist(), ys.tolist()], "values": values.tolist()}
    interpolator = RegularGridInterpolator((xs, ys), values)
    for share in (0.0, 0.3, 0.77, 1.0):
        x, y = xs[0] + share * (xs[-1] - xs[0]), ys[-1] - share * (ys[-1] - ys[0])
        line = [np.interp(x, xs, column) for column in rows.T]
        found = read_slot({"base": [1.0, 2.0], "curves": [curve], "grids": [grid]}, {"a": x, "b": y})
        np.testing.assert_allclose(found, line + interpolator([[x, y]])[0], rtol=1e-6)
        many = {"base": [2.0, 0.0], "curves": [curve, {**curve, "knob": "b"}], "mode": "multiply"}
        twice = read_slot(many, {"a": x, "b": x})
        np.testing.assert_allclose(twice, [line[0] * line[0] / 2.0, 2.0 * line[1]], rtol=1e-6)
        whole = read_slot({"base": [1, 2], "curves": [curve]}, {"a": x})  # as JSON spells numbers without a fraction
        np.testing.assert_allclose(whole, line, rtol=1e-6)


def test_the_settings_of_the_graph_keep_their_passes() -> None:
    """However many spans a knob has, the one with its value in the graph is kept, and that value stands for it."""
    for count in (MAX_SPANS, MAX_SPANS + 17):
        samples = {float(x): Sample(None, x, ()) for x in range(count)}  # pyright: ignore[reportArgumentType]
        for rest in samples:
            axis = find_axis("size", rest, samples)
            assert axis and len(axis.spans) <= MAX_SPANS and rest in [span.middle for span in axis.spans]
            assert axis.skipped == count - len(axis.spans)
            assert [f"has {count} lists" in note for note in _describe_skipped([axis])] == [True] * (count > MAX_SPANS)


def test_a_polygon_is_simplified_without_loss() -> None:
    xs = np.linspace(0.0, 1.0, 65)
    bent = np.stack([np.maximum(xs - 0.5, 0.0), 3.0 * xs], axis=1)
    assert simplify(xs, bent) == [0, 32, 64]
    assert len(simplify(xs, (xs**2)[:, None])) > 30


def test_matrices_follow_a_turn_closely() -> None:
    """Against the closed form: 96 samples of a turn and a distance, between which a polygon is off by 5e-4."""

    def turn(degrees: np.ndarray) -> np.ndarray:
        angles = np.radians(degrees)
        return np.stack([np.cos(angles), np.sin(angles), 20.0 * np.sin(angles), np.full_like(angles, 17.0)], axis=1)

    xs, between = np.linspace(-180.0, 180.0, 97), np.linspace(-180.0, 180.0, 7001)
    places, rows = fill_gaps(xs, turn(xs))
    polygon = np.stack([np.interp(between, places, column) for column in rows.T], axis=1)
    off = np.abs(polygon - turn(between)).max(axis=0)
    assert (off <= np.array([1.0, 1.0, 20.0, 17.0]) * 1.5 * PLACED).all()
    assert len(places) < 12 * len(xs)


def test_small_numbers_of_a_table_count_beside_huge_ones() -> None:
    """A table of lights holds how many there are, places, and how far suns are: 1e18."""

    def sample(count: float) -> Sample:
        slot = Slot(np.array([count, 0.1 * count * count, 1e18]), is_whole=False, is_table=True)
        return Sample(None, 0, (slot,))  # pyright: ignore[reportArgumentType]

    places = [1.0, 2.0, 3.0, 4.0, 5.0]
    samples = VariantSamples(sample(3.0), {"lights": {x: sample(x) for x in places}}, [], lambda a, b: ([], [], []))
    record = write_slot(0, samples.rest, samples.by_knob, [], samples.find_jumps([0]))
    for x in places:
        np.testing.assert_allclose(read_slot(record, {"lights": x}), [x, 0.1 * x * x, 1e18], rtol=1e-6)


@pytest.mark.parametrize(("edges", "most"), [(10.3, 200), (1e9, 1000)])
def test_edges_are_looked_for_closely_unless_they_are_everywhere(edges: float, most: int) -> None:
    """Passes may change at some values of a knob, or with every value, as those of a picture of another size."""
    taken: list[float] = []

    def take(point: Point) -> Sample:
        taken.append(point["size"])
        return Sample(None, int(edges * point["size"]), (Slot(np.zeros(1), is_whole=False),))  # pyright: ignore[reportArgumentType]

    samples = KnobSampler(take, {"size": 0.5}, Knob("size", 0.5, 0.0, 1.0, is_whole=False)).sample_range()
    assert len(taken) < most
    if edges < 100.0:
        found = [(a + b) / 2.0 for a, b in itertools.pairwise(samples) if int(edges * a) != int(edges * b)]
        np.testing.assert_allclose(found, np.arange(1, 11) / edges, atol=JUMP_STEP)


def test_small_numbers_of_a_table_are_sampled_beside_huge_ones() -> None:
    """What bends gets samples, whatever else the table holds; rounding of a number near 0 gets none."""

    def take(point: Point, rounding: float = 1e-9) -> Sample:
        x = point["turn"]
        numbers = np.array([np.sin(6.0 * x), 1e18, rounding * np.sin(50.0 * x)])
        return Sample(None, 0, (Slot(numbers, is_whole=False, is_table=True),))  # pyright: ignore[reportArgumentType]

    samples = KnobSampler(take, {}, Knob("turn", 0.2, 0.0, 1.0)).sample_range()
    exact = KnobSampler(lambda point: take(point, 0.0), {}, Knob("turn", 0.2, 0.0, 1.0)).sample_range()
    assert 16 < len(samples) == len(exact) < 129
    between = np.linspace(0.0, 1.0, 500)
    lines = np.interp(between, list(samples), [sample.slots[0].numbers[0] for sample in samples.values()])
    assert np.abs(lines - np.sin(6.0 * between)).max() < 2.5e-3


def test_corners_of_curves_stay() -> None:
    """Around a corner nothing is put between samples; there is no bulge in what is straight."""
    xs = np.linspace(0.0, 1.0, 33)
    bent = np.stack([np.maximum(xs - 0.5, 0.0), 3.0 * xs], axis=1)
    places, rows = fill_gaps(xs, bent)
    np.testing.assert_allclose(rows[:, 0], np.maximum(places - 0.5, 0.0), atol=1e-12)


def test_nothing_is_mixed_where_weights_become_more() -> None:
    """Weights, their number and where they begin, of a wider blur: in a gap all are those of one sample."""

    def sample(width: float) -> Sample:
        reach = int(np.ceil(width))
        weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / width) ** 2)
        numbers = (np.array([2.0 * reach + 1.0]), np.array([-float(reach)]), weights / weights.sum())
        slots = tuple(Slot(number, is_whole=False) for number in numbers)
        return Sample(None, 0, slots)  # pyright: ignore[reportArgumentType]

    places = (2.2, 2.6, 2.999, 3.001, 3.4, 3.8)
    samples = VariantSamples(sample(2.6), {"width": {x: sample(x) for x in places}}, [], lambda a, b: ([], [], []))
    records = [write_slot(at, samples.rest, samples.by_knob, [], samples.find_jumps([0, 1, 2])) for at in range(3)]
    for x in (2.9995, 3.0005):
        taps, origin, weights = (read_slot(record, {"width": x}) for record in records)
        reach = 3 if x < 3.0 else 4
        assert taps == [2 * reach + 1] and origin == [-reach]
        assert np.trim_zeros(weights, "b").size == taps[0] and weights.sum() == pytest.approx(1.0, abs=1e-7)


def test_numbers_beside_a_jump_are_interpolated() -> None:
    """The width of a line, and how far it reaches in whole pixels: samples lie close where the reach jumps alone."""
    places = (8.1, 15.9, 16.1, 20.0)

    def sample(width: float) -> Sample:
        numbers = (np.array([0.25 * width]), np.array([np.ceil(0.125 * width) + 2.0]))
        slots = tuple(Slot(number, is_whole=bool(at)) for at, number in enumerate(numbers))
        return Sample(None, 0, slots)  # pyright: ignore[reportArgumentType]

    samples = VariantSamples(sample(9.6), {"width": {x: sample(x) for x in places}}, [], lambda a, b: ([], [], []))
    jumps = samples.find_jumps([0, 1])
    width, reach = (write_slot(at, samples.rest, samples.by_knob, [], jumps) for at in (0, 1))
    for x in (8.1, 9.6, 12.0, 15.8, 16.2, 19.0, 20.0):
        assert read_slot(width, {"width": x}) == pytest.approx([0.25 * x], abs=1e-6)
        assert read_slot(reach, {"width": x}) == [np.ceil(0.125 * x) + 2.0]
    for x in (15.99, 16.01):  # in the gap both jump at once
        assert read_slot(width, {"width": x}) == pytest.approx([0.25 * (15.9 if x < 16.0 else 16.1)])
