"""A graph as WGSL: a real implementation of WebGPU runs it, on a driver of Vulkan without a graphics card."""

from __future__ import annotations

import importlib.util
import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from exr_files import read
from halation import document
from halation.compiler import Request, compile_graph
from halation.errors import UsageError
from halation.export.package.planning import TARGET
from halation.export.slang import compiler as slang
from halation.export.wgsl.translation import write_wgsl
from halation.inputs.provider import MediaProvider
from halation.presets import paths
from halation.resources.sandbox import UNRESTRICTED

needs_slang = pytest.mark.skipif(importlib.util.find_spec("slangpy") is None, reason="slangpy is not installed")


def has_vulkan() -> bool:
    """Whether WebGPU finds a device."""
    try:
        import wgpu

        return bool(wgpu.gpu.request_adapter_sync())
    except (ImportError, RuntimeError):
        return False


@pytest.fixture(scope="module")
def vulkan() -> None:
    if not has_vulkan():
        pytest.skip("there is no driver of Vulkan")


def run_wgsl(folder: Path, *words: str) -> np.ndarray:
    """The picture that the reader in the folder makes, run as a user runs it."""
    subprocess.run(
        [sys.executable, folder / "read_wgsl.py", folder, folder / "out.npy", *words], check=True, timeout=100
    )
    return np.load(folder / "out.npy")


def write_still(preset: str, folder: Path, end: str = "") -> Path:
    """A preset without controls and time: trying all their values takes longer than translating.

    With an end, such as "light.out", it has only the nodes that this is made of.
    """
    home = Path(paths()[0]).parent
    text = (home / f"{preset}.json").read_text(encoding="utf-8")
    graph = json.loads(re.sub(r'"(samples|pictures)/', rf'"{home.as_posix()}/\1/', text))
    graph.pop("controls", None)
    graph.get("settings", {}).pop("frames", None)
    if end:
        graph["links"]["outputs.image"] = end
        used = list_sources(graph["links"], end)
        graph["nodes"] = {id: node for id, node in graph["nodes"].items() if id in used}
        graph["links"] = {to: source for to, source in graph["links"].items() if to.split(".")[0] in {*used, "outputs"}}
        graph["inputs"] = {
            id: item for id, item in graph["inputs"].items() if f"inputs.{id}" in graph["links"].values()
        }
    (folder / f"{preset}.json").write_text(json.dumps(graph), encoding="utf-8")
    return folder / f"{preset}.json"


def list_sources(links: dict[str, str], end: str) -> set[str]:
    """The nodes that an output is made of."""
    node = end.split(".")[0]
    return {node}.union(*(list_sources(links, source) for to, source in links.items() if to.split(".")[0] == node))


def compare(cli, preset: str, folder: Path, end: str = "") -> np.ndarray:
    """The largest error of each pixel, as a part of the brightest number."""
    graph, words = write_still(preset, folder, end), ("--size", "160x90")
    result = cli("export", graph, "--to", "wgsl", "-o", folder / "look", *words)
    assert result.code == 0, result.err
    assert cli("render", graph, "-o", folder / "a.exr", "--precision", "float", *words).code == 0
    ours = read(folder / "a.exr")
    return np.abs(run_wgsl(folder / "look")[..., : ours.shape[2]] - ours).max(axis=2) / np.abs(ours).max()


@needs_slang
@pytest.mark.parametrize(
    "preset",
    ["agx_look", "comic_ink", "lens_character", "cleaned_plate"],
)
def test_webgpu_gives_our_pixels(cli, vulkan, preset: str, tmp_path: Path) -> None:
    """Tables of views, filters, warps, and a shape whose comparisons look like types of WGSL."""
    assert compare(cli, preset, tmp_path).max() <= 2e-3


@needs_slang
@pytest.mark.parametrize("end", ["rings.out", pytest.param("", marks=pytest.mark.nightly)])
def test_a_mesh_is_drawn_upright(cli, vulkan, tmp_path: Path, end: str) -> None:
    """Rows and depth run the other way than in OpenGL. At silhouettes a pixel may fall to the other side.

    The whole preset, with shadows, occlusion and light of a panorama, takes three times as long: by night.
    """
    assert (compare(cli, "turntable", tmp_path, end=end) > 2e-3).mean() <= 0.002


@needs_slang
def test_controls_and_frames_reach_the_shaders(cli, graphs, vulkan, tmp_path: Path) -> None:
    """A block of numbers is packed anew for each value; another radius takes other passes."""
    graph = graphs(
        nodes={"glow": {"type": "bloom"}, "grain": {"type": "film_grain", "values": {"amount": 0.1}}},
        links={"glow.image": "light.out", "grain.image": "glow.out", "outputs.image": "grain.out"},
        controls={"size": {"target": "glow.radius"}, "glow": {"target": "glow.intensity"}},
    )
    assert cli("export", graph, "--to", "wgsl", "-o", tmp_path / "look").code == 0
    sets = ("--set", "size=0.31", "--set", "glow=0.7", "--frame", 7)
    assert cli("render", graph, "-o", tmp_path / "a.exr", "--precision", "float", *sets).code == 0
    ours = read(tmp_path / "a.exr")
    theirs = run_wgsl(tmp_path / "look", "size=0.31", "glow=0.7", "frame=7")
    assert np.abs(theirs - ours).max() <= 2e-3 * np.abs(ours).max()
    assert np.abs(run_wgsl(tmp_path / "look") - ours).max() > 0.05  # at rest it is another picture


@needs_slang
def test_frames_remember_each_other(cli, graphs, vulkan, tmp_path: Path) -> None:
    graph = graphs(
        nodes={"back": {"type": "feedback"}},
        links={"back.image": "light.out", "outputs.image": "back.out"},
        settings={"frames": [1, 5]},
    )
    assert cli("export", graph, "--to", "wgsl", "-o", tmp_path / "look").code == 0
    assert cli("render", graph, "-o", tmp_path / "a.exr", "--frame", 4, "--precision", "float").code == 0
    ours = read(tmp_path / "a.exr")
    assert np.abs(run_wgsl(tmp_path / "look", "frame=4") - ours).max() <= 2e-3 * np.abs(ours).max()


PARTS = """#version 410 core
uniform float a;
uniform vec3 b;
uniform vec2 c;
uniform mat3 m;
uniform vec4[3] rows;
uniform ivec2 grid;
uniform sampler2D t0;
uniform sampler3D table_3d;
layout(location = 0) out vec4 o0;
void main() {
    vec4 light = texelFetch(t0, ivec2(gl_FragCoord.xy), 0) + texture(table_3d, b);
    o0 = light * a + vec4(m * b, c.x) + rows[grid.x] * c.y;
}
"""


@needs_slang
def test_numbers_lie_where_the_rules_of_std140_put_them() -> None:
    """By hand from GLSL 4.60, 7.6.2.2: a vec3 and rows of arrays and matrices begin at multiples of 16 bytes."""
    program = write_wgsl(PARTS, "fragment")
    interface = program.interface
    assert interface.uniforms == {
        "a": (0, "float", 0),
        "b": (16, "float", 0),
        "c": (32, "float", 0),
        "m": (48, "float", 3),
        "rows": (96, "float", 4),
        "grid": (144, "int", 0),
    }
    assert interface.size == 160 and interface.numbers == 0
    assert set(interface.textures) == {"t0", "table_3d"} and set(interface.samplers) == {"table_3d"}
    places = [interface.numbers, *interface.textures.values(), *interface.samplers.values()]
    assert len(set(places)) == 4  # no two share a binding
    members = re.findall(r"@align\((\d+)\) (\w+)_0 :", program.text)
    assert all(interface.uniforms[name.removesuffix("_columns")][0] % int(align) == 0 for align, name in members)
    assert [name for _, name in members] == ["a", "b", "c", "m_columns", "rows", "grid"]


@needs_slang
def test_what_a_folder_says(cli, graphs, tmp_path: Path) -> None:
    assert cli("export", graphs(), "--to", "wgsl", "-o", tmp_path / "look").code == 0
    package = json.loads((tmp_path / "look/passes.json").read_text())
    files = {file.relative_to(tmp_path / "look").as_posix() for file in (tmp_path / "look").rglob("*.wgsl")}
    count = len(package["interfaces"])
    assert files == {"wgsl/cover.vert.wgsl", *(f"wgsl/{number}.frag.wgsl" for number in range(count))}
    assert len((tmp_path / "look/read_wgsl.py").read_text().splitlines()) <= 200


@needs_slang
def test_what_slang_cannot_translate_is_said() -> None:
    with pytest.raises(ValueError, match="undefined identifier"):
        write_wgsl("#version 410 core\nout vec4 o0;\nvoid main() { o0 = nothing; }\n", "fragment")


def test_without_slang_the_command_says_what_to_install(cli, graphs, tmp_path: Path, monkeypatch) -> None:
    slang._open_session.cache_clear()
    monkeypatch.setattr(slang.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(UsageError, match=r"pip install 'halation\[wgsl\]'"):
        slang.translate_by_slang("void main() {}", "fragment", "wgsl")
    result = cli("export", graphs(), "--to", "wgsl", "-o", tmp_path / "look")
    assert result.code == 2 and "halation[wgsl]" in result.err and not (tmp_path / "look").exists()


@needs_slang
@pytest.mark.nightly
@pytest.mark.timeout(600)
def test_the_programs_of_all_presets_are_translated() -> None:
    pictures = MediaProvider(sandbox=UNRESTRICTED)
    plans = [
        compile_graph(document.load(path, sandbox=UNRESTRICTED), Request(), pictures, target=TARGET) for path in paths()
    ]
    sources = {(each.shader.source, each.shader.vertex) for plan in plans for each in plan.passes}
    assert len(sources) > 150
    for fragment, vertex in sources:
        assert "fn main" in write_wgsl(fragment, "fragment").text
        assert not vertex or "fn main" in write_wgsl(vertex, "vertex").text
