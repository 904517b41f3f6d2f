"""Puts the text of a script together."""

from __future__ import annotations

import os
import textwrap
from collections.abc import Iterable
from pathlib import Path

from ...document.about import find_about
from ...resources.atomic_write import write_text_atomically
from ...version import VERSION
from ..order import ExportOrder, ExportReport
from ..shipped_files import read_shipped_text
from .calls import CallWriter
from .library import Definition, FunctionLibrary, load_library
from .numbers import write_plain
from .outline import ScriptCall, ScriptClip, ScriptOutline
from .pruning import AskedChoices, prune

_WIDTH = 110
"""Columns of the lines that a script has of its own: a few less than those of its functions."""


_FILE_FUNCTIONS = ("file_of_frame", "read_picture", "write_picture")

_READ_INPUT = '''
@lru_cache(maxsize=8)
def read_input(name: str, frame: int) -> Array:
    """An input at a frame."""
    file, layer, channels, width, height = INPUTS[name]
    return read_picture(file_of_frame(file, frame), layer, channels, width, height)
'''

_MOST_KEPT = 32
"""Frames of one function that a script keeps at most. Chosen by judgement: 2 GB of full HD."""


def export_script(order: ExportOrder) -> ExportReport:
    """Write the script. Raises GraphError for a node without a function, OutputError."""
    outline = CallWriter(order).write()
    text = write_script(order, outline)
    figures: dict[str, float | str] = {
        "nodes": sum(call.function in outline.functions for call in outline.list_calls()),
        "functions": len(outline.functions),
        "lines": len(text.splitlines()),
    }
    if order.output is None:
        return ExportReport(text=text, figures=figures)
    write_text_atomically(order.output, text, sandbox=order.sandbox)
    return ExportReport((str(order.output),), (), figures)


def write_script(order: ExportOrder, outline: ScriptOutline) -> str:
    """The script of an outline: only functions that it calls, each after those that it uses."""
    library = _prune_library(outline)
    collected = library.collect([*sorted(outline.helpers), *outline.functions])
    nodes = [each for name in outline.functions for each in collected if each.name == name]
    shared = [each for each in collected if each not in nodes]
    files = [each for each in library.collect(_list_file_functions(outline)) if each not in collected]
    imports = [*library.list_imports([*collected, *files]), "import argparse", "import numpy as np"]
    if outline.inputs:
        imports.append("from pathlib import Path")
    if outline.clips or (outline.reads_inputs and outline.inputs):
        imports.append("from functools import lru_cache")
    if outline.memories:
        imports.append("from collections.abc import Iterator")
    sections = [
        "\n\n".join([_write_head(order, outline), _write_imports(imports), _write_constants(order, outline)]),
        *_write_section("Parts of pictures", shared),
        *_write_section("What nodes do", nodes),
        _write_title("The graph"),
        *(_write_clip(clip) for clip in outline.clips),
        _write_frames(outline) if outline.memories else _write_body(outline),
        *_write_section("Files", files),
        *([_READ_INPUT] if outline.reads_inputs and outline.inputs else []),
        _write_main(outline),
    ]
    return "\n\n\n".join(section.strip("\n") for section in sections) + "\n"


def _prune_library(outline: ScriptOutline) -> FunctionLibrary:
    """The functions without what this graph never asks them for."""
    asked = AskedChoices(
        {key: frozenset(texts) for key, texts in outline.choices.items()},
        {key: frozenset(texts) for key, texts in outline.options.items()},
        {key: frozenset(states) for key, states in outline.switches.items()},
    )
    return prune(load_library(), [*sorted(outline.helpers), *outline.functions, *_FILE_FUNCTIONS], asked)


def _list_file_functions(outline: ScriptOutline) -> list[str]:
    """The functions that read and write files."""
    unused = {"file_of_frame"} if not outline.uses_frame else set[str]()
    unused |= {"read_picture"} if not outline.inputs else set[str]()
    return [name for name in _FILE_FUNCTIONS if name not in unused]


def _write_head(order: ExportOrder, outline: ScriptOutline) -> str:
    """What the script is, how it is run, and what arrays mean in it."""
    title = order.name.replace("_", " ").replace('"""', "'''").replace("\\", "/").strip().capitalize()
    about = find_about(order.graph).doc.replace("\\", "/").replace('"""', "'''")
    needs = "numpy, scipy and, for files other than .npy, OpenImageIO"
    main = "make_pictures" if outline.memories else "make_picture"
    example = next((f" -i {name}=frame.exr" for name in outline.inputs), "")
    paragraphs = [
        " ".join(about.split()),
        f"The picture of a node graph by plain numpy, slowly: one function for each kind of node, and `{main}`"
        f" calls them in the order of the graph. Written by Halation {VERSION}; needs {needs}.",
        f"    python {order.output.name if order.output else order.name + '.py'} -o picture.exr{example}",
        "Pictures are arrays [height, width, channels] of scene-linear light (linear Rec.709), row 0 at the top. An"
        " Image has red, green, blue and alpha, premultiplied; a Field has one channel, a Vector two or three. Lengths"
        " are in pixels, angles in radians.",
    ]
    lines = [part if part.startswith("    ") else textwrap.fill(part, _WIDTH) for part in paragraphs if part]
    return f'"""{title}.\n\n' + "\n\n".join(lines) + '\n"""'


def _write_imports(lines: Iterable[str]) -> str:
    """The import lines in two groups, as linters sort them; names of one module on one line."""
    names: dict[str, list[str]] = {}
    plain: list[str] = []
    for line in sorted(set(lines)):
        if line.startswith("from "):
            module, name = line.removeprefix("from ").split(" import ")
            names.setdefault(module, []).append(name)
        else:
            plain.append(line)
    plain += [f"from {module} import {', '.join(sorted(module_names))}" for module, module_names in names.items()]
    own = sorted((line for line in plain if not _is_science(line)), key=_sort_key)
    science = sorted((line for line in plain if _is_science(line)), key=_sort_key)
    return "from __future__ import annotations\n\n" + "\n".join(own) + "\n\n" + "\n".join(science)


def _is_science(line: str) -> bool:
    return line.split()[1].partition(".")[0] in ("numpy", "scipy")


def _sort_key(line: str) -> tuple[bool, str]:
    return line.startswith("from "), line


def _write_constants(order: ExportOrder, outline: ScriptOutline) -> str:
    """The size, the frame, the files, and the numbers of animated values."""
    width, height = outline.size
    lines = [f"WIDTH, HEIGHT = {width}, {height}  # of the picture"]
    if outline.uses_frame:
        lines += [
            f"FRAMES = ({outline.frames[0]}, {outline.frames[1]})  # the first and the last",
            f"FRAME = {outline.frame}",
        ]
    if outline.read_frames != outline.frames and outline.tables:
        lines.append(f"READ_FRAMES = ({outline.read_frames[0]}, {outline.read_frames[1]})  # in order to make these")
    if outline.uses_rate:
        lines.append(f"RATE = {write_plain(outline.rate)}  # frames per second")
    lines.append(f"OUTPUT = {write_plain(order.name + '.exr')}")
    if outline.inputs:
        lines += ["INPUTS = {  # file, layer, channels, width, height"]
        for name, each in outline.inputs.items():
            file = _write_path(each.file, order.output)
            size = _write_size(each.size, outline.size)
            lines.append(
                f"    {write_plain(name)}: ({write_plain(file)}, {write_plain(each.layer)}, {each.channels}, {size}),"
            )
        lines.append("}")
    for name, numbers in outline.tables.items():
        rows = textwrap.fill(", ".join(write_plain(number) for number in numbers) + ",", _WIDTH - 4)
        lines.append(f"{name} = (  # frame by frame\n{textwrap.indent(rows, '    ')}\n)")
    return "\n".join(lines)


def _write_path(file: str, output: Path | None) -> str:
    """A file, as seen from the folder of the script."""
    if not file or output is None:
        return file
    return Path(os.path.relpath(file, output.resolve().parent)).as_posix()


def _write_size(size: tuple[int, int], usual: tuple[int, int]) -> str:
    return "WIDTH, HEIGHT" if size == usual else f"{size[0]}, {size[1]}"


def _write_title(title: str) -> str:
    return f"# --- {title} {'-' * (_WIDTH - len(title) - 7)}"


def _write_section(title: str, definitions: list[Definition]) -> list[str]:
    return [_write_title(title), *(definition.text for definition in definitions)] if definitions else []


def _write_clip(clip: ScriptClip) -> str:
    """A function of the frame."""
    lines = [
        f"@lru_cache(maxsize={min(clip.span + 1, _MOST_KEPT)})",
        f"def {clip.name}(frame: int) -> {'Array' if len(clip.results) == 1 else 'tuple[Array, ...]'}:",
        '    """A part of the graph, at a frame."""',
    ]
    for call in clip.calls:
        lines += _write_call(call)
    return "\n".join([*lines, f"    return {', '.join(clip.results)}"])


def _write_body(outline: ScriptOutline) -> str:
    """`make_picture`: one call after the other."""
    parameters = [] if outline.reads_inputs else [f"{name}: Array" for name in outline.inputs]
    parameters += ["frame: int = FRAME"] if outline.uses_frame else []
    lines = [f"def make_picture({', '.join(parameters)}) -> Array:", '    """The picture of the graph."""']
    for call in outline.calls:
        lines += _write_call(call)
    return "\n".join([*lines, f"    return {outline.result}"])


def _write_frames(outline: ScriptOutline) -> str:
    """`make_pictures`, where nodes remember the frame before: one frame after the other, from the first one."""
    start = "min(FRAMES[0], first)"
    if outline.preroll is not None:
        start = f"min(max(FRAMES[0], first - {outline.preroll}), first)"
    lines = [
        "def make_pictures(first: int, last: int) -> Iterator[Array]:",
        '    """The pictures of the graph from a first to a last frame. What nodes remember begins before."""',
        *(f"    {memory} = None" for memory in outline.memories),
        f"    for frame in range({start}, last + 1):",
    ]
    for call in outline.loop:
        lines += _write_call(call, 8)
    if outline.calls:
        lines += ["        if frame < first:", "            continue"]
    for call in outline.calls:
        lines += _write_call(call, 8)
    if not outline.calls:
        lines += ["        if frame >= first:", f"            yield {outline.result}"]
    else:
        lines += [f"        yield {outline.result}"]
    return "\n".join(lines)


def _write_call(call: ScriptCall, indent: int = 4) -> list[str]:
    """One call, on one line or with one argument on each."""
    start = f"{' ' * indent}{', '.join(call.targets)} = {call.function}("
    line = f"{start}{', '.join(call.arguments)})"
    if len(line) <= _WIDTH:
        return [line]
    inner = f"{' ' * indent}    {', '.join(call.arguments)}"
    if len(inner) <= _WIDTH:
        return [start, inner, f"{' ' * indent})"]
    return [start, *(f"{' ' * indent}    {argument}," for argument in call.arguments), f"{' ' * indent})"]


def _write_main(outline: ScriptOutline) -> str:
    """The command line of the script."""
    arguments = ["**inputs"] if outline.inputs and not outline.reads_inputs else []
    arguments += ["frame=frame"] if outline.uses_frame else []
    text = read_shipped_text("script_main.py.txt").replace("#arguments#", ", ".join(arguments))
    has_frames, has_inputs = outline.uses_frame, bool(outline.inputs)
    used = {
        "#inputs#": has_inputs,
        "#given#": has_inputs and not outline.reads_inputs and not has_frames,
        "#still#": not has_frames,
        "#frames#": has_frames,
        "#tables#": bool(outline.tables),
        "#each#": has_frames and not outline.memories,
        "#each_given#": has_frames and has_inputs and not outline.reads_inputs,
        "#run#": bool(outline.memories) and outline.preroll is None,
        "#runs#": bool(outline.memories) and outline.preroll is not None,
    }
    lines: list[str] = []
    for line in text.splitlines():
        mark = next((mark for mark in used if line.startswith(mark)), "")
        if not mark or used[mark]:
            lines.append(line.removeprefix(mark))
    return "\n".join(lines)
