"""docs/writing-nodes.md: what a node class and its GLSL may use, written from the code that implements it."""

from __future__ import annotations

import ast
import inspect
import json
import re
import textwrap
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from itertools import pairwise
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal, get_args, get_origin

import halation.nodes as vocabulary
from api_reference import describe, describe_callable, write_signature
from halation.glsl import GlslFunction, parse
from halation.nodes import KINDS, Draw, Node, OutputSocket, Socket, Trait, Vector
from halation.nodes._declare import draw as draw_module
from halation.nodes._declare import item_kinds, sockets, traits, values
from halation.nodes._declare import node as node_module
from halation.nodes._declare.values import read_value

LIBRARIES = Path(__file__).parents[1] / "shaders/lib"
INTERNAL_LIBRARIES = frozenset({"isf", "rounds", "whole"})
"""Libraries that the compiler includes for code of users."""

BASES = (
    vocabulary.Pointwise,
    vocabulary.Filter,
    vocabulary.Source,
    vocabulary.Reader,
    vocabulary.Temporal,
)
OVERRIDES = ("identity", "output_size", "times", "upgrade")
NODE_ATTRIBUTES = ("traits", "proxy_notes", "aliases", "version")
NOTES = (
    "Slider",
    "Doc",
    "Swatch",
    "Wheel",
    "Handle",
    "Dial",
    "File",
    "OfLayer",
    "OfSpace",
    "OneOf",
    "Picks",
    "Curve",
    "ColorRamp",
    "Items",
    "ItemKind",
)

TYPES = MappingProxyType(
    {
        "`float`, `int`, `bool`": (float, 1.0, "A number or a switch."),
        '`Literal["add", "multiply"]`': (
            Literal["add", "multiply"],
            "add",
            "A choice. GLSL compares it with macros: `MODE_ADD` and `MODE_MULTIPLY` for a value named `mode`.",
        ),
        "`tuple[float, float]`, of 3 or 4 too": (tuple[float, float], (0.0, 0.0), "A vector of as many numbers."),
        "`RGBA`": (vocabulary.RGBA, (0.0, 0.0, 0.0, 1.0), "A scene-linear color, edited with a picker."),
        "`Fraction`": (vocabulary.Fraction, 0.5, "A number from 0 to 1."),
        "`Position`": (
            vocabulary.Position,
            (0.5, 0.5),
            "A place in fractions of the picture, dragged in the viewer. Its pixel is `place * vec2(extent)`.",
        ),
        "`Kernel3x3`": (vocabulary.Kernel3x3, (0.0,) * 9, "Nine numbers by rows; GLSL fills columns with them."),
        "`Points`": (vocabulary.Points, (), "A curve. `curve_knots` prepares it, `lib/curve.glsl` reads it."),
        "`Stops`": (vocabulary.Stops, (), "A color ramp. `ramp_knots` prepares it, `lib/curve.glsl` reads it."),
        "`LightSet`": (vocabulary.LightSet, vocabulary.ItemSet(), "Lights by name, read by `lights_of` in `passes`."),
        "`FilePath`, `RenderPath`, `TablePath`, `ScenePath`": (
            vocabulary.FilePath,
            "",
            "The path of a picture, a render, a color table or a scene, for `passes`.",
        ),
        "`str`": (str, "", "A text, for `passes`."),
    }
)
"""How an annotation is written -> the annotation, a default for it, what it means."""

BUILT_INS = (
    ("ivec2 pixel", "the pixel that is made; 0,0 is the top left"),
    ("ivec2 extent", "the size of the picture that is made"),
    ("int frame", "the frame that is rendered"),
    ("float proxy", "the scale of the render: 1 at full size, 0.5 for a proxy of half the size"),
    ("T NAME_at(ivec2 p)", "the pixel of picture NAME at p; 0 where it is NaN or infinite"),
    ("T NAME_near(vec2 p)", "the picture between pixels, bilinear; the center of the first pixel is at 0.5, 0.5"),
    ("T NAME_raw(ivec2 p)", "the pixel as it is, NaN and infinity included"),
    ("ivec2 NAME_size", "the size of picture NAME"),
    ("bool NAME_has(ivec2 p)", "true if picture NAME has a pixel at p, in its frame or beyond"),
    ("bool inside(ivec2 p, ivec2 size)", "true if p lies in a picture of that size"),
    ("bool is_hole(T c)", "true if a channel is NaN or infinite"),
    ("VALUE_CHOICE", "the number of a choice of the value VALUE, such as `MODE_SOFT_LIGHT`"),
)
"""What a function may use without including anything; `tests/compiler/test_built_ins.py` draws with each of them."""

TYPE_NAMES = (
    "Pixels",
    "Argument",
    "Affine",
    "Kernel",
    "Overlap",
    "Size",
    "Edge",
    "Plain",
    "Uniform",
    "Holds",
)
"""Types in signatures whose docstrings follow the methods of Draw."""

INTRODUCTION = """\
# What a node may use

Generated from the code by `./dev renew`. [CONTRIBUTING](CONTRIBUTING.md#a-node) and [plug-ins](plugins.md) say how to
write a node; [shaders.md](shaders.md) is about GLSL in a graph, which may use the same libraries.

A node is a class and a GLSL file. The class body declares sockets and values; import what it uses from
`halation.nodes`, in Halation itself from `.._declare`. Sockets and values reach GLSL in declared order. A class that
declares no output has one Image, `out`.

A node whose first output is its input `image`, changed, at the same size, gets an input `mask` and the values `mix` and
`invert_mask` by itself. They are no parameters of its GLSL: Halation applies them after the node. A node that declares
`mask` or `invert_mask` itself gets only `mix`, because only the node knows what a mask of its own does; one that
declares `mix` gets none of the three. `halation nodes --check` says so. Choose another name, such as `matte`, to keep
the mask of Halation.
"""
DRAWS = """\
## Drawing

`passes(self, draw)` of a `Filter` records what to draw and returns the last result, or a result for each output by
name. Nothing runs yet. Functions are those of the node's own GLSL file and of
the libraries that it includes.

`draw(...)` calls a function that reads pictures by name, at any place; `draw.point` one that gets pixels as parameters:

```python
def passes(self, draw: Draw) -> Drawn:
    reach = math.ceil(self.distance) + 1  # `near` reads one pixel more
    return draw("smear", self.image, overlap=reach, away=(self.distance, 0.0))
```

```glsl
vec4 smear(vec2 away) { return 0.5 * (image_at(pixel) + image_near(vec2(pixel) + 0.5 - away)); }
```

`self` has the values in working units: lengths (`px` and `height`) in pixels of the picture that is rendered, also in a
proxy, and angles in radians. They are plain numbers, so `passes` may calculate with them, and choose how many draws it
takes. Sockets such as `self.image` stand for pictures: pass them on. No value of a filter can be linked; what is linked
comes through a socket, such as a `Number`.

An `overlap` that is too small shows as seams in large pictures; `halation nodes --check` finds it.

The arguments of `draw.point` are the parameters of the GLSL function, in its order and by its names: first the inputs,
then the keywords. A keyword is a picture that was drawn before, a value or a number:

```python
def passes(self, draw: Draw) -> Drawn:
    soft = draw.blur(self.image, sigma=2.0 * self.radius)
    return draw.point("haze", self.image, self.depth, soft=soft, far=self.far, amount=0.5 * self.amount)
```

```glsl
vec4 haze(vec4 image, float depth, vec4 soft, float far, float amount)
```
"""
GLSL = """\
## GLSL: names in every function

`NAME` stands for each picture that the function reads, and `T` for its type (`vec4` for an Image, `float` for a
Field). What lies outside of a picture follows the `edge` of the draw. A pointwise function may use all but the pictures
by name: its pictures are parameters. Programs are GLSL 4.10. Functions, their parameters, sockets and values need
names that GLSL and the pass do not use: not `length`, `distance`, `mix` or `pixel`.
"""
INCLUDES = """\
## GLSL: libraries

Include them by `#include "lib/color.glsl"`. Functions that read pictures say so: they work in a draw that has pictures
of these names.
"""


def write_reference() -> str:
    """The whole page."""
    blocks = [INTRODUCTION.rstrip(), "## Classes", _write_table(("class", "for"), _describe_bases())]
    blocks += ["These members may be set or overridden:", _write_table(("member", ""), _describe_members())]
    blocks += ["## Sockets", _write_table(("socket", "in GLSL", "carries"), _describe_sockets())]
    blocks += [*describe_callable("Socket", Socket), *describe_callable("OutputSocket", OutputSocket)]
    blocks += ["## Values", _write_table(("annotation", "in GLSL", "means"), _describe_types())]
    blocks += ["Put notes on a type with `Annotated[type, note, ...]`:"]
    blocks += [block for name in NOTES for block in describe_callable(name, getattr(vocabulary, name))]
    blocks += ["### Units", _describe_units(), "## Traits", describe(Trait)]
    blocks += [_write_table(("trait", "says"), ((f"`{name}`", doc) for name, doc in _attribute_docs(traits, "Trait")))]
    blocks += describe_callable("ProxyNote", vocabulary.ProxyNote)
    blocks += [DRAWS.rstrip(), _write_table(("property", "is"), _describe_properties())]
    blocks += [*(block for name in _list_draws() for block in _describe_draw(name))]
    blocks += ["### Types in signatures", _write_table(("type", "is"), _describe_type_names())]
    blocks += [*describe_callable("Reach", vocabulary.Reach), "`Reach.block` and `Reach.within` make the usual ones:"]
    blocks += [_write_table(("method", "returns"), _describe_reaches())]
    blocks += ["## Functions for `passes`", _write_table(("function", "returns"), _describe_helpers())]
    blocks += [GLSL.rstrip(), _write_table(("name", "is"), ((f"`{name}`", doc) for name, doc in BUILT_INS))]
    blocks += [INCLUDES.rstrip(), *(block for file in list_libraries() for block in describe_library(file))]
    return "\n\n".join(blocks) + "\n"


def list_libraries() -> list[Path]:
    """The shader files that a node may include."""
    return [file for file in sorted(LIBRARIES.glob("*.glsl")) if file.stem not in INTERNAL_LIBRARIES]


def describe_library(file: Path) -> Iterator[str]:
    """A heading, the comment at the head of the file, and its functions with their comments."""
    source = file.read_text(encoding="utf-8")
    lines = source.split("\n")
    yield f"### lib/{file.name}"
    head = _read_comment(lines, _find_end_of_head(lines))
    functions = parse(file.stem, source).all_functions
    if head:
        yield textwrap.fill(head, 120)
    signatures = (f"`{_read_signature(lines, item)}`" for item in functions)
    yield _write_table(("function", "returns or does"), zip(signatures, find_comments(lines, functions), strict=True))


def find_comment(lines: list[str], function: GlslFunction) -> str:
    """The comment above a GLSL function, or above those on single lines directly before it; "" if there is none."""
    at = function.line - 1
    while at > 0 and re.match(r"\w.*\{.*\}$", lines[at - 1]):
        at -= 1
    return _read_comment(lines, at)


def find_comments(lines: list[str], functions: Iterable[GlslFunction]) -> list[str]:
    """The comment of each function; an overload without one has that of the first function of its name."""
    comments: dict[str, str] = {}
    for item in functions:
        comments[item.name] = comments.get(item.name) or find_comment(lines, item)
    return [comments[item.name] for item in functions]


def _find_end_of_head(lines: list[str]) -> int:
    """The line after the comment that begins a file; 0 if it begins otherwise, or the comment is a function's."""
    end = next(index for index, line in enumerate(lines) if not line.startswith("//"))
    return end if lines[end] == "" or lines[end].startswith(("#", "const")) else 0


def _read_comment(lines: list[str], end: int) -> str:
    start = end
    while start > 0 and lines[start - 1].startswith("//"):
        start -= 1
    return " ".join(line.removeprefix("//").strip() for line in lines[start:end])


def _read_signature(lines: list[str], function: GlslFunction) -> str:
    text = " ".join(line.strip() for line in lines[function.line - 1 :])
    return re.sub(r"\( ", "(", re.sub(r" \)", ")", text.partition("{")[0].strip()))


def _write_table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    lines = (f"| {' | '.join(_join_lines(cell).replace('|', chr(92) + '|') for cell in row)} |" for row in rows)
    return "\n".join((f"| {' | '.join(head)} |", f"|{'---|' * len(head)}", *lines))


def _join_lines(text: str | None) -> str:
    return " ".join((text or "").split())


def _describe_bases() -> Iterator[tuple[str, str]]:
    for base in BASES:
        yield f"`{base.__name__}`", _join_lines(base.__doc__)


def _describe_members() -> Iterator[tuple[str, str]]:
    docs = dict(_attribute_docs(node_module, "Node"))
    for name in NODE_ATTRIBUTES:
        yield f"`{name}`", docs.get(name, "The version of the saved values: raise it when they change their meaning.")
    for name in OVERRIDES:
        method = getattr(Node, name)
        yield f"`{_write_line(name, method)}`", _join_lines(method.__doc__)


def _describe_sockets() -> Iterator[tuple[str, str, str]]:
    classes = [item for item in vars(sockets).values() if inspect.isclass(item) and issubclass(item, Socket)]
    for item in classes:
        if item is Socket:
            continue
        if KINDS[item.kind].carried == "plan":
            types = "never"
        else:
            types = "`vec2`, `vec3`, `vec4`" if item is Vector else f"`{item().glsl}`"
        yield f"`{item.__name__}`", types, _join_lines(item.__doc__)


def _describe_types() -> Iterator[tuple[str, str, str]]:
    for name, (hint, default, doc) in TYPES.items():
        glsl = read_value("value", hint, default).glsl
        shown = "the same" if hint is float and glsl == "float" else f"`{glsl}`" if glsl else "never"
        yield name, shown, doc


def _describe_units() -> str:
    docs = _constant_docs(values)
    assert set(re.findall(r"`(\w+)`", docs["Unit"])) == set(get_args(vocabulary.Unit))
    return textwrap.fill(" ".join(docs["Unit"].split()), 120)


def _describe_properties() -> Iterator[tuple[str, str]]:
    for name, item in vars(Draw).items():
        if isinstance(item, property):
            yield f"`draw.{name}`", _join_lines(item.__doc__)


def _list_draws() -> list[str]:
    names = [name for name, item in vars(Draw).items() if inspect.isfunction(item) and name[0] != "_"]
    return ["__call__", *names]


def _describe_draw(name: str) -> Iterator[str]:
    shown = "draw" if name == "__call__" else f"draw.{name}"
    heading, *rest = describe_callable(shown, getattr(Draw, name))
    yield heading
    yield from (re.sub(r"\bself,?\s*", "", block, count=1) for block in rest)


def _describe_helpers() -> Iterator[tuple[str, str]]:
    for name in sorted((*vocabulary.__all__, *item_kinds.__all__)):
        helper = getattr(vocabulary, name)
        if inspect.isfunction(helper) and helper.__module__.startswith("halation.nodes._declare"):
            yield f"`{_write_line(name, helper)}`", _join_lines(helper.__doc__)


def _describe_reaches() -> Iterator[tuple[str, str]]:
    for name in ("block", "within"):
        method = getattr(vocabulary.Reach, name)
        yield f"`{_write_line(f'Reach.{name}', method)}`", _join_lines(method.__doc__)


def _describe_type_names() -> Iterator[tuple[str, str]]:
    docs = {name: doc for module in (draw_module, sockets, values) for name, doc in _constant_docs(module).items()}
    aliases = {name: item for module in (draw_module, sockets, values) for name, item in vars(module).items()}
    for name in TYPE_NAMES:
        choices = get_args(aliases[name]) if get_origin(aliases[name]) is Literal else ()
        yield f"`{name}`", f"{_join_lines(docs[name])} {' '.join(f'`{json.dumps(choice)}`' for choice in choices)}"


def _write_line(name: str, helper: Callable[..., Any]) -> str:
    """A signature on one line, for tables."""
    text = _join_lines(write_signature(name, helper))
    return text.replace("( ", "(").replace(", )", ")")


@cache
def _parse_module(path: str) -> ast.Module:
    return ast.parse(Path(path).read_text(encoding="utf-8"))


def _constant_docs(module: Any) -> dict[str, str]:
    return dict(_read_docs(_parse_module(module.__file__).body))


def _attribute_docs(module: Any, name: str) -> list[tuple[str, str]]:
    """The attributes of a class with the strings below them."""
    tree = _parse_module(module.__file__)
    body = next(item.body for item in tree.body if isinstance(item, ast.ClassDef) and item.name == name)
    return list(_read_docs(body))


def _read_docs(body: list[ast.stmt]) -> Iterator[tuple[str, str]]:
    for item, following in pairwise(body):
        match item, following:
            case (
                ast.AnnAssign(target=ast.Name(id=name)) | ast.Assign(targets=[ast.Name(id=name)]),
                ast.Expr(value=ast.Constant(value=str(doc))),
            ):
                yield name, doc
