"""Pieces of shaders that have broken a compiler, or are relatives of such pieces.

A head stands before the function of a node, a statement inside of it. Each is drawn with numbers of its own, from
harmless to absurd.
"""

from __future__ import annotations

from collections.abc import Callable
from random import Random

LEAST = "(-2147483647 - 1)"
KINDS = ("int", "uint", "ivec2", "ivec3", "ivec4", "uvec2")


def _size(rng: Random, *sizes: int) -> int:
    return rng.choice(sizes)


def divide_integers(rng: Random) -> str:
    """Divisions by constants, values and pixels, on numbers and vectors."""
    kind, sign = rng.choice(KINDS), rng.choice(("/", "%", "/=", "%="))
    least = "4294967295u" if kind[0] == "u" else LEAST
    first = rng.choice((f"{kind}({least})", f"{kind}(image.r * 1e9)", f"{kind}(count) + {kind}({least})"))
    second = rng.choice(("0", "-1", "count", "int(image.g * 0.0) - 1", "-count", "1 - 2", "count * 0", "N"))
    second = f"{kind}({second})"
    if sign.endswith("="):
        return f"{{ const int N = -1; {kind} q = {first}; q {sign} {second}; image.r += float(q{_part(kind)}); }}"
    nested = f"({first} {sign} {second}) {rng.choice('/%*-')} {second}"
    return f"{{ const int N = -1; {kind} q = {nested}; image.r += float(q{_part(kind)}); }}"


def _part(kind: str) -> str:
    return ".y" if "vec" in kind else ""


def fold_constants(rng: Random) -> str:
    """Constants that a compiler divides itself."""
    sign = rng.choice("/%")
    return rng.choice(
        (
            f"const int A = {LEAST} {sign} -1; image.r += float(A);",
            f"const ivec2 A = ivec2({LEAST}) {sign} ivec2(-1, 0); image.r += float(A.x);",
            f"const int B = -1; const int A = {LEAST} {sign} B; image.r += float(A);",
            f"float a[{rng.choice(('7 / 2', '8 % 0', '1 / -1', '(3 - 3) / 3'))}]; a[0] = 1.0; image.r += a[0];",
            f"switch (count) {{ case {rng.choice(('7 / 0', f'{LEAST} / -1', '4 / 2'))}: image.r = 0.0; }}",
            f"const int A = {LEAST} {sign} int(floor(-0.5)); image.r += float(A);",
        )
    )


def index_arrays(rng: Random) -> str:
    """Arrays that are large, or read where they do not end."""
    length = _size(rng, 4, 64, 1000, 4096, 20000, 300000, 10**8, 2**31 - 1)
    place = rng.choice(("int(image.r * 1e6)", "-1", str(length), "count * 1000000", "int(1.0 / 0.0)"))
    kind = rng.choice(("float", "vec4", "mat4", "int"))
    return rng.choice(
        (
            f"{{ {kind} a[{length}]; a[{place}] = {kind}(1.0); image.r += float(a[{place}] == a[0]); }}",
            f"{{ {kind}[{length}] a, b[2]; b[1] = a; image.r += float(b[0][{place}] == a[1]); }}",
            f"{{ {kind} a[]; a[{length - 1}] = {kind}(0.0); }}",
            f"{{ struct S {{ {kind} a[{length}]; }}; S s[8]; s[count].a[{place}] = {kind}(1.0); }}",
            f"{{ const {kind} a[] = {kind}[]({', '.join([f'{kind}(1.0)'] * min(length, 20000))}); }}",
        )
    )


def nest(rng: Random) -> str:
    """Things inside each other, to a depth that recursion does not survive."""
    depth = _size(rng, 8, 60, 95, 300, 3000, 30000)
    return rng.choice(
        (
            f"image.r = {'(' * depth}image.g{')' * depth};",
            f"image.r = {'sin(' * depth}image.g{')' * depth};",
            f"image.r = {'-' * rng.choice((1, 2))}{'- ' * depth}image.g;",
            f"image.r = {''.join(f'image.g < {n}.0 ? {n}.0 : ' for n in range(depth))}image.g;",
            "if (image.r < 0.0) image.g = 1.0;" + " else if (image.r < 0.5) image.g = 2.0;" * depth,
            "{" * depth + "image.r = 0.0;" + "}" * depth,
            "if (image.r < 2.0) " * depth + "image.r = 0.0;",
            "for (int i = 0; i < 2; i++) " * min(depth, 200) + "image.r += 1.0;",
            f"image.r = image{'.rgba' * depth}.g;",
            f"image.r = {'image.g = ' * depth}1.0;",
            f"image.r = vec4{'(vec4' * depth}(1.0){')' * depth}.x;",
        )
    )


def lengthen(rng: Random) -> str:
    """Much of one thing."""
    count = _size(rng, 10, 300, 5000, 60000)
    few = min(count, 5000)
    return rng.choice(
        (
            f"image.r = {rng.choice('+-*/').join(['image.g'] * count)};",
            f"image.r = {'+'.join(f'sin(image.g * {n}.5)' for n in range(min(count, 300)))};",
            "".join(f"float w{n} = image.r * {n}.0;" for n in range(few)) + "image.r = w3;",
            f"switch (count) {{ {' '.join(f'case {n}: image.r += {n}.0; break;' for n in range(few))} }}",
            f"switch (count) {{ {' '.join(f'case {n}:' for n in range(few))} image.r = 1.0; }}",
            f"float {'a' * count} = 1.0; image.r = {'a' * count};",
            f"image.r = 0.{'1' * count};",
            f"image.r = float({'9' * count});",
            "image.r += 1.0;" * count,
            ";" * count,
            " " * count + "\n" * count,
        )
    )


def loop(rng: Random) -> str:
    """Loops inside each other, with and without an end."""
    bound = rng.choice(("3", "30", "1000", "count", "2147483647", "int(image.r * 1e9)"))
    inner = rng.choice(("image.r = sin(image.r);", "break;", "continue;", "i = 0;", "if (image.r > 9.0) return image;"))
    depth = rng.choice((1, 2, 4, 8))
    head = "".join(
        f"for (int {'ijklmnop'[n]} = 0; {'ijklmnop'[n]} < {bound}; {'ijklmnop'[n]}++) " for n in range(depth)
    )
    return rng.choice(
        (f"{head}{{ {inner} }}", f"while (true) {{ {inner.replace('i = 0;', '')} }}", "do ; while (true);")
    )


def call_odd_functions(rng: Random) -> str:
    """Functions of GLSL at the edges of what they are defined for."""
    number = rng.choice(("1.0 / 0.0", "0.0 / 0.0", "-1.0", "3.4e38 * 2.0", "image.r * 1e38", "1e-45"))
    return rng.choice(
        (
            f"image.r = pow({number}, {number});",
            f"image.r = float(int({number}) << count * 40);",
            f"image.r = float(1 >> {rng.choice(('-1', '99', 'count'))});",
            f"image.r = dFdx({number}) + fwidth(image.g);",
            f"image = inverse(mat4({number})) * image;",
            f"image.r = ldexp({number}, 2147483647);",
            "image.r = float(bitfieldExtract(7, 40, 40)) + float(findMSB(0));",
            f"image.r = acos({number}) + mod({number}, 0.0) + smoothstep(1.0, 1.0, {number});",
            "image = unpackUnorm4x8(4294967295u) + vec4(packHalf2x16(vec2(1e9)));",
            f"image.r = determinant(outerProduct(vec3({number}), vec3(0.0)));",
            "double d = 1.0lf / 0.0lf; image.r = float(d);",
            f"image[{rng.choice(('7', '-1', 'count', 'int(image.g * 9.0)'))}] = 1.0;",
            f"mat4 m; m[count][{rng.choice(('9', 'count'))}] = 1.0; image *= m;",
        )
    )


def define_bombs(rng: Random) -> str:
    """Macros that grow, call themselves, or make words."""
    arms, levels = rng.choice((2, 4, 8)), rng.choice((2, 6, 12, 30))
    lines = ["#define M0(x) x"]
    lines += [f"#define M{n}(x) {'+'.join([f'M{n - 1}(x)'] * arms)}" for n in range(1, levels)]
    first, second = rng.choice((("lay", "out"), ("gl_", "FragCoord"), ("wh", "ile"), ("image", "Load"), ("buf", "fer")))
    return rng.choice(
        (
            "\n".join([*lines, f"float bomb(float x) {{ return M{levels - 1}(x); }}"]),
            "\n".join(["#define D(x) x x x x", f"int i{'D(' * levels}{';' + ')' * levels}"]),
            f"#define J(a, b) a##b\nfloat j(float x) {{ J({first}, {second}) (true) {{ }} return x; }}",
            "#define A B\n#define B A\nfloat A(float x) { return x; }",
            f"#define L {'(' * levels}\n#define R {')' * levels}\nfloat q(float x) {{ return L x R; }}",
            f"#if {rng.choice(('1 / 0', f'{LEAST} / -1', '1 << 99', '(' * 500, 'defined', '0x', '9' * 400))}\n#endif",
            "\n".join(f"#define N{n} {n}" for n in range(rng.choice((10, 3000)))),
            "#define E(x) x\nfloat e(float x) { return E(" + "E(" * 200 + "x" + ")" * 200 + "); }",
            "#define HALF /* a comment\n that goes on */ 0.5",
            "#define F(x) x \\\n + 1.0 \\\n\nfloat f1(float x) { return F(x); }",
            "#undef __LINE__\n#define __FILE__ 3\n#define defined 1",
        )
    )


def define_functions(rng: Random) -> str:
    """Functions that call each other, in trees, chains and circles."""
    arms, levels = rng.choice((1, 2, 4, 9)), rng.choice((2, 5, 10, 300))
    name = rng.choice(("r", "rgb", "x", "st", "xyzw", "f"))
    lines = [f"float {name}0(float x) {{ return sin(x) * cos(x + 0.1); }}"]
    lines += [
        f"float {name}{n}(float x) {{ return {'+'.join([f'{name}{n - 1}(x)'] * arms)}; }}" for n in range(1, levels)
    ]
    return rng.choice(
        (
            "\n".join([*lines, f"float {name}(float x) {{ return {name}{levels - 1}(x); }}"]),
            "float a(float x);\nfloat b(float x) { return a(x); }\nfloat a(float x) { return b(x); }",
            "float a(float x) { return a(x - 1.0); }",
            "struct S { S s; };",
            "struct S { float r; vec4 rgb[3]; };\nS make(float x) { S s; s.r = x; return s; }",
            f"void many({', '.join(f'float p{n}' for n in range(rng.choice((10, 400, 5000))))}) {{ }}",
            f"float {name}(float v) {{ return v * 2.0; }}\nvec4 use(vec4 c) {{ return vec4({name}(c.r), c.rgb); }}",
        )
    )


def write_odd_text(rng: Random) -> str:
    """Text that is no code, or looks like other code."""
    return rng.choice(
        (
            "/* never ends",
            "// ends with a backslash \\",
            "\u0000",
            "float \u00e9;",
            "#line 2147483648 7",
            "#pragma optionNV(unroll all)",
            "#extension all : enable",
            "#version 110",
            "#error stop",
            '#include "../../../../etc/passwd"',
            '#include "lib/color.glsl"\n#include "lib/color.glsl"',
            "in vec4 color; out vec4 target; flat varying int v;",
            "precision lowp float; invariant gl_Position;",
            "subroutine void s(); atomic_uint counter;",
            "uniform image2D im; buffer B { float data[]; };",
            "float halation_rounds; float halation_quotient;",
            "}}}}",
            "((((",
            "float a[3](1.0);",
            "\ufeff\r\r\n\v\f",
            f"const float huge = 1e{'9' * rng.choice((3, 400))};",
        )
    )


HEADS: tuple[Callable[[Random], str], ...] = (define_bombs, define_functions, define_functions, write_odd_text)
STATEMENTS: tuple[Callable[[Random], str], ...] = (
    divide_integers,
    divide_integers,
    fold_constants,
    index_arrays,
    nest,
    lengthen,
    loop,
    call_odd_functions,
)
