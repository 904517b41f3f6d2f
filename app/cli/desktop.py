"""`halation desktop`: enters Halation into the desktop's menu."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from ..errors import UsageError
from ..resources.program import permanent_command
from ..resources.user_folders import find_desktop_folder
from .options import AsJson
from .outcome import print_json


def desktop(
    remove: Annotated[bool, typer.Option("--remove", help="Delete what this command wrote.")] = False,
    folder: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="The folder of shared data; by default that of the user, ~/.local/share."),
    ] = None,
    as_json: AsJson = False,
) -> int:
    """Add Halation to the desktop's menu.

    A double-click then opens graphs, and programs of the desktop offer Halation for pictures too. It writes an entry
    with an icon, the type of graphs, how thumbnails of graphs and EXR files are made, and manual pages for man. It
    prints the files that it writes.
    """
    from ..desktop import desktop_entries, install
    from ..desktop import remove as remove_files
    from .man_pages import write_man_pages

    if sys.platform in ("win32", "darwin"):
        raise UsageError("this is for desktops on Linux: on macOS and Windows, the application does this by itself")
    target = folder or find_desktop_folder()
    pages = {f"man/man1/{name}": text.encode() for name, text in write_man_pages().items()}
    files = {**desktop_entries(permanent_command()), **pages}
    paths = remove_files(target, files) if remove else install(target, files)
    if as_json:
        print_json({"removed" if remove else "written": [str(path) for path in paths]})
    else:
        print("\n".join(map(str, paths)) if paths else "nothing needs to change")
    return 0
