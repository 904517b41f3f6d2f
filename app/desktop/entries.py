"""The files by which a desktop of freedesktop.org knows a program.

A graph is JSON, and most graphs end in `.json` as other JSON files do. So the type of graphs claims that ending with
the weight that plain JSON has: then the desktop looks into the file (shared-mime-info specification, "Recommended
checking order"). GLib takes the first type that fits what it sees there: so plain JSON has a rule too, and graphs are
no kind of JSON but of text.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

GRAPH_TYPE = "application/x-halation-graph"
PICTURE_TYPES = ("image/x-exr", "image/vnd.radiance", "image/tiff", "image/png", "image/jpeg")
"""Pictures that Halation offers to open. Of the first two, which few desktops show, it also makes thumbnails."""

_ICONS = Path(__file__).parent / "icons"
_HEAD = 32768
"""Bytes of a file in which the line of its format is looked for: controls and groups stand before it."""

_ENTRY = """\
[Desktop Entry]
Type=Application
Name=Halation
GenericName=Compositor
Comment=Compose renders and photographs with a graph of effects
Keywords=compositing;nodes;render;exr;vfx;shader;
Categories=Graphics;2DGraphics;
Exec={program} edit --show-errors %f
Icon=halation
Terminal=false
StartupNotify=true
StartupWMClass=Halation
MimeType={types};
"""

_MIME = """\
<?xml version="1.0" encoding="UTF-8"?>
<mime-info xmlns="http://www.freedesktop.org/standards/shared-mime-info">
  <mime-type type="{type}">
    <comment>Halation graph</comment>
    <sub-class-of type="text/plain"/>
    <icon name="halation"/>
    <magic priority="60">
      <match type="string" offset="0:16" value="{{">
        <match type="string" offset="1:{head}" value="&quot;halation&quot;: "/>
      </match>
    </magic>
    <glob pattern="*.json"/>
  </mime-type>
  <mime-type type="application/json">
    <magic priority="10">
      <match type="string" offset="0:16" value="{{"/>
      <match type="string" offset="0:16" value="["/>
    </magic>
    <glob pattern="*.json"/>
  </mime-type>
</mime-info>
"""

_THUMBNAILER = """\
[Thumbnailer Entry]
Exec={program} thumbnail %i %o --size %s
MimeType={types};
"""


def desktop_entries(program: Sequence[str]) -> Mapping[str, bytes]:
    """The content of each file by its path in a folder of shared data (`~/.local/share`, `/usr/share`).

    `program` is the command that runs Halation.
    """
    command = " ".join(map(_quote, program))
    texts = {
        "applications/halation.desktop": _ENTRY.format(program=command, types=";".join((GRAPH_TYPE, *PICTURE_TYPES))),
        "mime/packages/halation.xml": _MIME.format(type=GRAPH_TYPE, head=_HEAD),
        "thumbnailers/halation.thumbnailer": _THUMBNAILER.format(
            program=command, types=";".join((GRAPH_TYPE, *PICTURE_TYPES[:2]))
        ),
    }
    icons = {
        f"icons/hicolor/{path.stem}x{path.stem}/apps/halation.png": path.read_bytes()
        for path in sorted(_ICONS.glob("*.png"))
    }
    return MappingProxyType({**{path: text.encode() for path, text in texts.items()}, **icons})


def _quote(word: str) -> str:
    """A word of a command in an entry: in double quotes where needed, as "The Exec key" of the specification says."""
    word = word.replace("%", "%%")
    if re.fullmatch(r"[\w%./-]+", word):
        return word
    for character in '\\"`$':
        word = word.replace(character, f"\\{character}")
    return '"' + word.replace("\\", "\\\\") + '"'  # strings of entries have escapes of their own
