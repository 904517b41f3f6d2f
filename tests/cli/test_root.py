"""`--root`: a graph reads and writes below one folder only, whatever it names."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import PyOpenColorIO as ocio
import pytest
from exr_files import write_exr
from halation import presets
from halation.cli.program import WITHOUT_ROOT, Commands
from halation.renderer.jobs.render_job import RenderJob, worker_command
from halation.resources.sandbox import ROOT_VARIABLE, Sandbox

CUBE = "LUT_3D_SIZE 2\n" + "".join(f"{r} {g} {b}\n" for b in (0, 1) for g in (0, 1) for r in (0, 1))
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
GLSL = "vec4 pixel(vec4 image) { return image; }\n"
SHADER = '/*{"INPUTS": [], "ISFVSN": "2"}*/\nvoid main() { gl_FragColor = vec4(1.0); }\n'


def picture(path: Path) -> Path:
    return write_exr(path, {"Combined": np.ones((8, 8, 4), np.float32)}, {"Combined": "half"})


@pytest.fixture
def yard(tmp_path: Path) -> Path:
    """fence/ and, beside it, out/ with one file of every kind; fence/link leads there."""
    (tmp_path / "fence").mkdir()
    out = tmp_path / "out"
    out.mkdir()
    picture(out / "shot.exr")
    picture(out / "shot.0001.exr")
    (out / "table.cube").write_text(CUBE)
    (out / "mesh.obj").write_text(TRIANGLE)
    (out / "code.glsl").write_text(GLSL)
    (out / "code.fs").write_text(SHADER)
    (out / "group.json").write_text(
        json.dumps(
            {
                "halation": 1,
                "outputs": {"out": {"type": "Image"}},
                "nodes": {"n": {"type": "noise"}},
                "links": {"outputs.out": "n.out"},
            }
        )
    )
    (out / "config.ocio").write_text(ocio.Config.CreateFromBuiltinConfig("cg-config-latest").serialize())
    (tmp_path / "fence" / "link").symlink_to(out)
    return tmp_path


def node(type: str, output: str = "out", **parts: object) -> dict[str, object]:
    linked = {"r.image": "n.out"} if type in ("lut_file", "glsl") else {}
    return {
        "nodes": {"r": {"type": type, **parts}, "n": {"type": "noise"}},
        "links": {**linked, "outputs.image": f"r.{output}"},
        "settings": {"size": [16, 16]},
    }


NAMED = {
    "an input": (
        "shot.exr",
        lambda path: {
            "inputs": {"b": {"type": "Image", "file": path}},
            "links": {"outputs.image": "inputs.b"},
        },
    ),
    "a sequence": (
        "shot.####.exr",
        lambda path: {
            "inputs": {"b": {"type": "Image", "file": path}},
            "links": {"outputs.image": "inputs.b"},
        },
    ),
    "read_image": ("shot.exr", lambda path: node("read_image", values={"path": path})),
    "a render": ("shot.exr", lambda path: node("read_render", "color", values={"path": path})),
    "a table": ("table.cube", lambda path: node("lut_file", values={"file": path})),
    "a mesh": ("mesh.obj", lambda path: node("scene", "color", values={"scene": "file", "file": path})),
    "a group": ("group.json", lambda path: node("group", path=path)),
    "code": ("code.glsl", lambda path: node("glsl", file=path)),
    "a shader": ("code.fs", lambda path: node("isf", file=path)),
    "a config": (
        "config.ocio",
        lambda path: {
            "nodes": {"n": {"type": "noise"}},
            "links": {"outputs.image": "n.out"},
            "settings": {"size": [16, 16], "color": {"config": path}},
        },
    ),
}


def written(yard: Path, tree: dict[str, object]) -> Path:
    path = yard / "fence" / "graph.json"
    path.write_text(json.dumps({"halation": 1, "outputs": {"image": {"type": "Image"}}, **tree}))
    return path


def test_presets_are_rendered_inside(cli, yard):
    """By their names, with their samples, and not over them."""
    shown = cli("render", "bleach_bypass", "-o", yard / "fence" / "o.png", "--scale", "0.1", "--root", yard / "fence")
    assert shown.code == 0 and (yard / "fence" / "o.png").exists()
    over = presets.sample().with_name("over.png")
    refused = cli("render", "bleach_bypass", "-o", over, "--root", yard / "fence")
    assert refused.code == 1 and "lies outside of" in refused.err and not over.exists()


@pytest.mark.parametrize("what", NAMED)
@pytest.mark.parametrize("way", ["../out/", "link/", "absolute"])
def test_what_a_graph_names_outside_is_refused(cli, yard, what, way):
    name, tree = NAMED[what]
    path = str(yard / "out" / name) if way == "absolute" else f"{way}{name}"
    graph, fence = written(yard, tree(path)), yard / "fence"
    refused = cli("render", graph, "-o", fence / "a.png", "--root", fence)
    assert refused.code in (3, 4) and "lies outside of" in refused.err, refused
    assert not (fence / "a.png").exists() and ROOT_VARIABLE not in os.environ
    if what != "a config":  # which nothing needs before there are pixels
        assert "lies outside of" in cli("explain", graph, "--root", fence).err
        assert "lies outside of" in cli("check", graph, "--root", fence).out
    assert cli("check", graph).code == 0


@pytest.mark.parametrize("what", NAMED)
def test_the_same_inside_is_read(cli, yard, what):
    name, tree = NAMED[what]
    shutil.copytree(yard / "out", yard / "fence" / "data")
    graph, fence = written(yard, tree(f"data/../data/{name}")), yard / "fence"
    result = cli("render", graph, "-o", fence / "a.png", "--root", fence)
    assert result.code == 0, result.err
    assert (fence / "a.png").is_file()


def test_tables_of_a_config(cli, yard):
    """A config inside, whose color space reads a table outside."""
    config = ocio.Config.CreateFromBuiltinConfig("cg-config-latest")
    config.addColorSpace(ocio.ColorSpace(name="odd", toReference=ocio.FileTransform("../out/table.cube")))
    (yard / "fence" / "config.ocio").write_text(config.serialize())
    graph = written(yard, NAMED["a config"][1]("config.ocio"))
    result = cli("render", graph, "-o", yard / "fence" / "a.png", "--root", yard / "fence")
    assert result.code == 3 and "table.cube lies outside of" in result.err


BLACK = """<?xml version="1.0"?><ProcessList id="black" {version}><Matrix inBitDepth="32f" outBitDepth="32f">
<Array dim="3 3">0 0 0 0 0 0 0 0 0</Array></Matrix></ProcessList>"""
REFERENCE = (
    '<?xml version="1.0"?><ProcessList id="a" {version}>'
    '<Reference inBitDepth="32f" outBitDepth="32f" path="{path}"/></ProcessList>'
)
VERSIONS = {"clf": 'compCLFversion="3"', "ctf": 'version="1.7"'}


def refer(ending: str, path: object) -> str:
    """A table that is nothing but a reference to another one."""
    return REFERENCE.format(version=VERSIONS[ending], path=path)


def assert_black_only_without_root(cli, graph: Path, fence: Path) -> None:
    """The file outside is read if it may be, by another process: libraries remember what they have read."""
    command = [sys.executable, "-m", "halation.cli", "render", str(graph), "-o", str(fence / "a.exr")]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert ended.returncode == 0, ended.stderr
    assert not oiio.ImageBuf(str(fence / "a.exr")).get_pixels(oiio.FLOAT)[..., :3].any()
    refused = cli("render", graph, "-o", fence / "b.exr", "--root", fence)
    assert refused.code in (3, 4) and "lies outside of" in refused.err, refused
    assert not (fence / "b.exr").exists()


@pytest.mark.parametrize("ending", VERSIONS)
@pytest.mark.parametrize("way", ["../out/secret", "link/secret", "absolute", "by another"])
def test_references_of_tables(cli, yard, monkeypatch, ending, way):
    """A table inside refers to one outside, which makes the picture black: nobody may see that it does."""
    fence, secret = yard / "fence", yard / "out" / f"secret.{ending}"
    secret.write_text(BLACK.format(version=VERSIONS[ending]))
    path = secret if way == "absolute" else f"{'../out/secret' if way == 'by another' else way}.{ending}"
    if way == "by another":
        (fence / f"b.{ending}").write_text(refer(ending, path))
        path = f"b.{ending}"
    (fence / f"a.{ending}").write_text(refer(ending, path))
    monkeypatch.chdir(fence)  # where OpenColorIO looks for names in a table that no config names
    graph = written(yard, node("lut_file", values={"file": f"a.{ending}"}))
    assert_black_only_without_root(cli, graph, fence)


@pytest.mark.parametrize("ending", VERSIONS)
def test_references_of_tables_of_a_config(cli, yard, ending):
    """The table that the config names lies inside, and refers to one outside."""
    fence, secret = yard / "fence", yard / "out" / f"secret.{ending}"
    secret.write_text(BLACK.format(version=VERSIONS[ending]))
    (fence / f"a.{ending}").write_text(refer(ending, f"../out/secret.{ending}"))
    config = ocio.Config.CreateFromBuiltinConfig("cg-config-latest")
    config.addColorSpace(ocio.ColorSpace(name="odd", toReference=ocio.FileTransform(f"a.{ending}")))
    (fence / "config.ocio").write_text(config.serialize())
    picture(fence / "shot.exr")
    parts = NAMED["an input"][1]("shot.exr") | {"settings": {"color": {"config": "config.ocio"}}}
    parts["inputs"]["b"]["color_space"] = "odd"
    graph = written(yard, parts)
    assert_black_only_without_root(cli, graph, fence)


@pytest.mark.parametrize("name", ["../a.png", "link/a.png", "../a.####.png", "../a.exr", "../a.mkv"])
def test_what_is_written_outside_is_refused(cli, yard, name):
    graph, fence = (
        written(
            yard,
            {
                "nodes": {"n": {"type": "noise"}},
                "links": {"outputs.image": "n.out"},
                "settings": {"size": [16, 16], "frames": [1, 2]},
            },
        ),
        yard / "fence",
    )
    if name.endswith("mkv"):
        pytest.importorskip("av", reason="PyAV is not installed: pip install halation[video]")
    words = ("--frame", 1) if name.endswith(("exr", "a.png")) else ()
    result = cli("render", graph, "-o", fence / name, "--root", fence, *words)
    assert result.code == 1 and "lies outside of" in result.err
    assert not list(yard.glob("a.*")) and not list((yard / "out").glob("a.*"))


def test_what_is_bound_and_what_is_looked_at(cli, yard):
    graph, fence = written(yard, NAMED["an input"][1]("")), yard / "fence"
    bound = cli("render", graph, "-i", yard / "out" / "shot.exr", "-o", fence / "a.png", "--root", fence)
    assert bound.code == 4 and "lies outside of" in bound.err
    assert cli("info", yard / "out" / "shot.exr", "--root", fence).code == 4
    (yard / "graph.json").write_text(graph.read_text())
    assert "lies outside of" in cli("explain", yard / "graph.json", "--root", fence).err
    assert cli("render", graph, "-o", fence / "a.png", "--root", yard / "nowhere").code == 2


def test_processes_that_share_frames_are_inside_too(yard):
    """A picture that becomes a link to one outside is refused by those that read it."""
    fence = yard / "fence"
    picture(fence / "in.0001.exr")
    (fence / "in.0002.exr").symlink_to(yard / "out" / "shot.exr")
    graph = written(yard, NAMED["an input"][1]("in.####.exr"))
    result = subprocess.run(
        [sys.executable, "-m", "halation.cli", "render", graph, "-o", fence / "a.####.png", "--root", fence, "-j2"],
        capture_output=True,
        text=True,
        env={**os.environ, "LP_NUM_THREADS": "1"},
    )
    assert result.returncode == 4 and "in.0002.exr: lies outside of" in result.stderr
    assert not (fence / "a.0002.png").exists()


def test_a_job_carries_its_root(yard):
    """A worker that is started elsewhere, without this environment, is in the same sandbox."""
    fence = yard / "fence"
    for file, code in ((yard / "out" / "shot.exr", 4), (picture(fence / "shot.exr"), 0)):
        graph = written(yard, NAMED["an input"][1](str(file)))
        job = RenderJob(graph=str(graph), destinations=(("", str(fence / "a.png")),), sandbox=Sandbox(str(fence)))
        result = subprocess.run(worker_command(), input=job.to_json(), capture_output=True, text=True)
        assert result.returncode == code, result.stderr


OUTSIDE: dict[str, tuple[object, ...]] = {
    "render": ("{out}/group.json", "-o", "{fence}/a.png"),
    "submit": ("{out}/group.json", "-o", "{fence}/a.png", "--slurm", "{fence}/job.sh"),
    "serve": ("--socket", "{out}/server"),
    "check": ("{out}/group.json",),
    "explain": ("{out}/group.json",),
    "info": ("{out}/shot.exr",),
    "nodes": ("{out}/code.glsl",),
    "fmt": ("{out}/group.json",),
    "diff": ("{out}/group.json", "{fence}/graph.json"),
    "merge": ("{fence}/graph.json", "{out}/group.json", "{fence}/graph.json"),
    "test": ("{out}/cases.suite.toml",),
    "reproduce": ("{out}/shot.exr",),
    "watch": ("{out}/group.json", "-o", "{fence}/a.png"),
    "sweep": ("{out}/group.json", "-o", "{fence}/a.png", "--set", "n.size=1,2"),
    "fit": ("{out}/group.json", "--to", "{out}/shot.exr", "--values", "n.*", "-o", "{fence}/fitted.json"),
    "bench": ("{out}/group.json",),
    "export": ("{out}/group.json", "--to", "isf"),
    "export-isf": ("{out}/group.json",),
}
"""For each command that takes `--root`, words that name a file outside of it."""


def test_every_command_has_the_option_or_says_why_not() -> None:
    commands = {name for name, command in Commands().items() if any(item.name == "root" for item in command.params)}
    assert commands == set(Commands()) - set(WITHOUT_ROOT)
    missing = commands - set(OUTSIDE)
    assert not missing, f"add words for {missing} to OUTSIDE in {__file__}, or name them in WITHOUT_ROOT of program.py"
    assert commands == set(OUTSIDE)


@pytest.mark.parametrize("name", sorted(set(OUTSIDE) - {"watch"}))
def test_no_command_reads_outside(cli, yard, name):
    (yard / "out" / "cases.suite.toml").write_text('[cases.a]\ngraph = "group.json"\ngolden = "a.exr"\n')
    written(yard, NAMED["an input"][1](""))
    words = [str(word).format(out=yard / "out", fence=yard / "fence") for word in OUTSIDE[name]]
    result = cli(name, *words, "--root", yard / "fence")
    assert result.code != 0 and "lies outside of" in result.out + result.err, result


def test_watch_reads_nothing_outside_either(yard):
    """It says so, and waits for a change."""
    words = [word.format(out=yard / "out", fence=yard / "fence") for word in OUTSIDE["watch"]]
    command = [sys.executable, "-m", "halation.cli", "watch", *words, "--root", yard / "fence"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        lines = [process.stderr.readline() for _ in range(2)]
        process.kill()
    assert "lies outside of" in lines[1], lines
