"""Shaders that no driver can compile in any time are refused, with the line, before one sees them."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable

import pytest
from halation.custom_nodes import Code, CodeFault, node_type
from halation.glsl.bounds import check_size
from halation.glsl.tokens import GlslFault
from isf_files import isf


def effect(body: str, before: str = "") -> str:
    """Code of a node with this body in its second line, or below what stands before it."""
    return f"{before}vec4 f(vec4 image, float x /* = 1 */) {{\n{body}\nreturn image; }}"


def calls(arms: int, levels: int) -> str:
    """Functions of which each calls the one before several times."""
    lines = ["float f0(float x) { return sin(x); }"]
    lines += [
        f"float f{level}(float x) {{ return {'+'.join([f'f{level - 1}(x)'] * arms)}; }}" for level in range(1, levels)
    ]
    return "\n".join(lines) + "\n"


TOO_LARGE = {
    "array": "float a[100000000]; a[int(x)] = 1.0;",
    "array by a constant": "const int N = 1 << 27; float a[N];",
    "arrays of arrays": "float a[500][500];",
    "many arrays": " ".join(f"vec4 a{n}[4000];" for n in range(4)),
    "type with a length": "float[100000000] a;",
    "length that is not known": "float a[int(x)];",
    "array without a length": "float a[]; a[3] = 1.0;",
    "place": "float a[4]; a[99999999] = 1.0;",
    "items": f"const float t[] = float[]({', '.join(['1.0'] * 20000)});",
    "struct": "struct S { float a[9000]; }; struct T { S s; S r; }; T t;",
    "sum": f"x = {'+'.join(['x'] * 9000)};",
    "sum in brackets": f"x = {'+'.join(['(x)'] * 9000)};",
    "brackets": f"x = {'(' * 300}x{')' * 300};",
    "blocks": "{" * 300 + "}" * 300,
    "calls inside each other": f"x = {'sin(' * 300}x{')' * 300};",
    "signs": f"x = {'- ' * 300}x;",
    "choices": f"x = {''.join(f'x < {n}.0 ? {n}.0 : ' for n in range(500))}x;",
    "alternatives": "if (x < 0.0) x = 1.0;" + "".join(f" else if (x < {n}.0) {{ x = 2.0; }}" for n in range(500)),
    "alternatives with others inside": "if (x < 0.0) x = 1.0;"
    + " else if (x < 1.0) if (x < 2.0) x = 1.0; else x = 3.0;" * 300,
    "statements": "if (x < 0.0) " * 200 + "x = 1.0;",
    "loops": "for (int i = 0; i < 2; i++) " * 200 + "x = 1.0;",
    "cases": f"switch (int(x)) {{ {' '.join(f'case {n}: x = 1.0; break;' for n in range(5000))} }}",
    "assignments": f"{'x = ' * 500}1.0;",
    "members": f"x = image{'.rgba' * 100}.r;",
    "tokens": "x = x + 1.0;" * 20000,
}


@pytest.mark.parametrize("case", TOO_LARGE)
def test_what_is_too_large_is_refused_with_its_line(case: str) -> None:
    began = time.process_time()
    with pytest.raises(CodeFault) as caught:
        node_type(Code("glsl", effect(TOO_LARGE[case])))
    assert caught.value.line == 2 and time.process_time() - began < 2.0


Maker = Callable[[int], str]


def function(body: str, before: str = "") -> str:
    return f"{before}float f(float x) {{ {body} return x; }}"


EDGES: dict[str, tuple[int, Maker]] = {
    "brackets, with that of the function": (99, lambda n: function(f"x = {'(' * n}x{')' * n};")),
    "blocks, with that of the function": (99, lambda n: function("{" * n + "}" * n)),
    "statements": (100, lambda n: function("if (x < 0.0) " * n + "x = 1.0;")),
    "loops": (100, lambda n: function("for (int i = 0; i < 2; i++) " * n + "x = 1.0;")),
    "alternatives": (250, lambda n: function("if (x < 0.0) x = 1.0;" + " else if (x < 1.0) x = 2.0;" * n)),
    "choices, with one assignment": (249, lambda n: function(f"x = {'x < 1.0 ? 1.0 : ' * n}x;")),
    "assignments": (250, lambda n: function(f"{'x = ' * n}1.0;")),
    "signs": (32, lambda n: function(f"x = {'- ' * n}x;")),
    "terms": (4000, lambda n: function(f"x = x{' + x' * n};")),
    "cases": (256, lambda n: function(f"switch (int(x)) {{ {' '.join(f'case {k}: break;' for k in range(n))} }}")),
    "members": (32, lambda n: function(f"vec4 v; x = v{'.rgba' * n};")),
    "places": (32, lambda n: function(f"x = a{'[0]' * n};")),
    "numbers": (16384, lambda n: function(f"float a[{n}];")),
    "numbers of two arrays": (8192, lambda n: function(f"float a[{n}], b[{n}];")),
    "vectors": (16384 // 4, lambda n: function(f"vec4 a[{n}];")),
    "square matrices": (16384 // 9, lambda n: function(f"mat3 a[{n}];")),
    "other matrices": (16384 // 8, lambda n: function(f"mat2x4 a[{n}];")),
    "structs": (16384 // 13, lambda n: function(f"S s[{n}];", "struct S { vec3 v[4]; float w; };")),
    "an index": (16384, lambda n: function(f"float a[4]; a[{n}] = x;")),
    "functions": (1000, lambda n: "".join(f"float g{k}(float x) {{ return x; }}\n" for k in range(n))),
    "words and signs with the calls written out, brackets that end bodies aside": (
        250_000 - 1 - 90 * (5 + 1 + 900 * 3),
        lambda n: f"float g(float x) {{ {'x++;' * 900} }}\n" + f"float f(float x) {{ {'g(x);' * 90}{';' * n} }}",
    ),
    "calls, from the first function to the last": (101, lambda n: calls(1, n)),
}
"""The most of each thing that there may be, as messages say it, and a text with that many."""


@pytest.mark.parametrize("case", EDGES)
def test_bounds_are_where_messages_say(case: str) -> None:
    most, make = EDGES[case]
    check_size(make(most))
    with pytest.raises(GlslFault):
        check_size(make(most + 1))


GROWING = {
    "constants": "".join(f"const float c{n} = 1.0;\n" for n in range(7000)),
    "loops": "float g(float x) { " + "for (int i = 0; i < int(x); i++) x += 1.0;\n" * 2000 + "return x; }\n",
    "divisions": "int g(int q) { q = " + "/".join(["q"] * 3900) + "; return q; }\n",
    "lines": "\n" * 2_000_000,
    "letters": " " * 2_000_000,
    "comments": "/* a */" * 300_000,
    "a broken header of a loop": "void g() { for (int i = 0.0) i < 4; i--) { } }\n",
}


@pytest.mark.parametrize("case", GROWING)
def test_everything_is_read_in_a_time_that_does_not_grow_with_its_square(case: str) -> None:
    began = time.process_time()
    with contextlib.suppress(CodeFault):
        node_type(Code("glsl", GROWING[case] + effect("")))
    assert time.process_time() - began < 4.0


@pytest.mark.parametrize(("arms", "levels"), [(4, 10), (2, 20), (1000, 3), (1, 400)])
def test_calls_that_grow(arms: int, levels: int) -> None:
    with pytest.raises(CodeFault, match=r"written out|in a chain"):
        node_type(Code("glsl", effect("image.r = f1(x);", calls(arms, levels))))


def test_overloads_and_prototypes_that_grow() -> None:
    head = "".join(f"float g{n}(float x);\n" for n in range(14))
    bodies = "".join(f"float g{n}(float x) {{ return {'+'.join([f'g{n + 1}(x)'] * 4)}; }}\n" for n in range(12))
    with pytest.raises(CodeFault, match="written out"):
        node_type(Code("glsl", effect("", head + bodies)))
    overloads = "float s(float x) { return x; }\nstruct S0 { float a; };\nfloat s(S0 x) { return x.a; }\n"
    for number in range(1, 12):
        call = f"s(S{number - 1}(x.a))"
        overloads += f"struct S{number} {{ float a; }};\n"
        overloads += f"float s(S{number} x) {{ return {'+'.join([call] * 5)}; }}\n"
    with pytest.raises(CodeFault, match="written out"):
        node_type(Code("glsl", effect("", overloads)))


@pytest.mark.parametrize("count", [2, 3, 60])
def test_functions_that_call_each_other_in_a_circle_are_measured_once(count: int) -> None:
    """GLSL forbids it, and the driver says so with the line: what measures them must come to an end all the same."""
    head = "".join(f"float g{n}(float x);\n" for n in range(count))
    bodies = "".join(f"float g{n}(float x) {{ return g{(n + 1) % count}(x); }}\n" for n in range(count))
    assert node_type(Code("glsl", effect("image.r = g0(x);", head + bodies)))


def test_shaders_of_the_format_have_the_same_bounds() -> None:
    with pytest.raises(CodeFault, match="an array cannot have the length 100000000"):
        node_type(Code("isf", isf("float a[100000000]; gl_FragColor = vec4(a[3]);")))


@pytest.mark.parametrize(
    "body",
    [
        "float a[256]; for (int i = 0; i < 256; i++) a[i] = x; image.r = a[int(x)];",
        "const int N = 4, M = N * 2; float a[M], b[N + 1][2]; a[M - 1] = 1.0; b[0][1] = x;",
        "float a[] = float[](1.0, 2.0); float b[a.length()]; b[1] = a[0];",
        "vec2[3] a; a[2] = image.xy; struct S { vec3 v[4]; float w; }; S s[2]; s[1].v[2].x = x;",
        "if (x < 0.0) x = 1.0; " + "".join(f"if (x < {n}.0) {{ x = 2.0; }} " for n in range(500)),
        f"x = {'+'.join(['x'] * 1000)};",
        f"x = {'+'.join(['image.r'] * 1000)};",
        "for (int i = 0; i < 4; i++) for (int j = 0; j < 4; j++) if (i < j) x += 1.0; else x -= 1.0;",
    ],
)
def test_what_people_write_is_left_alone(body: str) -> None:
    assert node_type(Code("glsl", effect(body)))
