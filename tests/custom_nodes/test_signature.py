"""What the signature of a function and the comments in it declare."""

from __future__ import annotations

from dataclasses import FrozenInstanceError

import numpy as np
import pytest
from halation.custom_nodes import Code, CodeFault, CustomNode, node_type
from halation.document import dumps, loads
from halation.graph import Graph, Port
from halation.nodes import Field, Filter, Image, Pointwise, Value, Vector
from halation.resources.sandbox import UNRESTRICTED
from hypothesis import given
from hypothesis import strategies as some

TINT = """
// Mixes a color into the dark parts.
// Rec.709.
vec4 tint(
    vec4 image,
    float mask,     // optional 1: where it works
    float amount,   // = 0.5, 0..2, >= 0, <= 4, ratio, "How much": of the tint, mostly.
    vec4 shade,     // = (0, 0.2, 1, 1), color
    vec2 center,    // = 0.5, handle
    int steps,      // = 3, 1..9, count
    int mode,       // = multiply, one of add | multiply
    bool invert     // = true
) {
    return image * amount;
}
"""


def glsl(text: str, file: str = "") -> type[CustomNode]:
    return node_type(Code("glsl", text, file))


def test_everything_that_a_parameter_can_be() -> None:
    kind = glsl(TINT)
    assert kind.inputs == {"image": Image(), "mask": Field(1.0, doc="where it works")}
    assert kind.values == {
        "amount": Value(
            "amount",
            "float",
            0.5,
            low=0.0,
            high=2.0,
            minimum=0.0,
            maximum=4.0,
            unit="ratio",
            label="How much",
            doc="of the tint, mostly.",
        ),
        "shade": Value("shade", "color", (0.0, 0.2, 1.0, 1.0), length=4),
        "center": Value("center", "vector", (0.5, 0.5), length=2, low=0.0, high=1.0, handle=True),
        "steps": Value("steps", "int", 3, low=1.0, high=9.0, unit="count"),
        "mode": Value("mode", "choice", "multiply", choices=("add", "multiply")),
        "invert": Value("invert", "bool", True),
    }
    assert [output.socket for output in kind.outputs.values()] == [Image()]
    assert kind.order == ("image", "mask", "amount", "shade", "center", "steps", "mode", "invert")
    assert (kind.id, kind.category, kind.title) == ("glsl", "code", "tint")
    assert kind.__doc__ == "Mixes a color into the dark parts.\nRec.709."
    assert issubclass(kind, Pointwise) and kind(amount=1.0).with_values(steps=4).values is kind.values


def test_labels_are_what_is_between_quotes() -> None:
    for note, label, doc in (
        ('= 1, "How much"', "How much", ""),
        ('= 1, "  How much "', "How much", ""),
        ('= 1, ""', "", ""),
        ('= 1, "a, b"', "a, b", ""),
        ('= 1, "": of it', "", "of it"),
    ):
        value = glsl(f"vec4 f(vec4 image, float b // {note}\n) {{ return image * b; }}").values["b"]
        assert (value.label, value.doc) == (label, doc)


def test_what_looks_around_is_a_filter() -> None:
    kind = glsl("vec4 soften(vec4 image, float near /* optional */) { return image_at(pixel + 1) + near; }")
    assert issubclass(kind, Filter) and list(kind.inputs) == ["image", "near"]
    assert issubclass(glsl("vec4 f(vec4 image) { return image; } // image_at(pixel) is not called"), Pointwise)


def test_outputs() -> None:
    kind = glsl("void split(vec4 image, out vec4 low, out float mask, out vec3 normal, out vec4 four /* vector */) {}")
    assert {name: output.socket for name, output in kind.outputs.items()} == {
        "low": Image(),
        "mask": Field(),
        "normal": Vector(width=3),
        "four": Vector(width=4),
    }
    assert glsl("float luma(vec4 image) { return image.g; }").outputs["out"].socket == Field()
    assert glsl("vec2 flow(vec4 image) { return image.rg; }").outputs["out"].socket == Vector(width=2)


def test_the_last_function_is_the_node() -> None:
    kind = glsl("float half_of(float x) { return x / 2.0; }\nfloat node_of(float a) { return half_of(a); }")
    assert kind.title == "node of" and list(kind.inputs) == ["a"]


def test_equal_code_is_one_class_and_other_code_another() -> None:
    assert glsl(TINT) is glsl(TINT)
    assert glsl(TINT).shader != glsl(TINT + " ").shader


def test_a_comment_that_is_a_sentence_is_one() -> None:
    kind = glsl("vec4 f(vec4 image, // the picture, as it comes\n vec4 other // px are no matter\n) { return image; }")
    assert [socket.doc for socket in kind.inputs.values()] == ["the picture, as it comes", "px are no matter"]


@pytest.mark.parametrize(
    ("text", "line", "said"),
    [
        ("", 1, "there is no function in it"),
        ("float x;", 1, "there is no function in it"),
        ("\nvec4 f(vec4 a,\nvec4 a) { return a; }", 3, "the name 'a' is used twice: choose another"),
        ("vec4 f(vec4 pixel) { return pixel; }", 1, "'pixel' means something else here"),
        *(
            (f"vec4 f(vec4 {name}) {{ return {name}; }}", 1, f"'{name}' means something else here")
            for name in ("extent", "frame", "proxy", "grid")
        ),
        ("void f(vec4 a) {}", 1, "'f' makes nothing"),
        ("vec4 f(vec4 a, out float b) { return a; }", 1, "returns a vec4 and has out parameters"),
        ("void f(out vec4 a, vec4 b) {}", 1, "put out parameters last"),
        ("vec4 f(sampler2D a) { return vec4(0); }", 1, "'a' has the type sampler2D"),
        ("vec4 f(int a) { return vec4(0); }", 1, "'a' is a int, which no picture holds"),
        ("mat3 f(vec4 a) { return mat3(0); }", 1, "the result has the type mat3"),
        ("\nuniform float x;\nvec4 f(vec4 a) { return a; }", 2, "'uniform' has no place here"),
        ("vec4 f(vec4 a) { return texture(a, vec2(0)); }", 1, "'texture' has no place here"),
        ("#version 430\nvec4 f(vec4 a) { return a; }", 1, "'#version' has no place here"),
        ("vec4 f(vec4 a) {\n return gl_FragCoord; }", 2, "'gl_FragCoord' has no place here"),
        ("vec4 f(float b // = x\n) { return vec4(b); }", 1, "a float is a number"),
        ("vec4 f(float b // = 2, <= 1\n) { return vec4(b); }", 1, "lies beyond its limits"),
        ("vec4 f(float b // = 2, 3..1\n) { return vec4(b); }", 1, "the range of 'b' is empty"),
        ("vec4 f(float b // = 2, meters\n) { return vec4(b); }", 1, "'meters' says nothing of a parameter"),
        ('vec4 f(float b // = 1, "meters\n) { return vec4(b); }', 1, "says nothing of a parameter"),
        ('vec4 f(float b // = 1, meters"\n) { return vec4(b); }', 1, "says nothing of a parameter"),
        ('vec4 f(float b // = 1, "\n) { return vec4(b); }', 1, "says nothing of a parameter"),
        ("vec4 f(vec3 b // = (1, 2)\n) { return vec4(1); }", 1, "a vec3 is 3 numbers"),
        ("vec4 f(int b // = 1.5\n) { return vec4(b); }", 1, "an int must be a whole number"),
        ("vec4 f(bool b // = 1.5\n) { return vec4(b); }", 1, "a bool must be true or false"),
        ("vec4 f(int b // = c, one of a | b\n) { return vec4(b); }", 1, "none of its choices"),
        ("vec4 f(float b // = a, one of a | b\n) { return vec4(b); }", 1, "so it is an int"),
        ("vec4 f(float b // = 1, color\n) { return vec4(b); }", 1, "so it is a vec4 or vec3"),
        (
            "vec4 f(vec4 a /* wrap */, vec4 b /* black */) { return a_at(pixel); }",
            1,
            "choose one for all of them",
        ),
    ],
)
def test_faults_name_their_line(text: str, line: int, said: str) -> None:
    with pytest.raises(CodeFault, match=said.replace("(", "\\(").replace("[", "\\[")) as caught:
        glsl(text)
    assert caught.value.line == line


@given(some.text(alphabet='vec4 float(){},/*=.0123\n"abimgetx;#<>|:\\\u00e9\u2028', max_size=200))
def test_any_text_is_a_class_or_a_fault(text: str) -> None:
    try:
        assert glsl(text).outputs
    except CodeFault as fault:
        assert str(fault)


@pytest.mark.parametrize(
    ("type", "default", "low", "high"),
    [
        ("float", "0.25", 0.0, 1.0),
        ("float", "3", 0.0, 6.0),
        ("float", "-3", -6.0, 6.0),
        ("int", "1", 0.0, 8.0),
        ("int", "20", 0.0, 40.0),
        ("int", "-1", -8.0, 8.0),
        ("vec2", "(3, 9)", -1.0, 1.0),
    ],
)
def test_a_slider_without_ends_has_its_default_well_inside(type: str, default: str, low: float, high: float) -> None:
    """Twice the default, at least 1, or the 8 steps of a whole number; below 0 only where the default is."""
    value = glsl(f"vec4 f(vec4 image, {type} x // = {default}\n) {{ return image; }}").values["x"]
    assert (value.low, value.high) == (low, high)


@given(some.floats(-1e6, 1e6), some.floats(0, 1e6), some.floats(0, 1e6))
def test_numbers_come_as_they_are_written(default: float, below: float, above: float) -> None:
    low, high = default - below, default + above
    kind = glsl(f"float f(float x, // = {default!r}, {low!r}..{high!r}\n float y) {{ return x; }}")
    value = kind.values["x"]
    assert (value.default, value.low, value.high) == (default, low, high)


@pytest.mark.parametrize(
    "name",
    [
        *(
            "traits",
            "proxy_notes",
            "with_values",
            "to_working_units",
            "required_package",
            "setting",
            "values",
            "inputs",
        ),
        *("outputs", "order", "id", "passes", "version", "code", "title", "text", "node", "muted", "lambda", "self"),
        *("size", "edge", "result", "overlap", "draw", "identity", "times", "category"),
    ],
)
@pytest.mark.parametrize("body", ["image * {}", "image_at(pixel) * {}"])
def test_parameters_may_have_the_names_of_attributes(run, name: str, body: str) -> None:
    result = body.format(name)
    node_class = glsl(f"vec4 f(vec4 image, float {name} /* = 0.5, 0..4 */) {{ return {result}; }}")
    node = node_class(**{name: 2.0})
    assert node.setting(name) == 2.0 and node_class().setting(name) == 0.5
    assert node == node_class(**{name: 2.0}) != node_class() and hash(node) == hash(node_class(**{name: 2.0}))
    assert node.with_values(**{name: 3.0}).setting(name) == 3.0
    graph = Graph().add("a", node)
    text = dumps(graph)
    assert loads(text, sandbox=UNRESTRICTED).nodes["a"] == node
    assert graph.set(Port("a", name), 1.5).value(Port("a", name)) == 1.5
    picture = np.full((2, 2, 4), 0.25, np.float32)
    assert (run(node, {"image": picture}) == 0.5).all()


@pytest.mark.parametrize("name", ["traits", "inputs", "id", "lambda", "size"])
def test_pictures_may_have_the_names_of_attributes(run, name: str) -> None:
    picture = np.full((2, 2, 4), 0.25, np.float32)
    for read in (name, f"{name}_at(pixel)"):
        node = glsl(f"void f(vec4 {name}, out vec4 order) {{ order = {read} * 2.0; }}")()
        assert (run(node, {name: picture}, output="order") == 0.5).all()


def test_a_node_of_code_cannot_be_changed() -> None:
    node = glsl(TINT)(amount=1.0)
    with pytest.raises(FrozenInstanceError):
        node.amount = 2.0
    with pytest.raises(TypeError, match="has no value missing"):
        glsl(TINT)(missing=1.0)
