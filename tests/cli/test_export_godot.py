"""A graph as an effect of Godot: its shaders in the compiler of Godot, its scripts in a grammar of GDScript, and the
numbers that the scripts compute. Godot itself is not run.
"""

from __future__ import annotations

import importlib.util
import json
import re
import shutil
import struct
import subprocess
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from game_looks import CHOICES, export, export_look, list_knobs, open_reader, refuse_unfit_graphs

needs_compiler = pytest.mark.skipif(not shutil.which("glslangValidator"), reason="glslangValidator is not installed")
needs_grammar = pytest.mark.skipif(importlib.util.find_spec("gdtoolkit") is None, reason="gdtoolkit is not installed")


@pytest.fixture(scope="module")
def look(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a look with controls of several kinds, one of which changes passes."""
    return export_look(tmp_path_factory.mktemp("godot"), "godot")


def reflect(text: str, stage: str, folder: Path) -> tuple[dict[str, tuple[int, int]], int]:
    """What Khronos' compiler finds in a stage: by name the byte in its block and the binding, and the block's size."""
    file = folder / f"program.{stage}"
    file.write_text(text, encoding="utf-8")
    words = ["glslangValidator", "-V", "-q", "-o", str(folder / "program.spv"), str(file)]
    said = subprocess.run(words, capture_output=True, text=True, check=False)
    assert said.returncode == 0, said.stdout
    found = re.findall(r"^(\w+)(?:\[0\])?: offset (-?\d+), .* binding (-?\d+),", said.stdout, re.MULTILINE)
    block = re.search(r"^Numbers: .* size (\d+),", said.stdout, re.MULTILINE)
    return {name: (int(offset), int(binding)) for name, offset, binding in found}, int(block[1]) if block else 0


@needs_compiler
def test_every_program_compiles_and_reads_where_its_interface_says(look: Path, tmp_path: Path) -> None:
    interfaces = json.loads((look / "passes.json").read_text("utf-8"))["interfaces"]
    seen = 0
    for file in (look / "shaders").iterdir():
        vertex, fragment = file.read_text("utf-8").removeprefix("#[vertex]\n\n").split("\n#[fragment]\n\n")
        reflect(vertex, "vert", tmp_path)
        members, size = reflect(fragment, "frag", tmp_path)
        interface = interfaces[int(file.stem)] if file.stem.isdigit() else {"numbers": {"numbers": [0]}, "size": 16}
        assert size <= interface["size"] < size + 16  # the last row is whole in every buffer
        for name, (offset, binding) in members.items():
            if name in interface["numbers"]:
                assert offset == interface["numbers"][name][0], (file.name, name)
                seen += 1
            elif name in interface.get("pictures", {}):
                assert binding == interface["pictures"][name], (file.name, name)
                seen += 1
    assert seen > 30


@needs_grammar
def test_the_scripts_are_gdscript(look: Path) -> None:
    """Also where a label tries to end its text."""
    from gdtoolkit.parser import parser

    texts = [file.read_text("utf-8") for file in look.glob("*.gd")]
    assert len(texts) == 3
    for text in texts:
        parser.parse(text)
    assert not any(line.strip() == "pass" for text in texts for line in text.splitlines())


def test_controls_are_what_the_inspector_shows(cli, graphs, tmp_path: Path) -> None:
    graph = graphs(**CHOICES)
    text = (export(cli, graph, tmp_path / "look", "godot") / "halation_graph.gd").read_text("utf-8")
    assert "@export_range(-10.0, 10.0, 0.02) var look_stops: float = 1.0" in text
    assert re.search(r'^@export_enum\("\w+", .*\) var look_kind: int = \d+$', text, re.MULTILINE)
    assert re.search(r"^@export var look_color: Color = Color\([\d., ]+\)$", text, re.MULTILINE)
    assert '\t\t"stops": clampf(look_stops, -10.0, 10.0),' in text and "look_color.g" in text
    assert "choose_frame" not in text  # it does not move


class Bytes(bytearray):
    """What Godot's PackedByteArray does."""

    def resize(self, size: int) -> None:
        self.extend(bytes(size))

    def encode_float(self, place: int, number: float) -> None:
        struct.pack_into("<f", self, place, number)

    def encode_s32(self, place: int, number: int) -> None:
        struct.pack_into("<i", self, place, number)

    def encode_u32(self, place: int, number: int) -> None:
        struct.pack_into("<I", self, place, number)


WORDS = (
    (r"^extends .*$|^\t*@warning_ignore.*$|\bstatic |\bvar ", ""),
    (r"##? ", "# "),
    (r"\bfunc ", "def "),
    (r"^(def \w+)\((.*)\) -> \w+:$", lambda match: f"{match[1]}({re.sub(r': [A-Z]?[a-z]+[A-Za-z]*', '', match[2])}):"),
    (r"^(\t+for \w+): \w+ in", r"\1 in"),
    (r"^(\t+\w+): \w+ = ", r"\1 = "),
    (r" := ", " = "),
    (r"\((\w+\[[^()]*\]) as Array\)", r"\1"),
    (r"([\w]+(?:\[[^\[\]]*\])*)\.size\(\)", r"len(\1)"),
    (r"in len\(([^()]*)\):", r"in range(len(\1)):"),
    (r"\.duplicate\(\)", ".copy()"),
    (r"(\w+)\.has\((\w+)\)", r"(\2 in \1)"),
    (r"\(at / width\)", "(at // width)"),
    (r"\b(true|false)\b", lambda match: match[1].capitalize()),
    (r"^(\t+)\"(\w+)\":$", r'\1case "\2":'),
    (r"^(\t+)_:$", r"\1case _:"),
)
"""How GDScript is spelled in Python, as far as the script of the numbers goes: both read alike."""


def translate_numbers(folder: Path) -> ModuleType:
    """The script that computes numbers, as a module of Python."""
    text = (folder / "halation_numbers.gd").read_text("utf-8")
    for pattern, new in WORDS:
        text = re.sub(pattern, new, text, flags=re.MULTILINE)  # pyright: ignore[reportCallIssue, reportArgumentType]
    module = ModuleType("numbers_of_godot")
    module.__dict__.update(
        PackedByteArray=Bytes,
        lerpf=lambda a, b, share: a + (b - a) * share,
        absf=abs,
        roundf=lambda number: float(np.floor(number + 0.5)),
    )
    exec(compile(text, "halation_numbers.gd", "exec"), module.__dict__)
    return module


def test_the_script_computes_the_numbers_of_the_reference_reader(look: Path) -> None:
    """For controls at random, against the reader in numpy that is proved by its pixels."""
    reference, theirs = open_reader(look), translate_numbers(look)
    document = reference.document
    knobs = list_knobs(document)
    random = np.random.default_rng(7)
    seen = set[int]()
    for _ in range(12):
        values = {knob["name"]: float(random.uniform(knob["low"], knob["high"])) for knob in knobs}
        values["frame"] = float(round(values["frame"]))
        plan = theirs.choose_plan(document, values, False)
        assert plan == reference.plan(values, False)
        for slot in range(len(document["slots"])):
            expected = reference.numbers(slot, values)
            np.testing.assert_allclose(theirs.find_numbers(document, slot, values), expected, rtol=1e-6, atol=1e-9)
            seen.add(len(expected))
    assert len(seen) > 2 and document["axes"]


def test_blocks_are_packed_by_std140(look: Path) -> None:
    """By hand from GLSL 4.60, 7.6.2.2."""
    theirs = translate_numbers(look)
    layout = {"a": [0, "float", 0], "b": [8, "int", 0], "m": [16, "float", 3], "u": [64, "uint", 0]}
    uniforms = {"a": [1.5], "b": [-2, 3], "m": [float(n) for n in range(9)], "u": [7], "not read": [1.0]}
    expected = struct.pack("<fxxxxii", 1.5, -2, 3)
    expected += b"".join(struct.pack("<fff4x", *range(row, row + 3)) for row in (0, 3, 6)) + struct.pack("<I12x", 7)
    assert theirs.pack(layout, 80, uniforms) == expected


@pytest.mark.parametrize("format", ["glsl", "web", "godot", "unity", "reshade"])
def test_what_runs_on_the_processor_is_refused(cli, graphs, tmp_path: Path, format: str) -> None:
    """A pass of it has no shader: what follows would show whatever lies in its picture."""
    diffused = {"type": "color_palette", "values": {"dither": "error diffusion"}}
    path = graphs(nodes={"dots": diffused}, links={"dots.image": "light.out", "outputs.image": "dots.out"})
    done = cli("export", path, "--to", format, "-o", tmp_path / "out")
    assert done.code == 3 and "node 'dots' runs on the processor, which an exported effect cannot" in done.err
    assert not (tmp_path / "out").exists()


def test_what_no_game_gives_is_refused(cli, graphs, tmp_path: Path) -> None:
    refuse_unfit_graphs(cli, graphs, tmp_path / "no", "godot")


def test_depth_and_normals_come_from_the_game(cli, graphs, tmp_path: Path) -> None:
    graph = graphs(
        inputs={
            "depth": {"type": "Field", "file": "shot.exr", "layer": "Depth"},
            "normal": {"type": "Vector", "file": "shot.exr", "layer": "Combined"},
        },
        nodes={"mist": {"type": "fog"}},
        links={"mist.image": "light.out", "mist.depth": "inputs.depth", "outputs.image": "mist.out"},
    )
    folder = export(cli, graph, tmp_path / "look", "godot")
    document = json.loads((folder / "passes.json").read_text("utf-8"))
    names = {source["name"]: str(number) for number, source in enumerate(document["sources"])}
    assert document["roles"] == {names["beauty"]: "picture", names["depth"]: "depth"}
