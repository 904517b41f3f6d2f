"""GLSL as people write it: what the parser must understand, and how it names what it cannot use."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from halation.compiler import Library, load_library
from halation.compiler.library import InstalledTexts, parse
from halation.errors import ShaderError
from halation.graph import Graph, Input, Output, Port
from halation.nodes.color.exposure import Exposure

GOOD = "vec4 exposure(vec4 image, float stops) { return image * exp2(stops); }\n"


def library(**texts: str) -> Library:
    """The installed files with others in their place: `color__exposure` stands for `color/exposure`."""
    named = {name.replace("__", "/"): text for name, text in texts.items()}
    return Library({**load_library().texts, **{name: parse(name, text) for name, text in named.items()}})


def exposed() -> Graph:
    graph = Graph(inputs={"image": Input()}, outputs={"image": Output()}).add("light", Exposure(stops=1.0))
    graph = graph.connect(Port("inputs", "image"), Port("light", "image"))
    return graph.connect(Port("light", "out"), Port("outputs", "image"))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (GOOD, (("vec4", "image"), ("float", "stops"))),
        (GOOD.replace("\n", "\r\n"), (("vec4", "image"), ("float", "stops"))),
        ("\ufeff" + GOOD, (("vec4", "image"), ("float", "stops"))),
        ("  highp vec4\nexposure(\n  const in vec4 image,  // one, two\n  float stops)\n{ if (true) { {} } }", None),
        ("float exposure(void) { return 1.0; }", ()),
        ("float exposure(float, vec2) { return 1.0; }", (("float", ""), ("vec2", ""))),
        ("float exposure(float a[2], vec2[3] b) { return 1.0; }", (("float[2]", "a"), ("vec2[3]", "b"))),
        ("void exposure(inout vec4 a) { }", (("inout vec4", "a"),)),
    ],
    ids=["plain", "crlf", "byte order mark", "many lines", "void", "unnamed", "arrays", "inout"],
)
def test_signatures(text, expected):
    found = parse("color/exposure", text).functions["exposure"]
    assert found.parameters == ((("vec4", "image"), ("float", "stops")) if expected is None else expected)
    assert found.outputs == ()


def test_outputs_are_told_from_parameters():
    found = parse("x", "void f(float a, out vec4 b, out float c) { }").functions["f"]
    assert (found.parameters, found.outputs) == ((("float", "a"),), (("vec4", "b"), ("float", "c")))


def test_statements_are_no_functions():
    text = "float f(float a) {\nif (a > 0.0) {}\nelse if (a < 0.0) {}\nfor (;;) {}\nwhile (true) {}\nreturn a;\n}\n"
    assert set(parse("x", text).functions) == {"f"}


def test_comments_never_reach_the_driver():
    text = parse("x", '// größe\n/* #include "lib/none.glsl"\n } */ float f() { return 1.0; }  // } \n')
    assert text.body.isascii() and "//" not in text.body and text.body.count("\n") == 3
    assert not text.includes
    assert text.functions["f"].line == 3


def test_a_function_that_is_not_asked_for_is_left_out_and_lines_stay():
    text = parse("x", "float a() {\n  return 1.0;\n}\nfloat b() { return 2.0; }\nfloat c() { return b(); }\n")
    kept = text.keep_needed(frozenset({"c"})).body
    assert "1.0" not in kept and "2.0" in kept and kept.count("\n") == text.body.count("\n")


@pytest.mark.parametrize(
    ("texts", "message"),
    [
        (
            {"color__exposure": '#include "color/exposure.glsl"\n' + GOOD},
            "shaders/color/exposure.glsl, line 1: .*circle",
        ),
        (
            {
                "color__exposure": '\n#include "lib/a.glsl"\n' + GOOD,
                "lib__a": '#include "lib/b.glsl"\n',
                "lib__b": '// b\n\n#include "lib/a.glsl"\n',
            },
            "'light': shaders/lib/b.glsl, line 3: .*lib/a.glsl.* circle",
        ),
        (
            {"color__exposure": '\n\n#include "lib/none.glsl"\n' + GOOD},
            "'light': shaders/color/exposure.glsl, line 3: .*lib/none.glsl.* no shader file",
        ),
        (
            {"color__exposure": "\nvec4 exposure(float stops, vec4 image) { return image; }\n"},
            r"line 2: 'exposure' takes \(float, vec4\) to \(vec4\), but the node declares \(vec4, float\) to \(vec4\)",
        ),
        ({"color__exposure": "vec3 exposure(vec4 image, float stops) { return image.rgb; }\n"}, r"to \(vec3\), but"),
        ({"color__exposure": "vec4 other(vec4 image) { return image; }\n"}, "no function 'exposure'"),
    ],
    ids=["itself", "circle", "missing", "order", "result", "absent"],
)
def test_faults_name_node_file_and_line(plan, texts, message):
    with pytest.raises(ShaderError, match=message):
        plan(exposed(), library=library(**texts))


def test_a_file_included_twice_appears_once(plan):
    twice = '#include "lib/a.glsl"\n#include "lib/b.glsl"\n'
    texts = {
        "color__exposure": twice + GOOD.replace("return ", "return lib_b() * "),
        "lib__a": '#include "lib/b.glsl"\n',
        "lib__b": "float lib_b() { return 1.0; }\nfloat unused() { return 2.0; }\n",
    }
    source = plan(exposed(), library=library(**texts)).passes[0].shader.source
    assert source.count("float lib_b()") == 1 and "unused" not in source


def test_shaders_of_plug_ins_follow_our_own(monkeypatch, tmp_path):
    ours = [*InstalledTexts()]
    (tmp_path / "shaders/inner").mkdir(parents=True)
    for name in ("tint", "inner/glow"):
        (tmp_path / f"shaders/{name}.glsl").write_text("vec4 acme_made(vec4 image) { return image; }")
    with_nodes = SimpleNamespace(namespace="acme", folder=tmp_path, nodes={"acme.tint": None})
    without = SimpleNamespace(namespace="other", folder=tmp_path, nodes={})
    monkeypatch.setattr("halation.compiler.library.plugins", lambda: (with_nodes, without))
    texts = InstalledTexts()
    assert [*texts][: len(ours)] == ours
    assert {*texts} - {*ours} == {"acme/tint", "acme/inner/glow"}
    assert len(texts) == len(ours) + 2
    assert "acme/tint" in texts and ours[0] in texts
    assert not any(name in texts for name in ("acme/missing", "other/tint", "nowhere/tint"))
    assert texts["acme/inner/glow"].file == "acme/shaders/inner/glow.glsl"
