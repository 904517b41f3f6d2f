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
from .outline import ScriptCall, ScriptOutline
from .pruning import AskedChoices, prune

_WIDTH = 110
"""Columns of the lines that a script has of its own: a few less than those of its functions."""


def export_script(order: ExportOrder) -> ExportReport:
    """Write the script. Raises GraphError for a node without a function, OutputError."""
    outline = CallWriter(order).write()
    text = write_script(order, outline)
    figures: dict[str, float | str] = {
        "nodes": sum(call.function in outline.functions for call in outline.calls),
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
    readers = ["read_picture"] if outline.inputs else []
    files = [each for each in library.collect([*readers, "write_picture"]) if each not in collected]
    imports = [*library.list_imports([*collected, *files]), "import argparse", "import numpy as np"]
    if outline.inputs:
        imports.append("from pathlib import Path")
    sections = [
        "\n\n".join([_write_head(order, outline), _write_imports(imports), _write_constants(order, outline)]),
        *_write_section("Parts of pictures", shared),
        *_write_section("What nodes do", nodes),
        _write_title("The graph"),
        _write_body(outline),
        *_write_section("Files", files),
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
    return prune(load_library(), [*sorted(outline.helpers), *outline.functions, "read_picture", "write_picture"], asked)


def _write_head(order: ExportOrder, outline: ScriptOutline) -> str:
    """What the script is, how it is run, and what arrays mean in it."""
    title = order.name.replace("_", " ").replace('"""', "'''").replace("\\", "/").strip().capitalize()
    about = find_about(order.graph).doc.replace("\\", "/").replace('"""', "'''")
    needs = "numpy, scipy and, for files other than .npy, OpenImageIO"
    example = next((f" -i {name}=frame.exr" for name in outline.inputs), "")
    paragraphs = [
        " ".join(about.split()),
        f"The picture of a node graph by plain numpy, slowly: one function for each kind of node, and `make_picture`"
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


def _write_body(outline: ScriptOutline) -> str:
    """`make_picture`: one call after the other."""
    parameters = [f"{name}: Array" for name in outline.inputs] + (["frame: int = FRAME"] if outline.uses_frame else [])
    lines = [f"def make_picture({', '.join(parameters)}) -> Array:", '    """The picture of the graph."""']
    for call in outline.calls:
        lines += _write_call(call)
    return "\n".join([*lines, f"    return {outline.result}"])


def _write_call(call: ScriptCall) -> list[str]:
    """One call, on one line or with one argument on each."""
    start = f"    {', '.join(call.targets)} = {call.function}("
    line = f"{start}{', '.join(call.arguments)})"
    if len(line) <= _WIDTH:
        return [line]
    inner = f"        {', '.join(call.arguments)}"
    if len(inner) <= _WIDTH:
        return [start, inner, "    )"]
    return [start, *(f"        {argument}," for argument in call.arguments), "    )"]


def _write_main(outline: ScriptOutline) -> str:
    """The command line of the script."""
    arguments = (["**inputs"] if outline.inputs else []) + (["frame=words.frame"] if outline.uses_frame else [])
    text = read_shipped_text("script_main.py.txt").replace("#arguments#", ", ".join(arguments))
    for mark, is_used in (("#inputs#", bool(outline.inputs)), ("#frame#", outline.uses_frame)):
        lines = text.splitlines()
        text = "\n".join(line.removeprefix(mark) for line in lines if is_used or not line.startswith(mark))
    return text
