"""FIFOs, sockets, devices and folders in place of files: none is waited for, and none is replaced."""

from __future__ import annotations

import json
import os
import shutil
import socket
import stat
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from halation import document, media
from halation.errors import HalationError, OutputError, UsageError
from halation.graph import Graph
from halation.media.comparison.contact_sheet import write_sheet
from halation.media.meshes.load import load_mesh
from halation.media.pictures.stored import copy_picture
from halation.nodes import Kind, SceneFile
from halation.resources.atomic_write import check_writable, write_bytes_atomically, write_text_atomically
from halation.resources.input_files import check_file, content_hash, fingerprint, open_file, read_bytes
from halation.resources.sandbox import UNRESTRICTED
from halation.watch.watching import FileWatcher

pytestmark = [
    pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no FIFOs"),
    pytest.mark.timeout(60),  # what takes longer waits for somebody to write into a FIFO
]

IMAGE = {"image": Kind.IMAGE}
PIXELS = np.full((8, 8, 4), 0.5, np.float32)


def make_fifo(path: Path) -> None:
    os.mkfifo(path)


def make_socket(path: Path) -> None:
    here = os.getcwd()  # noqa: PTH109 - names of sockets are short
    os.chdir(path.parent)
    with socket.socket(socket.AF_UNIX) as server:
        server.bind(path.name)
    os.chdir(here)


def make_device(path: Path) -> None:
    path.symlink_to("/dev/null")


def make_link(path: Path) -> None:
    os.mkfifo(path.with_name("behind"))
    path.symlink_to("behind")


SPECIAL: dict[str, Callable[[Path], None]] = {
    "FIFO": make_fifo,
    "socket": make_socket,
    "device": make_device,
    "link to a FIFO": make_link,
}


@pytest.fixture(params=SPECIAL)
def special(request: pytest.FixtureRequest, tmp_path: Path) -> Callable[[str], Path]:
    """`special("a.exr")` makes something of that name that is no file."""

    def make(name: str) -> Path:
        path = tmp_path / name
        SPECIAL[request.param](path)
        return path

    return make


def write_rows(path: Path) -> None:
    from halation.color.encoding import Encoding
    from halation.media.pictures.row_writer import ScanlineWriter

    ScanlineWriter(
        path,
        (8, 8),
        "image",
        Kind.IMAGE,
        precision="half",
        compression="zip",
        encoding=Encoding(),
        metadata={},
        sandbox=UNRESTRICTED,
    )


WRITERS: dict[str, Callable[[Path], object]] = {
    "a.txt": lambda path: write_text_atomically(path, "text", UNRESTRICTED),
    "b.png": lambda path: write_bytes_atomically(path, b"bytes", UNRESTRICTED),
    "c.exr": lambda path: check_writable(path, UNRESTRICTED),
    "d.exr": lambda path: media.write_picture(path, {"image": PIXELS}, kinds=IMAGE, sandbox=UNRESTRICTED),
    "e.png": lambda path: media.write_picture(path, {"image": PIXELS}, kinds=IMAGE, sandbox=UNRESTRICTED),
    "f.exr": write_rows,
    "g.jpg": lambda path: write_sheet(path, PIXELS[..., :3], sandbox=UNRESTRICTED),
    "h.json": lambda path: document.save(Graph(), path, sandbox=UNRESTRICTED),
    "i.exr": lambda path: copy_picture(path, Path(__file__), sandbox=UNRESTRICTED),
    "j.mkv": lambda path: media.VideoWriter(path, (8, 8), 24, sandbox=UNRESTRICTED),
}


@pytest.mark.parametrize("name", WRITERS)
def test_no_writer_replaces_what_is_no_file(special, name):
    if name.endswith("mkv"):
        pytest.importorskip("av", reason="PyAV is not installed: pip install halation[video]")
    path = special(name)
    before = path.lstat()
    with pytest.raises(OutputError, match="which is not replaced"):
        WRITERS[name](path)
    assert path.lstat().st_mode == before.st_mode and not list(path.parent.glob(".halation-*"))


READERS: dict[str, Callable[[Path], object]] = {
    "a.exr": lambda path: check_file(path, UNRESTRICTED),
    "b.exr": lambda path: fingerprint(path, UNRESTRICTED),
    "c.exr": lambda path: content_hash(path, UNRESTRICTED),
    "d.exr": lambda path: read_bytes(path, UNRESTRICTED),
    "e.exr": lambda path: open_file(path, UNRESTRICTED),
    "f.exr": lambda path: media.read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED),
    "g.json": lambda path: document.load(path, sandbox=UNRESTRICTED),
    "h.obj": lambda path: load_mesh(SceneFile(str(path), "z"), UNRESTRICTED),
    "i.mov": lambda path: media.read_info(path, sandbox=UNRESTRICTED),
}


@pytest.mark.parametrize("name", READERS)
def test_no_reader_waits_for_what_is_no_file(special, name):
    with pytest.raises(HalationError, match=r"is a (FIFO|socket|device)"):
        READERS[name](special(name))


def test_a_mesh_waits_for_no_material(tmp_path):
    make_fifo(tmp_path / "a.mtl")
    (tmp_path / "a.obj").write_text("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n")
    assert len(load_mesh(SceneFile(str(tmp_path / "a.obj"), "z"), UNRESTRICTED).indices) == 3


@pytest.mark.parametrize("has_root", [True, False])
def test_a_mesh_follows_no_link_out(tmp_path, has_root):
    """A material that is not where its name says is looked up beside the mesh, where a link may lead out."""
    (tmp_path / "secret.mtl").write_text("newmtl m\nKd 1 0 0\n")
    jail = tmp_path / "jail"
    jail.mkdir()
    (jail / "m.mtl").symlink_to("../secret.mtl")
    (jail / "a.obj").write_text("mtllib gone/m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n")
    mesh = load_mesh(SceneFile(str(jail / "a.obj"), "z"), UNRESTRICTED.narrow(jail) if has_root else UNRESTRICTED)
    assert mesh.vertices[0, 8:11].tolist() != [1.0, 0.0, 0.0]


def test_a_watcher_waits_for_nothing(tmp_path):
    make_fifo(tmp_path / "graph.json")
    watcher = FileWatcher(UNRESTRICTED)
    watcher.watch(tmp_path / "graph.json", code=[tmp_path / "graph.json"])
    assert watcher.poll() == ()
    watcher.close()


def link(type: str, output: str = "out", **parts: object) -> dict[str, object]:
    linked = {"r.image": "n.out"} if type in ("lut_file", "glsl") else {}
    return {
        "nodes": {"r": {"type": type, **parts}, "n": {"type": "noise"}},
        "links": {**linked, "outputs.image": f"r.{output}"},
    }


NAMED: dict[str, tuple[str, dict[str, object]]] = {
    "an input": (
        "x.exr",
        {"inputs": {"b": {"type": "Image", "file": "x.exr"}}, "links": {"outputs.image": "inputs.b"}},
    ),
    "a video": ("x.mov", {"inputs": {"b": {"type": "Image", "file": "x.mov"}}, "links": {"outputs.image": "inputs.b"}}),
    "read_image": ("x.exr", link("read_image", values={"path": "x.exr"})),
    "a render": ("x.exr", link("read_render", "color", values={"path": "x.exr"})),
    "a table": ("x.cube", link("lut_file", values={"file": "x.cube"})),
    "a mesh": ("x.obj", link("scene", "color", values={"scene": "file", "file": "x.obj"})),
    "a group": ("x.json", link("group", path="x.json")),
    "code": ("x.glsl", link("glsl", file="x.glsl")),
    "a shader": ("x.fs", link("isf", file="x.fs")),
    "a config": (
        "x.ocio",
        {
            "nodes": {"n": {"type": "noise"}},
            "links": {"outputs.image": "n.out"},
            "settings": {"size": [16, 16], "color": {"config": "x.ocio", "working": "ACEScg"}},
        },
    ),
    "a reference": ("x.ctf", link("lut_file", values={"file": "a.ctf"})),
}
REFERENCE = '<ProcessList id="a" version="1.7"><Reference inBitDepth="32f" outBitDepth="32f" path="{}"/></ProcessList>'


@pytest.mark.parametrize("what", NAMED)
def test_commands_wait_for_nothing_that_a_graph_names(cli, tmp_path, monkeypatch, what):
    monkeypatch.chdir(tmp_path)
    name, tree = NAMED[what]
    make_fifo(tmp_path / name)
    (tmp_path / "a.ctf").write_text(REFERENCE.format(tmp_path / "x.ctf"))
    tree = {"settings": {"size": [16, 16]}, **tree, "halation": 1, "outputs": {"image": {"type": "Image"}}}
    (tmp_path / "graph.json").write_text(json.dumps(tree))
    for words in (("check",), ("explain",), ("render", "-o", "out.exr")):
        result = cli(words[0], "graph.json", *words[1:])
        is_unneeded = what == "a config" and words[0] == "explain"
        assert result.code in (3, 4) or is_unneeded, result
    assert not (tmp_path / "out.exr").exists()


@pytest.mark.parametrize(
    "words",
    [
        ("check", "x"),
        ("explain", "x"),
        ("render", "x", "-o", "out.exr"),
        ("info", "x"),
        ("nodes", "x.glsl"),
        ("fmt", "x"),
        ("diff", "x", "graph.json"),
        ("merge", "graph.json", "x", "graph.json"),
        ("test", "x.suite.toml"),
        ("reproduce", "x"),
        ("sweep", "x", "-o", "out.png", "--set", "n.size=1,2"),
        ("bench", "x"),
        ("bench", "graph.json", "--compare", "x", "--size", "8x8", "-n", "1"),
        ("export-isf", "x"),
        ("render", "input.json", "-i", "x", "-o", "out.exr"),
    ],
    ids=" ".join,
)
def test_commands_wait_for_nothing_that_is_typed(cli, tmp_path, monkeypatch, words):
    monkeypatch.chdir(tmp_path)
    write_graphs(tmp_path)
    for name in ("x", "x.glsl", "x.suite.toml"):
        make_fifo(tmp_path / name)
    result = cli(*words)
    assert result.code in (1, 2, 3, 4) and "is a FIFO" in result.out + result.err, result


def test_a_color_config_of_the_environment_is_a_file(cli, tmp_path, monkeypatch):
    write_graphs(tmp_path)
    make_fifo(tmp_path / "config.ocio")
    monkeypatch.setenv("OCIO", str(tmp_path / "config.ocio"))
    result = cli("render", tmp_path / "graph.json", "-o", tmp_path / "out.png")
    assert result.code == 2 and "is a FIFO" in result.err, result


def write_graphs(folder: Path) -> None:
    tree = {
        "halation": 1,
        "settings": {"size": [16, 16]},
        "outputs": {"image": {"type": "Image"}},
        "nodes": {"n": {"type": "noise"}},
        "links": {"outputs.image": "n.out"},
    }
    (folder / "graph.json").write_text(json.dumps(tree))
    ends = {"inputs": {"b": {"type": "Image"}}, "links": {"outputs.image": "inputs.b"}}
    (folder / "input.json").write_text(json.dumps({**tree, **ends, "nodes": {}}))
    (folder / "cases.suite.toml").write_text('[cases.a]\ngraph = "graph.json"\ngolden = "x.exr"\n')


@pytest.mark.parametrize(
    "words",
    [
        ("render", "graph.json", "-o", "x.exr"),
        ("render", "graph.json", "-o", "x.png"),
        ("render", "graph.json", "-o", "x.####.exr", "--frames", "1"),
        ("render", "graph.json", "-o", "x.mkv"),
        ("sweep", "graph.json", "-o", "x.png", "--set", "n.size=1,2"),
        ("merge", "graph.json", "graph.json", "graph.json", "-o", "x.json"),
        ("check", "graph.json", "--sarif", "x.json"),
        ("diff", "graph.json", "graph.json", "--render", "-o", "x.png"),
        ("test", "cases.suite.toml", "--update"),
        ("test", "cases.suite.toml", "--report", "x.html"),
        ("test", "cases.suite.toml", "--junit", "x.xml"),
        ("fit", "graph.json", "--to", "r.png", "--values", "n.size", "--renders", "2", "-o", "x.json"),
        ("fit", "graph.json", "--to", "r.png", "--values", "n.size", "-o", "o.json", "--report", "x.html"),
        ("export", "input.json", "--to", "isf", "-o", "x.fs"),
        ("export", "input.json", "--to", "cube", "-o", "x.cube"),
        ("export", "graph.json", "--to", "web", "-o", "x.html"),
        ("submit", "graph.json", "-o", "o.####.exr", "--slurm", "x.sh"),
        ("submit", "graph.json", "-o", "o.####.exr", "--openjd", "x.json"),
        ("submit", "graph.json", "-o", "o.####.exr", "--actions", "x.yml"),
        ("explain", "graph.json", "--html", "x.html"),
        ("reproduce", "r.png", "-o", "x.exr"),
        ("thumbnail", "graph.json", "x.png"),
    ],
    ids=" ".join,
)
def test_no_command_replaces_what_is_no_file(cli, tmp_path, monkeypatch, words):
    monkeypatch.chdir(tmp_path)
    write_graphs(tmp_path)
    assert cli("render", "graph.json", "-o", "r.png").code == 0
    endings = ("exr", "png", "0001.exr", "mkv", "json", "html", "xml", "fs", "cube", "sh", "yml")
    names = tuple(f"x.{ending}" for ending in endings)
    for name in names:
        make_fifo(tmp_path / name)
    result = cli(*words)
    assert result.code in (1, 2) and "is a FIFO" in result.out + result.err, result
    assert all(stat.S_ISFIFO((tmp_path / name).lstat().st_mode) for name in names)


def test_a_formatted_graph_stays_a_file(cli, tmp_path):
    """A FIFO behind a link is no graph; a graph behind a link stays behind it."""
    write_graphs(tmp_path)
    (tmp_path / "link.json").symlink_to("graph.json")
    assert cli("fmt", tmp_path / "link.json").code == 0
    assert (tmp_path / "link.json").is_symlink() and (tmp_path / "graph.json").read_text().startswith("{\n")


def test_null_devices_of_git_are_empty():
    from halation.cli.git_driver import _read_text

    assert _read_text(os.devnull) == ""


def test_a_report_is_refused_before_anything_is_rendered(tmp_path):
    from halation.regression.report import check_report

    make_fifo(tmp_path / "x.html")
    with pytest.raises(UsageError, match="is a FIFO"):
        check_report(tmp_path / "x.html", sandbox=UNRESTRICTED)


def test_folders_are_not_made_outside(cli, tmp_path):
    jail = tmp_path / "jail"
    jail.mkdir()
    write_graphs(jail)
    words = ("--set", "n.size=1,2", "--root", jail)
    assert cli("sweep", jail / "graph.json", "-o", jail / "a.png", "--cells", tmp_path / "out", *words).code == 1
    shutil.rmtree(jail / "pictures", ignore_errors=True)
    for kind in ("glsl", "web"):
        assert cli("export", jail / "graph.json", "--to", kind, "-o", tmp_path / "out", "--root", jail).code == 1
    (jail / "cases.suite.toml").write_text('[cases.a]\ngraph = "graph.json"\ngolden = "../out/x.exr"\n')
    assert cli("test", jail / "cases.suite.toml", "--update", "--root", jail).code == 1
    assert not (tmp_path / "out").exists()
