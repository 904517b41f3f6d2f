"""Macros are expanded as C has it, within bounds, and what comes of them is judged."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from conftest import Run
from halation.custom_nodes import Code, CodeFault, node_type
from halation.glsl.conditions import DEEPEST, evaluate_condition
from halation.glsl.macros import MOST_TOKENS, expand_macros
from halation.glsl.tokens import GlslFault, split_tokens

PIXEL = {"image": np.full((2, 2, 4), 0.25, np.float32)}


def bomb(arms: int, levels: int, argument: str = "") -> str:
    """Macros of which each stands for several of the one before."""
    lines = [f"#define M0{argument and '(x)'} image.r"]
    for level in range(1, levels + 1):
        call = f"M{level - 1}{argument and '(x)'}"
        lines.append(f"#define M{level}{argument and '(x)'} {'+'.join([call] * arms)}")
    return "\n".join([*lines, f"vec4 f(vec4 image) {{ return vec4(M{levels}{argument}); }}"])


@pytest.mark.parametrize(
    ("text", "expanded"),
    [
        ("#define A 1\nA A", "1 1"),
        ("#define A B\n#define B A\nA B", "A B"),
        ("#define F(x) x * F(x)\nF(2)", "2 * F ( 2 )"),
        ("#define F(x) [x]\nF((1, 2))", "[ ( 1 , 2 ) ]"),
        ("#define F() 3\nF() F", "3 F"),
        ("#define G(a, b) a##b\nG(tex, ture) G(x, ) G(, y)", "texture x y"),
        ("#define C(a, b) a##b\n#define D(a, b) C(a, b)\n#define N 3\nC(v, N) D(v, N)", "vN v3"),
        ("#define A 1 \\\n + 2\nA", "1 + 2"),
        ("#define F(a, b) a - b\nF(1,\n2)", "1 - 2"),
        ("#define f(a) a*g\n#define g(a) f(a)\nf(2)(9)", "2 * 9 * g"),
        ("#define A 1\n#undef A\nA", "A"),
        ("#ifdef A\nx\n#else\ny\n#endif", "y"),
        ("#define A\n#ifdef A\nx\n#elif 1\ny\n#endif", "x"),
        ("#if 0\n#if 1\nx\n#endif\n#elif 2 > 1 && !defined(B)\ny\n#endif", "y"),
        ("#if (1 << 3) % 5 == 3\nx\n#endif", "x"),
        ("#if (-2147483647 - 1) / -1\nx\n#endif", "x"),
        ("#ifndef GL_ES\nx\n#endif", "x"),
        ("int a = __LINE__;", "int a = 1 ;"),
        ("\n__FILE__ __LINE__", "0 2"),
        ("image.r", "image.r"),
    ],
)
def test_expansion(text: str, expanded: str) -> None:
    expansion = expand_macros(text)
    assert expansion.count("\n") == text.count("\n")
    assert split_tokens(expansion) == split_tokens(expanded)


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("1 + 2 * 3", 7),
        ("( 1 + 2 ) * 3", 9),
        ("2 - 3 - 4", -5),
        ("7 / 2", 3),
        ("7 / - 2", -3),
        ("- 7 / 2", -3),
        ("- 7 / - 2", 3),
        ("7 % 3", 1),
        ("- 7 % 3", -1),
        ("7 % - 3", 1),
        ("1 / 0", 0),
        ("8 % 0", 0),
        ("0 && 8 / 0", 0),
        ("1 << 4", 16),
        ("16 >> 1 >> 2", 2),
        ("- 8 >> 1", -4),
        ("2147483647 + 1", -(2**31)),
        ("65536 * 65536", 0),
        ("1 | 6 & 3 ^ 2", 1),
        ("5 ^ 3", 6),
        ("5 | 3", 7),
        ("3 & 1 == 1", 1),
        ("1 || 0 && 0", 1),
        ("2 && 3", 1),
        ("0 || 0", 0),
        ("3 > 2", 1),
        ("2 > 2", 0),
        ("2 >= 2", 1),
        ("2 < 2", 0),
        ("2 <= 2", 1),
        ("2 != 2", 0),
        ("1 < 3 == 1", 1),
        ("! 3", 0),
        ("! 0", 1),
        ("~ 0", -1),
        ("- - 3", 3),
        ("+ 4", 4),
        ("017", 15),
        ("0x1F", 31),
        ("5u", 5),
        ("0", 0),
        ("name + 1", 1),
        ("_ + 1", 1),
    ],
)
def test_conditions_have_the_numbers_of_c(text: str, number: int) -> None:
    assert evaluate_condition(text.split(), 1) == number


@pytest.mark.parametrize(("before", "after"), [("(", ")"), ("-", "")])
def test_conditions_are_as_deep_as_they_may_be(before: str, after: str) -> None:
    def nest(count: int) -> list[str]:
        return [*(before * count), "1", *(after * count)]

    assert evaluate_condition(nest(DEEPEST), 1) == 1
    with pytest.raises(GlslFault, match="cannot be read"):
        evaluate_condition(nest(DEEPEST + 1), 1)


@pytest.mark.parametrize("text", ["", "08", "1 2", "( 1", ")", "1 +", "$", "1.5", "0x", "= 1"])
def test_what_is_no_condition_is_refused(text: str) -> None:
    with pytest.raises(GlslFault, match="cannot be read"):
        evaluate_condition(text.split(), 3)


@pytest.mark.parametrize(
    ("text", "line", "sentence"),
    [
        ("\n#if 1\nx", 2, "has no #endif"),
        ("#endif", 1, "belongs to no #if"),
        ("#define F(x) x\nF(1, 2)", 2, "takes 1 arguments, not 2"),
        ("#define F(x) x\nF(1", 2, "do not end"),
        ("#define P(a, b) a##b\nP(/, /)", 2, "is not one word"),
        ("#define ## 3", 1, "followed by the name"),
        ("#define defined 1", 1, "followed by the name"),
        ("#define J a ##", 1, "joins nothing in the macro 'J'"),
        ("#define J ## a", 1, "joins nothing"),
        ("#define F(x, x) x", 1, "'F'"),
        ("#define F(x, 1) x", 1, "'F'"),
        ("\n#if defined(A B)\n#endif", 2, "must be followed by a name"),
        ("a # b", 1, "'#' is not allowed here"),
        ("#if 1 +\n#endif", 1, "cannot be read"),
        ("#error it is so", 1, "it is so"),
        ("#nothing", 1, "there is no #nothing"),
        ("\n/* and so on", 2, "never closed"),
        ("float \u00e9;", 1, "not allowed here"),
        ("float a\0;", 1, "not allowed here"),
        ("a" * 2000, 1, "more than 1024 letters"),
        ("#if " + "(" * 500 + "1" + ")" * 500 + "\n#endif", 1, "cannot be read"),
        ("#if 1\n" * 200, 65, "conditions lie inside each other"),
        ("#define E(x) x\n" + "E(" * 300 + "1" + ")" * 300, 2, "inside each other"),
        ("\n".join(f"#define M{n} 1" for n in range(2000)), 999, "macros"),
        (bomb(8, 6), 8, f"more than {MOST_TOKENS}"),
        (bomb(8, 12), 14, f"more than {MOST_TOKENS}"),
        (bomb(8, 12, "(1)"), 14, f"more than {MOST_TOKENS}"),
        ("#define A(x) x x x x\n" + "A(" * 30 + "1" + ")" * 30, 2, f"more than {MOST_TOKENS}"),
    ],
)
def test_what_is_refused_names_its_line(text: str, line: int, sentence: str) -> None:
    with pytest.raises(GlslFault) as caught:
        expand_macros(text)
    assert (caught.value.line, sentence in caught.value.sentence) == (line, True), caught.value


EDGES: dict[str, tuple[int, Callable[[int], str]]] = {
    "letters": (1024, lambda n: "a" * n),
    "words": (MOST_TOKENS, lambda n: "a " * n),
    "words in two lines": (MOST_TOKENS - 9, lambda n: "a " * 9 + "\n" + "a " * n),
    "macros, with the two of the language": (998, lambda n: "\n".join(f"#define M{k} 1" for k in range(n))),
    "conditions inside each other": (64, lambda n: "#if 1\n" * n + "#endif\n" * n),
    "macros inside each other": (64, lambda n: "#define E(x) x\n" + "E(" * n + "1" + ")" * n),
    "macros that name each other": (64, lambda n: "\n".join(f"#define M{k} M{k + 1}" for k in range(n)) + "\nM0"),
}
"""The most of each thing that there may be, and a text with that many."""


@pytest.mark.parametrize("case", EDGES)
def test_bounds_are_where_messages_say(case: str) -> None:
    most, make = EDGES[case]
    expand_macros(make(most))
    with pytest.raises(GlslFault, match=r"more than|inside each other|letters|macros"):
        expand_macros(make(most + 1))


@pytest.mark.parametrize(
    "first, second", [("lay", "out"), ("image", "Store"), ("texel", "Fetch"), ("gl_", "FragCoord")]
)
def test_forbidden_words_that_macros_make(first: str, second: str) -> None:
    text = f"#define J(a, b) a##b\nvec4 f(vec4 image) {{\n J({first}, {second});\n return image; }}"
    with pytest.raises(CodeFault, match=f"line 3: '{first}{second}' has no place here"):
        node_type(Code("glsl", text))


def test_loops_that_macros_make_are_counted(run: Run) -> None:
    text = "#define J(a, b) a##b\nvec4 f(vec4 image) { J(wh, ile)(true) { image.r += 1.0; } return image; }"
    node_class = node_type(Code("glsl", text))
    assert node_class.text and "halation_rounds" in node_class.text.body
    assert (run(node_class(), PIXEL) != run(node_class(), PIXEL)).all()  # NaN


def test_code_with_macros_renders(run: Run) -> None:
    text = """#define TWICE(x) ((x) * 2.0)
    #define PIECE(name, factor) \\
        float name(float x) { return TWICE(x) * factor; }
    PIECE(weigh, 0.5)
    vec4 f(vec4 image, int mode /* = b, one of a | b */) {
    #if defined(MODE_B) && MODE_B == 1
        if (mode == MODE_B) return vec4(weigh(image.r));
    #else
        #error the macros of choices are missing
    #endif
        return image;
    }"""
    assert (run(node_type(Code("glsl", text))(), PIXEL) == 0.25).all()


@pytest.mark.parametrize(
    "line", ['# include "lib/color.glsl"', "#include <lib/color.glsl>", "#include lib", "#include"]
)
def test_only_plain_includes_are_read(line: str) -> None:
    """moderngl reads includes as well, and knows none."""
    with pytest.raises(CodeFault, match="line 2: #include has no place here"):
        node_type(Code("glsl", f"\n{line}\nvec4 f(vec4 image) {{ return image; }}"))


def test_shaders_of_the_format_include_nothing() -> None:
    with pytest.raises(CodeFault, match="#include has no place here"):
        node_type(Code("isf", '/*{}*/\n#include "lib/color.glsl"\nvoid main() { gl_FragColor = vec4(1.0); }'))


def test_a_signature_does_not_depend_on_conditions() -> None:
    text = "vec4 g(vec4 image) { return image; }\n#if 0\nvec4 f(vec4 image) { return image; }\n#endif"
    with pytest.raises(CodeFault, match="line 3: the signature of 'f'"):
        node_type(Code("glsl", text))


def random_condition(chance: random.Random, depth: int) -> tuple[str, int]:
    """A condition with brackets around each part, and its number by numpy's integers of 32 bits."""
    if depth == 0 or chance.random() < 0.1:
        number = chance.choice((chance.randrange(0, 40), chance.randrange(0, 2**31)))
        return str(number), number
    if chance.random() < 0.2:
        sign, (text, number) = chance.choice("-!~"), random_condition(chance, depth - 1)
        of = np.int32(number)
        return f"{sign} ( {text} )", int({"-": -of, "!": not number, "~": ~of}[sign])
    (left, a), (right, b) = (random_condition(chance, depth - 1) for _ in range(2))
    sign = chance.choice(("+", "-", "*", "/", "%", "<<", ">>", "<", ">", "<=", ">=", "==", "!=", "&", "|", "^"))
    x, y = np.int32(a), np.int32(b)
    if sign in ("<<", ">>"):
        y = np.int32(b & 31)
    calls = {
        "+": np.add, "-": np.subtract, "*": np.multiply, "<<": np.left_shift, ">>": np.right_shift, "<": np.less,
        ">": np.greater, "<=": np.less_equal, ">=": np.greater_equal, "==": np.equal, "!=": np.not_equal,
        "&": np.bitwise_and, "|": np.bitwise_or, "^": np.bitwise_xor, "%": np.fmod,
    }  # fmt: skip
    if sign == "/":
        number = 0 if b == 0 else math.trunc(Fraction(a, b))
    else:
        number = 0 if sign == "%" and b == 0 else int(calls[sign](x, y))
    return f"( {left} ) {sign} ( {right} )", int(np.int64(number).astype(np.int32))


@pytest.mark.filterwarnings("ignore:overflow encountered:RuntimeWarning")
@pytest.mark.parametrize("seed", range(20))
def test_conditions_are_numpys_of_32_bits(seed: int) -> None:
    """Sums, products and shifts wrap, division rounds towards zero, and a remainder has the sign of what is divided."""
    chance = random.Random(seed)
    for depth in (1, 1, 1, 1, 2, 2, 3, 4):
        text, number = random_condition(chance, depth)
        assert evaluate_condition(text.split(), 1) == number, text
