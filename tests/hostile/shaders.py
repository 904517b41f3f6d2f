"""Shaders by a grammar: functions of nodes whose code is mostly valid GLSL and sometimes meant to break a compiler."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from importlib import resources
from pathlib import Path
from random import Random

import shader_corpus
from cases import Case

TYPES = ("float", "int", "uint", "vec2", "vec3", "vec4", "bool")
WORDS = (
    "discard",
    "return",
    "gl_FragCoord",
    "texture",
    "imageStore",
    "layout",
    "uniform",
    "buffer",
    "goto",
    "#version 460",
)
"""What code of a node has no business to say."""


COMMANDS = (
    ("render", "graph.json", "-o", "out.exr", "--size", "24x16", "--timeout", "3"),
    ("check", "graph.json"),
    ("api", "graph.json"),
)
"""The API renders in the process itself, after a trial in another one."""

CODES = frozenset({0, 1, 3, 5})


def build_cases(seed: int, count: int) -> Iterator[Case]:
    """So many cases; the same for the same seed."""
    folder = resources.files("halation.shaders")
    corpus = [path.read_text("utf-8") for path in Path(str(folder)).glob("*/*.glsl")]
    for number in range(count):
        rng = Random(f"shaders {seed} {number}")
        choice = rng.random()
        if choice < 0.1:
            code = shuffle_tokens(rng, rng.choice(corpus))
        elif choice < 0.2:
            code = shuffle_tokens(rng, write_function(rng))
        else:
            code = write_function(rng)
        language = "isf" if rng.random() < 0.15 else "glsl"
        words = rng.choices(COMMANDS, (6, 3, 1))[0]
        # The API tries code for a minute, as long as --timeout has it without an option.
        seconds = 90.0 if words[0] == "api" else 25.0
        yield Case(f"shader-{seed}-{number}", _writer(code, language), words, seconds=seconds, codes=CODES)


def _writer(code: str, language: str) -> Callable[[Path], None]:
    if language == "isf":
        inputs = [{"NAME": "picture", "TYPE": "image"}, {"NAME": "count", "TYPE": "long", "DEFAULT": 0}]
        head = json.dumps({"INPUTS": inputs})
        main = "void main() { gl_FragColor = effect(IMG_THIS_PIXEL(picture), TIME, count); }"
        code = f"/*{head}*/\n{code}\n{main}"
    socket = "picture" if language == "isf" else "image"
    graph = {
        "halation": 1,
        "settings": {"size": [24, 16]},
        "outputs": {"image": {"type": "Image"}},
        "nodes": {"s": {"type": "noise"}, "n": {"type": language, "code": code.split("\n")}},
        "links": {f"n.{socket}": "s.out", "outputs.image": "n.out"},
    }

    def prepare(folder: Path) -> None:
        (folder / "graph.json").write_text(json.dumps(graph))

    return prepare


def write_function(rng: Random) -> str:
    """Helpers, macros and the function of a node."""
    heads = (*HEADS, *shader_corpus.HEADS)
    head = [rng.choice(heads)(rng) for _ in range(rng.choice((0, 0, 0, 1, 1, 2)))]
    names = {"image": "vec4", "amount": "float", "count": "int"}
    body = [_statement(rng, names, 0) for _ in range(rng.randint(1, 6))]
    body += [rng.choice(shader_corpus.STATEMENTS)(rng) for _ in range(rng.choice((0, 1, 1, 2)))]
    body = ["    " + line for line in body]
    last = f"    return {_expression(rng, names, 'vec4', 0)};"
    return "\n".join(
        [*head, "vec4 effect(vec4 image, float amount /* = 1 */, int count /* = 0 */) {", *body, last, "}"]
    )


def _expression(rng: Random, names: dict[str, str], kind: str, depth: int) -> str:
    known = [name for name, its in names.items() if its == kind]
    choice = rng.random()
    if depth > 4 or choice < 0.25:
        return rng.choice(known) if known and rng.random() < 0.7 else _literal(rng, kind)
    inner = lambda of=kind: _expression(rng, names, of, depth + 1)  # noqa: E731 - read best in place
    if kind == "bool":
        return f"({inner('float')} {rng.choice(('<', '>', '==', '!='))} {inner('float')})"
    if kind in ("int", "uint"):
        operator = rng.choice(("+", "-", "*", "/", "%", "<<", ">>", "&", "|", "^"))
        return rng.choice((f"({inner()} {operator} {inner()})", f"{kind}({inner('float')})"))
    if choice < 0.5:
        return f"({inner()} {rng.choice('+-*/')} {inner()})"
    if choice < 0.7:
        return f"{rng.choice(('sin', 'sqrt', 'fract', 'exp2', 'log', 'abs', 'normalize', 'inversesqrt'))}({inner()})"
    if choice < 0.8:
        return f"({inner('bool')} ? {inner()} : {inner()})"
    if kind == "float":
        return rng.choice(
            (f"float({inner('int')})", f"{rng.choice(('image', inner('vec4')))}.{rng.choice('xyzwrgba')}")
        )
    if kind == "vec4":
        return rng.choice((f"vec4({inner('vec3')}, {inner('float')})", f"image.{''.join(rng.choices('rgba', k=4))}"))
    return f"{kind}({inner('float')})"


def _literal(rng: Random, kind: str) -> str:
    whole = rng.choice(("0", "1", "-1", "2147483647", "(-2147483647 - 1)", "7", "31", "32", "4096"))
    number = rng.choice(("0.0", "1.0", "-1.0", "1e38", "1e-38", "0.5", "3.4e38 * 10.0", "1.0 / 0.0"))
    made = {"int": whole, "uint": f"uint({whole})", "bool": rng.choice(("true", "false")), "float": number}
    return made.get(kind, f"{kind}({number})")


def _statement(rng: Random, names: dict[str, str], depth: int) -> str:
    kind = rng.choice(TYPES)
    choice = rng.random()
    if choice < 0.45 or depth > 3:
        name = rng.choice(
            (f"v{len(names)}", "r", "rgb", "x", "o0", "t0", "main", "effect_", "p", "uv", "halation", "image_")
        )
        fresh = name if name not in names else f"v{len(names)}_"
        text = f"{kind} {fresh} = {_expression(rng, names, kind, 0)};"
        names[fresh] = kind
        return text
    if choice < 0.65:
        return f"if ({_expression(rng, names, 'bool', 1)}) {{ {_statement(rng, dict(names), depth + 1)} }}"
    if choice < 0.85:
        bound = rng.choice(("4", "16", "1000", "int(amount)", "2147483647", "i + 1"))
        step = rng.choice(("i++", "i--", "i += 2", ""))
        return f"for (int i = 0; i < {bound}; {step}) {{ {_statement(rng, {**names, 'i': 'int'}, depth + 1)} }}"
    if choice < 0.9:
        return f"while ({_expression(rng, names, 'bool', 2)}) {{ {_statement(rng, dict(names), depth + 1)} }}"
    if choice < 0.95:
        cases = " ".join(f"case {n}: image.r += {n}.0; break;" for n in range(rng.choice((2, 40, 3000))))
        return f"switch (int(amount)) {{ {cases} }}"
    return f"{rng.choice(WORDS)};"


def _macro_bomb(rng: Random) -> str:
    lines, arms = ["#define M0 image.r"], rng.choice((2, 4, 8))
    for level in range(1, rng.choice((3, 6, 12))):
        lines.append(f"#define M{level} {' + '.join([f'M{level - 1}'] * arms)}")
    return "\n".join([*lines, f"float bomb(vec4 image) {{ return {lines[-1].split()[1]}; }}"])


def _call_bomb(rng: Random) -> str:
    lines, arms = ["float f0(float x) { return x * 1.01; }"], rng.choice((2, 3, 4))
    for level in range(1, rng.choice((4, 8, 11))):
        lines.append(f"float f{level}(float x) {{ return {' + '.join([f'f{level - 1}(x)'] * arms)}; }}")
    return "\n".join(lines)


def _array(rng: Random) -> str:
    size = rng.choice((4, 1000, 300000, 100000000, 2147483647, -1))
    if rng.random() < 0.3 and 0 < size <= 300000:
        return f"const float table[{size}] = float[]({', '.join(['1.0'] * size)});"
    return f"float big[{size}];\nfloat look(int i) {{ return big[i * {rng.choice((1, 1000000))}]; }}"


def _long_sum(rng: Random) -> str:
    return f"float sum(float x) {{ return {'+'.join(['x'] * rng.choice((100, 5000, 60000)))}; }}"


def _brackets(rng: Random) -> str:
    depth = rng.choice((10, 300, 20000))
    return f"float deep(float x) {{ return {'(' * depth}x{')' * depth}; }}"


def _paste(rng: Random) -> str:
    first, second = rng.choice(
        (("wh", "ile"), ("fo", "r"), ("gl_", "FragCoord"), ("image", "Store"), ("tex", "ture"), ("dis", "card"))
    )
    return f"#define GLUE(a, b) a##b\nfloat glued(float x) {{ GLUE({first}, {second}) (true) {{ }} return x; }}"


def _include(rng: Random) -> str:
    path = rng.choice(("lib/noise.glsl", "../../../etc/passwd", "/etc/passwd", "lib/../lib/finite.glsl", "nothing", ""))
    return f'#include "{path}"'


def _helper(rng: Random) -> str:
    name = rng.choice(("r", "rgb", "xy", "a", "mix", "effect", "main", "float_", "noise", "_", "gl_x", "a__b"))
    return f"float {name}(float x) {{ return x; }}"


def _text(rng: Random) -> str:
    return rng.choice(
        (
            "// \\",
            "/* never ends",
            "é float x;",
            "\u0000",
            "#if 1",
            "#define",
            "#error no",
            "#line 2000000000",
            '"text"',
            "#pragma x",
            "struct S { float a; S b; };",
        )
    )


HEADS = (_macro_bomb, _call_bomb, _array, _long_sum, _brackets, _paste, _include, _helper, _helper, _text)


def shuffle_tokens(rng: Random, code: str) -> str:
    """A shader of ours with a few words exchanged, doubled or lost."""
    tokens = code.split(" ")
    for _ in range(rng.choice((1, 2, 5))):
        at, other = rng.randrange(len(tokens)), rng.randrange(len(tokens))
        change = rng.randrange(3)
        if change == 0:
            tokens[at], tokens[other] = tokens[other], tokens[at]
        elif change == 1:
            tokens.insert(at, tokens[other])
        else:
            tokens[at] = ""
    return " ".join(tokens)
