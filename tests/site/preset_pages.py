"""The gallery of presets: a picture of each, what it does and the controls to try."""

from __future__ import annotations

from collections.abc import Iterator

from halation import document
from halation.cli.manual import escape_markdown
from halation.document.about import find_about
from halation.presets import paths, picture
from halation.resources.sandbox import UNRESTRICTED

INTRODUCTION = """\
# Presets

{count} graphs that are ready to use by their names: `halation render soft_bloom -i beauty=shot.exr -o out.png`. In the
editor they are on the start screen. A control is set by its name: `--set glow=0.3`.
"""


def write_gallery() -> str:
    """The page of all presets."""
    blocks = [INTRODUCTION.format(count=len(paths())).rstrip()]
    for path in paths():
        graph = document.load(path, sandbox=UNRESTRICTED)
        about = find_about(graph)
        blocks.append(f"## {path.stem}")
        blocks.append(f'![What {path.stem} makes of its sample](pictures/{path.stem}.jpg){{ loading="lazy" }}')
        blocks.append(escape_markdown(about.doc))
        rows = [
            f"| `{name}` | {escape_markdown(control.doc or control.label)} |"
            for name, control in graph.controls.items()
        ]
        if rows:
            blocks.append("\n".join(["| control | what it does |", "|---|---|", *rows]))
    return "\n\n".join(blocks) + "\n"


def picture_files() -> Iterator[tuple[str, bytes]]:
    """The pictures of all presets, with their paths in the site."""
    for path in paths():
        yield f"pictures/{path.stem}.jpg", picture(path).read_bytes()
