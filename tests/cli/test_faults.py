"""Bad input: one sentence that names file or JSON path, the documented exit code, nothing lost."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import moderngl
import numpy as np
import pytest
from halation import renderer
from oiio_pictures import write_picture

REAL_DEVICE = renderer.open_device


# --- pictures -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("share", [0.02, 0.3, 0.97])
def test_a_truncated_exr(fails, graphs, shot, share):
    data = shot.read_bytes()
    shot.write_bytes(data[: int(len(data) * share)])
    path = graphs(
        inputs={"depth": {"type": "Field", "file": "shot.exr", "layer": "Depth"}},
        outputs={"far": {"type": "Field"}},
        links={"outputs.far": "inputs.depth"},
    )
    said = fails(4, "render", path)
    assert said.endswith(f"': {shot}: is cut short or damaged: copy or render it again") and said.startswith("input '")


def test_an_empty_picture(fails, graphs, shot):
    shot.write_bytes(b"")
    assert fails(4, "render", graphs()) == f"input 'beauty': {shot}: is empty (0 bytes): copy or render it again"


def test_a_missing_layer(fails, graphs, shot):
    said = fails(4, "render", graphs(), "-i", f"beauty={shot}:Depht")
    assert said.startswith(f"input 'beauty': {shot}: ") and "'Depht'" in said and "Depth" in said
    path = graphs(
        inputs={"depth": {"type": "Field", "file": "shot.exr", "layer": "Depht"}},
        outputs={"far": {"type": "Field"}},
        links={"outputs.far": "inputs.depth"},
    )
    assert fails(4, "render", path) == said.replace("'beauty'", "'depth'")


def test_a_missing_picture(fails, graphs, tmp_path):
    path = graphs(inputs={"beauty": {"type": "Image", "file": "shto.exr"}})
    assert (
        fails(4, "render", path)
        == f"input 'beauty': {tmp_path / 'shto.exr'}: there is no such file; did you mean 'shot.exr'?"
    )


def test_an_input_that_nobody_filled(fails, graphs):
    path = graphs(inputs={"beauty": {"type": "Image"}})
    said = fails(3, "render", path)
    assert "'beauty'" in said


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("-i", "beuaty=a.exr"), "-i beuaty=a.exr: the graph has no input 'beuaty'; did you mean 'beauty'?"),
        (("-i", "beauty="), "-i beauty=: write -i NAME=VALUE"),
        (("-i", "beauty=0.5"), "-i beauty=0.5: an input takes a file; set a number with --set NODE.VALUE=0.5"),
        (("-i", "beauty=a.exr", "-i", "beauty=b.exr"), "-i beauty=b.exr: 'beauty' is given twice"),
    ],
)
def test_an_unknown_input(fails, graphs, words, sentence):
    assert fails(2, "render", graphs(), *words) == sentence


# --- graphs -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "the file is empty"),
        ("   \n", "the file is empty"),
        ("{", "not valid JSON: "),
        ("[1]", "expected an object, got a list"),
        ('{"halation":99}', "halation: "),
        ('{"halation":1,"nodes":{"a":{"type":"exposure","values":{"stops":NaN}}}}', "nodes.a.values.stops: "),
        ('{"halation":1,"nodes":{"a":{"type":"exposure","values":{"stops":"x"}}}}', "nodes.a.values.stops: "),
        ('{"halation":1,"nodes":[]}', "nodes: "),
        ('{"halation":1,"ui":' + "[" * 100_000 + "]" * 100_000 + "}", "objects and lists nest deeper than "),
        ('{"halation":1,"links":{"a":3}}', "links.a: "),
    ],
    ids=["empty", "blank", "cut", "list", "newer", "nan", "word", "type", "deep", "link"],
)
def test_a_file_that_is_no_graph(fails, tmp_path, text, sentence):
    path = tmp_path / "bad.json"
    path.write_text(text)
    assert fails(3, "render", path).startswith(f"{path}: {sentence}")


def test_a_graph_of_100_megabytes(fails, tmp_path):
    path = tmp_path / "large.json"
    with path.open("wb") as file:
        file.truncate(100 * 2**20)
    assert fails(3, "render", path) == f"{path}: the file has more than 32 MB; that is no graph"


def test_a_graph_that_is_not_there(fails, tmp_path):
    assert fails(3, "render", tmp_path / "no.json") == f"{tmp_path / 'no.json'}: there is no such file"
    assert "folder" in fails(3, "render", tmp_path)


@pytest.mark.parametrize(
    ("parts", "sentence"),
    [
        ({"nodes": {"light": {"type": "exposrue"}}}, "unknown type 'exposrue'; did you mean 'exposure'?"),
        ({"nodes": {"vig": {"type": "vignette", "values": {"amount": 2.0}}}}, "vig.amount: 2.0 is outside the range"),
        ({"links": {"light.image": "inputs.beuaty"}}, "'beuaty'"),
        ({"links": {"light.imgae": "inputs.beauty"}}, "node 'light' has no input 'imgae'; did you mean 'image'?"),
        ({"links": {"outputs.image": "light.uot"}}, "node 'light' has no output 'uot'"),
        ({"links": {"outputs.image": "lihgt.out"}}, "there is no node 'lihgt'; did you mean 'light'?"),
        (
            {
                "nodes": {"pair": {"type": "combine_vector2"}, "light": {"type": "exposure"}},
                "links": {"light.image": "pair.out"},
            },
            "'pair.out' cannot feed 'light.image'",
        ),
        (
            {"nodes": {"back": {"type": "exposure"}}, "links": {"back.image": "light.out", "light.image": "back.out"}},
            "back",
        ),
    ],
    ids=["type", "range", "input", "socket", "output", "node", "kind", "cycle"],
)
def test_a_graph_that_cannot_work(fails, cli, graphs, parts, sentence):
    path = graphs(**parts)
    said = fails(3, "render", path)
    assert said.startswith(f"{path}: ") and sentence in said
    checked = cli("check", path)
    assert checked.code == 3 and ": error: " in checked.out and sentence in checked.out


def test_the_first_of_several_problems_counts_the_others(fails, graphs):
    path = graphs(nodes={"a": {"type": "nonsense"}, "b": {"type": "nonsense"}})
    assert fails(3, "render", path).endswith(f"(and 1 more: halation check {path})")


# --- devices ------------------------------------------------------------------------------------------------------


class Old:
    """A context of a driver from 2010."""

    version_code = 330
    info = {"GL_RENDERER": "Old Card", "GL_MAX_TEXTURE_SIZE": 8192, "GL_MAX_TEXTURE_IMAGE_UNITS": 16}  # noqa: RUF012


def test_no_opengl(fails, graphs, monkeypatch):
    def missing(**_):
        raise Exception("libEGL.so.1 not loaded")

    monkeypatch.setattr(renderer, "open_device", REAL_DEVICE)
    monkeypatch.setattr(moderngl, "create_context", missing)
    said = fails(5, "render", graphs())
    assert said.startswith("OpenGL 4.1 cannot be opened (libEGL.so.1 not loaded")
    if sys.platform == "linux":
        assert said.endswith("(Debian, Ubuntu: apt-get install libegl1 libgl1)")


def test_an_opengl_that_is_too_old(fails, graphs, monkeypatch):
    monkeypatch.setattr(renderer, "open_device", REAL_DEVICE)
    monkeypatch.setattr(moderngl, "create_context", lambda **_: Old())
    assert fails(5, "render", graphs()).startswith("Old Card offers OpenGL 3.3, but at least 4.1 is needed: ")


def test_more_pixels_than_can_be_made_in_parts(fails, graphs):
    said = fails(5, "render", graphs(), "--size", "99999x99999")
    assert "99999x99999" in said and "--scale or --size" in said


def test_more_pixels_than_this_machine_can_hold(fails, graphs, monkeypatch):
    pages = os.sysconf
    monkeypatch.setattr(os, "sysconf", lambda name: 100 if name == "SC_PHYS_PAGES" else pages(name))
    assert fails(5, "render", graphs(), "--size", "99999x16").startswith("the outputs take ")


def test_a_shader_that_the_driver_refuses(fails, graphs, monkeypatch):
    from halation import compiler
    from halation.compiler.library import parse

    code = "vec4 exposure(vec4 image, float stops) {\n    return image * stosp;\n}\n"
    library = compiler.Library({**compiler.load_library().texts, "color/exposure": parse("color/exposure", code)})
    monkeypatch.setattr(compiler.planner, "load_library", lambda: library)
    said = fails(5, "render", graphs())
    assert said.startswith("node 'light': shaders/color/exposure.glsl, line 2: ") and "stosp" in said


# --- the command line itself --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("rendr", "x"), "'rendr'"),
        (("fmt", "--chekc", "x"), "--check"),
        (("nodes", "blom"), "there is no node, menu or installed plug-in 'blom'; did you mean 'bloom'?"),
        (("check",), "halation check --help"),
        (("explain", "x", "--scale", "wide"), "--scale"),
    ],
)
def test_words_that_make_no_sense(fails, words, sentence):
    assert sentence in fails(2, *words)


def test_render_without_a_destination(cli, graphs):
    result = cli("render", graphs())
    assert result.code == 2 and "'--output'" in result.err and "see halation render --help" in result.err


def test_a_bug_is_called_a_bug(cli, graphs, tmp_path, monkeypatch):
    from halation.renderer.jobs import job

    monkeypatch.setattr(job, "run_job", lambda *_, **__: 1 / 0)
    result = cli("render", graphs(), "-o", tmp_path / "out.exr", "--json")
    assert result.code == 70 and json.loads(result.out)["error"]["kind"] == "Bug"
    assert "this is a bug in Halation (ZeroDivisionError: division by zero)" in result.err
    assert "Traceback" not in result.err
    monkeypatch.setenv("HALATION_DEBUG", "1")
    with pytest.raises(ZeroDivisionError):
        cli("render", graphs(), "-o", tmp_path / "out.exr")


def test_too_little_memory(fails, graphs, monkeypatch):
    def refuse(*_, **__):
        raise MemoryError

    from halation.renderer.jobs import job

    monkeypatch.setattr(job, "run_job", refuse)
    assert fails(1, "render", graphs()) == "there is not enough memory; render a smaller picture with --scale or --size"


def test_a_node_that_cannot_be_imported_is_no_bug_of_halation(cli, monkeypatch):
    """Whoever writes a node in a checkout is told the file and the line."""
    from halation.nodes import NodeImportError, built_in_nodes

    def fail(self, id):
        raise NodeImportError("nodes/color/mine.py, line 38: SyntaxError: '(' was never closed")

    monkeypatch.setattr(type(built_in_nodes()), "__getitem__", fail)
    result = cli("nodes", "exposure")
    assert (result.code, result.err) == (
        1,
        "halation: nodes/color/mine.py, line 38: SyntaxError: '(' was never closed\n",
    )


def test_a_place_for_the_frame_that_is_too_wide_is_a_fault_of_the_graph(fails, tmp_path):
    path = tmp_path / "graph.json"
    ends = {"inputs": {"a": {"type": "Image", "file": "$F99999"}}, "outputs": {"image": {"type": "Image"}}}
    path.write_text(json.dumps({"halation": 1, **ends, "links": {"outputs.image": "inputs.a"}}))
    assert "more than 16 digits for a frame" in fails(3, "render", path)


def test_what_libraries_print_is_not_beside_the_sentence(tmp_path):
    """libpng writes lines of its own to the standard error of C."""
    path = tmp_path / "cut.png"
    write_picture(path, np.random.default_rng(1).random((64, 64, 4), np.float32), format="uint8")
    data = bytearray(path.read_bytes())
    place = data.index(b"IDAT") + 40
    data[place : place + 8] = b"\xff" * 8
    path.write_bytes(bytes(data))
    graph = {"nodes": {"r": {"type": "read_image", "values": {"path": str(path)}}}, "links": {"outputs.image": "r.out"}}
    file = tmp_path / "graph.json"
    file.write_text(json.dumps({"halation": 1, "outputs": {"image": {"type": "Image"}}, **graph}))
    words = [sys.executable, "-m", "halation.cli", "render", file, "-o", tmp_path / "out.png"]
    ended = subprocess.run(words, capture_output=True, text=True, timeout=100)
    assert ended.returncode == 4
    device, *lines = ended.stderr.splitlines()
    assert "rasterizer" in device or "GL" in device
    assert len(lines) == 1 and lines[0].startswith("halation: ") and "cut.png" in lines[0]


def test_a_picture_without_its_option_says_how_it_is_bound(cli):
    said = cli("render", "soft_bloom", "shot.exr")
    assert said.code == 2 and "pictures are bound with -i NAME=FILE" in said.err


# --- words without a value ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("fmt", ""), "word 2 of the command"),
        (("check", "", "--strict"), "word 2 of the command"),
        (("render", "look.json", "-o", ""), "what follows -o"),
        (("render", "look.json", "-o", "x.png", "--root="), "--root=: what follows ="),
        (("render", "look.json", "-i", "", "-o", "x.png"), "what follows -i"),
        (("gallery", "-o", ""), "what follows -o"),
        (("export", "look.json", "--to", "glsl", "-o", ""), "what follows -o"),
        (("", "look.json"), "word 1 of the command"),
    ],
)
def test_a_variable_of_the_shell_without_a_value(cli, tmp_path, monkeypatch, words, said):
    """The empty name of a file would be the current folder, in which `fmt` would rewrite every graph."""
    monkeypatch.chdir(tmp_path)
    text = '{"halation":1,"nodes":{},"links":{},"inputs":{},"outputs":{}}'
    (tmp_path / "look.json").write_text(text)
    result = cli(*words)
    assert result.code == 2 and result.err == f"halation: {said} is empty: has a variable of the shell no value?\n"
    assert [path.name for path in tmp_path.iterdir()] == ["look.json"] and (tmp_path / "look.json").read_text() == text


@pytest.mark.parametrize("words", [("-k", ""), ("--select", ""), ("--select=",)])
def test_an_empty_choice_of_cases_is_all_of_them(cli, tmp_path, words):
    (tmp_path / "a.suite.toml").write_text('graph = "look.json"\n')
    assert cli("test", tmp_path, "--list", *words).err == cli("test", tmp_path, "--list").err


@pytest.mark.parametrize(
    ("words", "kind"),
    [
        (("render", "x", "--frame", "1.5"), "a whole number"),
        (("submit", "x", "--chunk", "many"), "a whole number"),
        (("render", "x", "--scale", "half"), "a number"),
        (("render", "x", "--timeout", "soon"), "a number"),
    ],
)
def test_a_word_that_is_no_number(fails, words, kind):
    assert f"'{words[-2]}': '{words[-1]}' is not {kind}; see halation" in fails(2, *words)
