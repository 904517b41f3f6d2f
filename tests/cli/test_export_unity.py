"""A graph as an effect of Unity: its shader in glslang's compiler of HLSL, its scripts in Mono's compiler of C#, and
the numbers that the scripts compute. Unity itself is not run: small stand-ins declare what its packages bring.
"""

from __future__ import annotations

import importlib.util
import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from game_looks import CHOICES, export, export_look, list_knobs, open_reader, refuse_unfit_graphs
from halation.presets import paths

STAND_INS = Path(__file__).parents[1] / "data/unity/stand_ins.cs"
INCLUDES = {
    "Core": "float4 _ProjectionParams, unity_OrthoParams, _ZBufferParams; float4x4 UNITY_MATRIX_V;\n"
    "#define UNITY_REVERSED_Z 1\nfloat LinearEyeDepth(float depth, float4 z) { return 1.0 / (z.z * depth + z.w); }\n",
    "DeclareDepthTexture": "Texture2D _CameraDepthTexture; SamplerState sampler_point_clamp;\n"
    "float SampleSceneDepth(float2 uv) { return _CameraDepthTexture.SampleLevel(sampler_point_clamp, uv, 0.0).r; }\n",
    "DeclareNormalsTexture": "Texture2D _CameraNormalsTexture; SamplerState sampler_point_clamp;\n"
    "float3 SampleSceneNormals(float2 uv) "
    "{ return _CameraNormalsTexture.SampleLevel(sampler_point_clamp, uv, 0.0).xyz; }\n",
}
"""What the shader includes of the Universal Render Pipeline, as far as it is called."""
LIBRARY = "Packages/com.unity.render-pipelines.universal/ShaderLibrary"

pytestmark = pytest.mark.skipif(importlib.util.find_spec("slangpy") is None, reason="slangpy is not installed")
needs_compiler = pytest.mark.skipif(not shutil.which("glslangValidator"), reason="glslangValidator is not installed")
needs_mono = pytest.mark.skipif(not shutil.which("mcs") or not shutil.which("mono"), reason="Mono is not installed")


@pytest.fixture(scope="module")
def look(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a look with controls of several kinds, one of which changes passes."""
    return export_look(tmp_path_factory.mktemp("unity"), "unity")


def read_data(folder: Path) -> dict[str, Any]:
    (file,) = folder.glob("Resources/*/Passes.json")
    return json.loads(file.read_text("utf-8"))


def read_passes(folder: Path) -> list[tuple[str, str]]:
    """Name and HLSL of each pass of the shader, in their order."""
    (file,) = folder.glob("Resources/*/Look.shader")
    text = file.read_text("utf-8")
    (head,) = re.findall(r"^HLSLINCLUDE\n(.*?)^ENDHLSL\n", text, re.MULTILINE | re.DOTALL)
    found = re.findall(r'^Pass { Name "([^"]+)"\nHLSLPROGRAM\n(.*?)^ENDHLSL\n}\n', text, re.MULTILINE | re.DOTALL)
    assert len(found) == text.count("HLSLPROGRAM") == text.count("\nPass {")
    return [(name, head + code) for name, code in found]


def reflect(code: str, stage: str, entry: str, folder: Path) -> dict[str, int]:
    """What Khronos' compiler finds in HLSL: the length of each uniform by its name, and outputs."""
    for name, text in INCLUDES.items():
        (folder / LIBRARY).mkdir(parents=True, exist_ok=True)
        (folder / LIBRARY / f"{name}.hlsl").write_text(text, encoding="utf-8")
    (folder / "pass.hlsl").write_text(code, encoding="utf-8")
    words = ["glslangValidator", "-D", "-V", "-q", "-S", stage, "-e", entry, f"-I{folder}"]
    words += ["--auto-map-bindings", "--auto-map-locations", "-o", str(folder / "pass.spv"), str(folder / "pass.hlsl")]
    said = subprocess.run(words, capture_output=True, text=True, check=False)
    assert said.returncode == 0, said.stdout
    found = re.findall(r"^([\w@.$]+?)(?:\[0\])?: offset .*? size (\d+),", said.stdout, re.MULTILINE)
    return {name: int(size) for name, size in found}


def list_records(data: dict[str, Any]) -> list[dict[str, Any]]:
    return [record for plan in data["openings"] + data["plans"] for record in plan["passes"]]


def check_shader(folder: Path, work: Path) -> int:
    """Assert that all passes compile, and read and write what the file of passes says; how many there are."""
    data, passes = read_data(folder), read_passes(folder)
    records = {record["pass"]: record for record in list_records(data)}
    assert [name for name, _ in passes[:5]] == ["take_picture", "take_depth", "take_normal", "show", "copy"]
    assert sorted(records) == list(range(5, len(passes)))
    reflect(passes[0][1], "vert", "Cover", work)  # it is the same in all
    for number, (name, code) in enumerate(passes):
        found = reflect(code, "frag", "Draw", work)
        if record := records.get(number):
            read = {binding["property"] for binding in record["pictures"] + record["tables"]}
            known = {other for other in found if re.fullmatch(r"_(?!Numbers)\w+", other)}
            assert known <= read and found.get("_Numbers", 0) <= record["rows"], name
            assert len([other for other in found if "@entryPointOutput" in other]) == len(record["targets"])
    return len(passes)


@needs_compiler
def test_every_pass_compiles_and_reads_what_it_is_given(look: Path, tmp_path: Path) -> None:
    assert check_shader(look, tmp_path) > 8


@needs_mono
def test_the_scripts_are_csharp_without_a_warning(cli, graphs, look: Path, tmp_path: Path) -> None:
    """Also where a label tries to end its text, and for controls of all types and with names of the language."""
    nodes = {"mix": "merge", "paint": "constant", "grain": "film_grain", "ring": "vignette"}
    links = {
        "mix.a": "paint.out",
        "mix.b": "light.out",
        "grain.image": "mix.out",
        "ring.image": "grain.out",
        "outputs.image": "ring.out",
    }
    targets = {
        "float": "light.stops",
        "Controls": "mix.mode",
        "color": "paint.color",
        "a-b": "grain.amount",
        "a b": "grain.size",
        "1st": "grain.seed",
        "on": "grain.animate",
        "frame": "ring.center",
    }
    controls = {name: {"target": target} for name, target in targets.items()}
    nodes = {name: {"type": type_} for name, type_ in nodes.items()}
    other = export(cli, graphs(nodes=nodes, links=links, controls=controls), tmp_path / "other", "unity")
    compile_scripts([look, other], tmp_path)
    text = (other / "GraphFeature.cs").read_text("utf-8")
    for field in ("float @float", "ControlsChoice @controls", "Color @color", "float @aB", "float @aB_", "bool @on",
                  "int @look1st", "Vector2 @frame"):  # fmt: skip
        assert f"public {field} = " in text


def compile_scripts(folders: list[Path], work: Path, *more: str) -> None:
    files = [str(file) for folder in folders for file in folder.glob("*.cs")]
    words = ["mcs", "-langversion:latest", "-warnaserror", "-target:library", f"-out:{work / 'look.dll'}", *more]
    said = subprocess.run([*words, str(STAND_INS), *files], capture_output=True, text=True, check=False)
    assert said.returncode == 0, said.stdout + said.stderr


def test_controls_are_what_the_inspector_shows(cli, graphs, tmp_path: Path) -> None:
    graph = graphs(**CHOICES)
    text = (export(cli, graph, tmp_path / "look", "unity") / "GraphFeature.cs").read_text("utf-8")
    assert "[Range(-10.0f, 10.0f)] public float @stops = 1.0f;" in text
    assert re.search(r"public KindChoice @kind = \(KindChoice\)\d+;", text) and '[InspectorName("over")]' in text
    assert re.search(r"\[ColorUsage\(false, true\)\] public Color @color = new Color\([\d.f, ]+\);", text)
    assert "Math.Min(Math.Max((double)look.@stops, -10.0), 10.0)," in text and "look.@color.g" in text
    assert "ChooseFrame" not in text  # it does not move
    for file in (tmp_path / "look").glob("*.*"):
        assert "ever run in Unity" in file.read_text("utf-8"), file.name


def write_initializer(value: Any, type_: str, types: dict[str, dict[str, str]]) -> str:
    """A value of JSON in C#, as Unity's reader fills the classes of the look: fields that JSON lacks stay empty."""
    if type_.endswith("[]"):
        parts = (write_initializer(part, type_[:-2], types) for part in value)
        return f"new {type_} {{ {', '.join(parts)} }}"
    if type_ in types:
        unknown = value.keys() - types[type_].keys()
        assert not unknown, (type_, unknown)
        fields = (f"{name} = {write_initializer(part, types[type_][name], types)}" for name, part in value.items())
        return f"new {type_} {{ {', '.join(fields)} }}"
    return json.dumps(value)


HARNESS = """using System; using System.Globalization; using System.Linq;
static class Harness {
    static string Write(double[] row) {
        return "= " + string.Join(" ", row.Select(x => x.ToString("R", CultureInfo.InvariantCulture)));
    }
    static void Main(string[] words) {
        var data = /*DATA*/;
        double[] knobs = words.Select(word => double.Parse(word, CultureInfo.InvariantCulture)).ToArray();
        PlanData plan = LookNumbers.ChoosePlan(data, knobs, false);
        Console.WriteLine("= " + Array.IndexOf(data.plans, plan));
        for (int slot = 0; slot < data.slots.Length; slot++)
            Console.WriteLine(Write(LookNumbers.FindNumbers(data, slot, knobs)));
        foreach (PassData pass in plan.passes)
            Console.WriteLine(Write(LookNumbers.FillRows(data, pass, knobs).Select(x => (double)x).ToArray()));
    }
}
"""


@pytest.fixture(scope="module")
def harness(look: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A program that prints what the scripts compute for the numbers of its command line."""
    work = tmp_path_factory.mktemp("harness")
    declared = (look / "LookData.cs").read_text("utf-8")
    classes = re.findall(r"class (\w+)\n    {\n(.*?)\n    }", declared, re.DOTALL)
    types = {name: dict(map(reversed, re.findall(r"public ([\w\[\]]+) (\w+);", body))) for name, body in classes}
    text = HARNESS.replace("/*DATA*/", write_initializer(read_data(look), "LookData", types))
    (work / "harness.cs").write_text(text.replace("static class", "namespace Halation.Look { static class", 1) + "}")
    files = [work / "harness.cs", look / "LookData.cs", look / "LookNumbers.cs"]
    words = ["mcs", "-langversion:latest", f"-out:{work / 'harness.exe'}", "-r:System.Core", *map(str, files)]
    said = subprocess.run(words, capture_output=True, text=True, check=False)
    assert said.returncode == 0, said.stdout + said.stderr
    return work / "harness.exe"


@needs_mono
def test_the_scripts_compute_the_numbers_of_the_reference_reader(look: Path, harness: Path, tmp_path: Path) -> None:
    """For controls at random: plans, slots, and every vector where the program of the shader reads it."""
    reference = open_reader(export_look(tmp_path, "godot"))  # the same package
    document, passes = reference.document, read_passes(look)
    random = np.random.default_rng(7)
    plans = set[int]()
    for _ in range(6):
        values = {knob["name"]: float(random.uniform(knob["low"], knob["high"])) for knob in list_knobs(document)}
        values["frame"] = float(round(values["frame"]))
        words = ["mono", str(harness), *map(repr, values.values())]
        said = subprocess.run(words, capture_output=True, text=True, check=True)
        number, *lines = re.findall("^= (.*)$", said.stdout, re.MULTILINE)  # Mono prints words of its own, too
        plan = document["plans"][-1][int(number)]
        assert plan == reference.plan(values, False)
        plans.add(int(number))
        rows = [np.array(line.split(), np.float64) for line in lines]
        for slot in range(len(document["slots"])):
            np.testing.assert_allclose(rows[slot], reference.numbers(slot, values), rtol=1e-6, atol=1e-9)
        own = read_data(look)["plans"][int(number)]["passes"]
        for record, mine, given in zip(plan["passes"], own, rows[len(document["slots"]) :], strict=True):
            check_rows(record, passes[mine["pass"]][1], given.reshape(-1, 4), reference, values)
    assert len(plans) > 1


def check_rows(record: dict[str, Any], code: str, given: np.ndarray, reference: Any, values: dict[str, float]) -> None:
    """Assert that each function of a program finds the numbers of its uniform."""
    slots = {**record["uniforms"], **({"weights": record["weights"]} if "weights" in record else {})}
    found = re.findall(r"given_(\w+)\(\) { return (?:\w+\(round\()?_Numbers\[(\d+)\]\.([xyzw]+)", code)
    assert found
    for name, row, channels in found:
        if name in slots:
            expected = reference.numbers(slots[name], values)
            np.testing.assert_allclose(given[int(row)][: len(channels)], expected, rtol=1e-6, atol=1e-9)


def test_what_no_game_gives_is_refused(cli, graphs, tmp_path: Path) -> None:
    refuse_unfit_graphs(cli, graphs, tmp_path / "no", "unity")


def test_depth_and_normals_come_from_the_game(cli, graphs, tmp_path: Path) -> None:
    graph = graphs(
        inputs={
            "depth": {"type": "Field", "file": "shot.exr", "layer": "Depth"},
            "normal": {"type": "Vector", "file": "shot.exr", "layer": "Combined"},
        },
        nodes={"mist": {"type": "fog"}},
        links={"mist.image": "light.out", "mist.depth": "inputs.depth", "outputs.image": "mist.out"},
    )
    sources = read_data(export(cli, graph, tmp_path / "look", "unity"))["sources"]
    assert sorted(source["role"] for source in sources) == ["depth", "picture"]


@needs_compiler
@pytest.mark.nightly
@pytest.mark.parametrize("preset", [path.stem for path in paths()])
def test_a_preset_is_written_or_refused_with_a_reason(cli, tmp_path: Path, preset: str) -> None:
    result = cli("export", preset, "--to", "unity", "-o", tmp_path / "look", "--size", "96x64")
    if result.code == 0:
        assert check_shader(tmp_path / "look", tmp_path) > 5
    else:
        assert result.code == 3 and re.search(r"draws meshes|reads the input '\w+'", result.err), result.err
