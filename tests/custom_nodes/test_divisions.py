"""Divisions of whole numbers have a result for every pair, and floats are divided as they stand."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import Run
from halation.custom_nodes import Code, CodeFault, node_type
from halation.glsl.divisions import MOST_DIVISIONS, guard_divisions
from halation.glsl.tokens import GlslFault
from isf_files import isf

LEAST = -(2**31)
NUMBERS = (LEAST, LEAST + 1, -7, -2, -1, 0, 1, 2, 3, 10, 2**31 - 1)
PIXEL = {"image": np.ones((1, 1, 4), np.float32)}


@pytest.mark.parametrize(
    ("text", "guarded"),
    [
        ("int f(int a, int b) { return a / b; }", "int f(int a, int b) { return halation_quotient(a , b); }"),
        ("n = a * 2 / b % c;", "n = halation_remainder(halation_quotient(a * 2 , b) , c);"),
        ("n = -a / -b - c;", "n = halation_quotient(-a , -b) - c;"),
        ("n = a - -b / c;", "n = a - halation_quotient(-b , c);"),
        ("v.xy /= w;", "v.xy = halation_quotient(v.xy, w);"),
        (
            "v[i / j] %= c ? 1 : d, e;",
            "v[halation_quotient(i , j)] = halation_remainder(v[halation_quotient(i , j)], c ? 1 : d), e;",
        ),
        ("x = (a + b) / f(c).y[2];", "x = halation_quotient((a + b) , f(c).y[2]);"),
        ("return a / b;", "return halation_quotient(a , b);"),
        ("if (c) x = a-- / ++b;", "if (c) x = halation_quotient(a-- , ++b);"),
        ("n = a / (b > 0 ? 0 : 3);", "n = halation_quotient(a , (b > 0 ? 0 : 3));"),
        ("n = a / (b > 0 ? 3 : 0);", "n = halation_quotient(a , (b > 0 ? 3 : 0));"),
        ("n = a / (1 ? 0 : 3);", "n = halation_quotient(a , (1 ? 0 : 3));"),
    ],
)
def test_how_divisions_are_written(text: str, guarded: str) -> None:
    assert guard_divisions(text) == guarded


@pytest.mark.parametrize(
    "text",
    [
        "float f(float a, float b) { return a / b; }",
        "vec3 a; void f(int n) { a /= float(n); a = a * 2.0 / n; a = n / (a + 1); }",
        "int f(int n) { return n / 2 + n % 3 + n / (4 - 1); }",
        "const int N = 4; int f(int n) { return n / N; }",
        "const int N = 0; int f(int n) { return n / (N ? 0 : 3) + n % (1 ? 3 : 0); }",
        "ivec2 f(ivec2 n) { return n / ivec2(2, 3) + n % 2; }",
        "struct S { float r; }; float f(S s) { return s.r / s.r; }",
        "float f(vec4 c) { return c.r / c.g / max(c.b, 0) / dot(c, c); }",
        "float w() { return 1.0; } float f(int n) { return n / w(); }",
        '#include "lib/color.glsl"',
    ],
)
def test_what_needs_no_guard_stays_as_it_is(text: str) -> None:
    assert guard_divisions(text) == text


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("1 + 2 * 3", 7), ("7 - 2 - 3", 2), ("(1 + 2) * 3", 9), ("1 << 2 + 1", 8), ("64 >> 2 >> 1", 8),
        ("8 - 3 << 1", 10), ("false == 0 < 2 ? 5 : 6", 6),
        ("1 + 1 == 2 ? 5 : 6", 5), ("2 < 1 ? 5 : 6", 6), ("1 << 1 < 3 ? 5 : 6", 5), ("2 < 1 == 3 < 2 ? 5 : 6", 5),
        ("1 < 2 == 1 < 2 ? 5 : 6", 5), ("2 != 1 < 2 ? 5 : 6", 5), ("5 & 3 ^ 8", 9), ("6 & 3 | 8 ^ 1", 11),
        ("1 | 6 & 4", 5), ("4 ^ 6 & 3", 6), ("1 | 4 ^ 5", 1), ("1 == 2 ? 7 : 1 == 3 ? 8 : 9", 9), ("true ? 3 : 4", 3),
        ("false ? 3 : 4", 4), ("-2 * -3", 6), ("~5", -6), ("-~5", 6), ("~-5", 4), ("+7", 7), ("- -7", 7),
        ("ivec3(3, 4, 5).y", 4), ("ivec3(3, 4, 5).zx.x", 5), ("ivec4(6).q", 6), ("ivec2(8, 9).g", 9),
        ("min(3, max(1, 2))", 2), ("int(2.75)", 2), ("(1, 2)", 2), ("0x1F", 31), ("3 * int(uint(2)) + 1", 7),
    ],
)  # fmt: skip
def test_the_number_of_a_constant_is_that_of_the_language(text: str, number: int) -> None:
    """By the precedence of GLSL: only a divisor that is known, and not 0, needs no guard."""
    for more, is_known in ((1, True), (0, False), (-2, True)):
        code = f"int f(int n) {{ return n / (({text}) - ({number}) + {more}); }}"
        assert (guard_divisions(code) == code) is is_known, more


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("\nv[i++] /= w;", "may change nothing else"),
        ("\nv[i = 2] %= w;", "may change nothing else"),
        ("\nn = " + " / ".join(["a"] * (MOST_DIVISIONS + 2)) + ";", f"more than {MOST_DIVISIONS} whole numbers"),
        ("\nswitch (n) { case 1 / int(sin(1.0)): break; }", "a case label divides"),
    ],
)
def test_what_cannot_be_guarded_names_its_line(text: str, sentence: str) -> None:
    with pytest.raises(GlslFault, match=sentence) as caught:
        guard_divisions(text)
    assert caught.value.line == 2


def test_as_many_divisions_as_there_may_be() -> None:
    text = f"n = {' / '.join(['a'] * (MOST_DIVISIONS + 1))};"
    assert guard_divisions(text).count("halation_quotient(") == MOST_DIVISIONS


@pytest.mark.parametrize("text", ["n = (a / b;", "n = a) / b;", "/ b", "a /", "n = a / ;", "f(/)"])
def test_what_is_no_code_is_left_to_the_driver(text: str) -> None:
    assert len(guard_divisions(text)) >= len(text)


@pytest.mark.parametrize("kind", ["int", "ivec2", "ivec3", "ivec4"])
@pytest.mark.parametrize("folded", [True, False], ids=["constant", "at run time"])
def test_every_pair_has_a_result(run: Run, kind: str, folded: bool) -> None:
    """The driver computes what it can while it compiles, the device what depends on a value."""
    lines = list[str]()
    for a in NUMBERS:
        for b in NUMBERS:
            first, second = (f"{kind}({'-2147483647 - 1' if n == LEAST else n})" for n in (a, b))
            part = "" if kind == "int" else ".y"
            quotient, remainder = (0, 0) if b == 0 else (LEAST, 0) if (a, b) == (LEAST, -1) else _divide(a, b)
            # The remainder of negative numbers is not defined.
            remainder_text = f"(x % y){part} == {remainder}" if a >= 0 and b > 0 else "x % y == x % y"
            limit = "(-2147483647 - 1)" if quotient == LEAST else str(quotient)
            lines.append(
                f"{{ {kind} x = {first} + zero, y = {second} + zero; {kind} z = x; z /= y;"
                f" if (!((x / y){part} == {limit} && z == x / y && {remainder_text})) return vec4(0.0); }}"
            )
    chunks = [lines[start : start + 30] for start in range(0, len(lines), 30)]
    for chunk in chunks:
        body = "\n".join(chunk)
        zero = "0" if folded else "int(image.r) - 1"
        text = f"vec4 f(vec4 image) {{ int zero = {zero};\n{body}\nreturn vec4(1.0); }}"
        assert (run(node_type(Code("glsl", text))(), PIXEL) == 1.0).all()


def _divide(a: int, b: int) -> tuple[int, int]:
    """As GLSL divides positive numbers, and drivers all others: towards 0."""
    quotient = abs(a) // abs(b) * (1 if (a < 0) == (b < 0) else -1)
    return quotient, a - quotient * b


@pytest.mark.parametrize("kind", ["uint", "uvec2", "uvec3"])
def test_numbers_without_a_sign(run: Run, kind: str) -> None:
    text = f"""vec4 f(vec4 image, int none /* = 0 */) {{
        {kind} a = {kind}(7), b = {kind}(none), c = {kind}(none + 2);
        return a / b == {kind}(0) && a / c == {kind}(3) && a % c == {kind}(1) && a % b == {kind}(0)
            ? vec4(1.0) : vec4(0.0);
    }}"""
    assert (run(node_type(Code("glsl", text))(), PIXEL) == 1.0).all()


def test_mixed_numbers(run: Run) -> None:
    text = """vec4 f(vec4 image, int two /* = 2 */) {
        ivec3 v = ivec3(8, 6, -4) / two;
        ivec3 w = 12 / ivec3(two, 1, two + 1);
        uint u = 9u / uint(two);
        u %= 3u;
        float r = float(7 / two) + 7 / float(two);
        return v == ivec3(4, 3, -2) && w == ivec3(6, 12, 4) && u == 1u && r == 6.5 ? vec4(1.0) : vec4(0.0);
    }"""
    assert (run(node_type(Code("glsl", text))(), PIXEL) == 1.0).all()


@pytest.mark.parametrize(
    "divisor",
    [
        "clamp(-9, -1, 3)",
        "-abs(1)",
        "sign(-3)",
        "int(cos(3.14159265))",
        "t[0]",
        "s.a",
        "ivec2(-1, 0)[0]",
        "-t.length()",
    ],
)
@pytest.mark.parametrize("sign", ["/", "%"])
def test_constants_that_only_the_driver_can_tell(run: Run, divisor: str, sign: str) -> None:
    """They are variables then, and so are constants that are made of them; others still are lengths of arrays."""
    text = f"""struct S {{ int a; }};
    const S s = S(-1);
    const int t[1] = int[1](-1);
    const int q = (-2147483647 - 1) {sign} {divisor}, other = 3;
    const float twice = float(q) * 2.0;
    vec4 f(vec4 image) {{
        const int inner = q {sign} {divisor};
        const int count = 3;
        float list[count];
        return q == {"-2147483647 - 1" if sign == "/" else "0"} && twice == float(q) * 2.0 && other == 3
            && list.length() == 3 && inner == q ? vec4(1.0) : vec4(0.0);
    }}"""
    assert (run(node_type(Code("glsl", text))(), PIXEL) == 1.0).all()


def test_a_case_that_only_the_driver_can_tell() -> None:
    text = "vec4 f(vec4 image) {\n switch (3) { case 8 / int(cos(3.14159265)): return image; }\n return image; }"
    with pytest.raises(CodeFault, match="line 2: a case label divides by"):
        node_type(Code("glsl", text))


@pytest.mark.parametrize("sign", ["/", "%"])
def test_constants_that_have_no_result_are_refused(sign: str) -> None:
    for divisor in ("0", "-1", "(1 - 2)", "N"):
        constant = f"const int N = -1;\nconst int A = (-2147483647 - 1) {sign} {divisor};"
        text = f"{constant}\nvec4 f(vec4 image) {{ return image; }}"
        with pytest.raises(CodeFault, match=r"line 2: .* divided by"):
            node_type(Code("glsl", text))


def test_shaders_of_the_format_are_guarded() -> None:
    node_class = node_type(Code("isf", isf("int n = PASSINDEX; gl_FragColor = vec4(7 / n, 1.0 / TIME, 0, 1);")))
    assert node_class.code.language == "isf"
