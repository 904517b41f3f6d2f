"""Folders that the file browser offers, and paths that the user types."""

from __future__ import annotations

import os
import string
import sys
from collections import Counter
from collections.abc import Collection, Iterable, Iterator
from pathlib import Path
from typing import Literal

from msgspec import Struct
from msgspec.structs import replace

from ...language.translation import mark, translate

PlaceKind = Literal["home", "document", "folder", "recent", "drive"]

_MOUNTS = ("/media/", "/mnt/", "/run/media/", "/Volumes/")


class Place(Struct, frozen=True):
    """A folder in the list of places."""

    title: str
    path: Path
    kind: PlaceKind


def places(document: Path | None, recent: Iterable[Path], used: Iterable[Path]) -> tuple[Place, ...]:
    """The document's folder, home, folders of recent files and of last use, drives; each once, only what is there.

    Recent folders of one name also have that of the folder that they are in.
    """
    by_path: dict[Path, Place] = {}
    for place in _candidates(document, recent, used):
        if place.path not in by_path and os.path.isdir(place.path):  # noqa: PTH112 - False for what no system allows
            by_path[place.path] = place
    titles = Counter(place.title for place in by_path.values())
    found = (_tell_apart(place) if titles[place.title] > 1 else place for place in by_path.values())
    return tuple(sorted(found, key=lambda place: place.kind == "drive"))


def _tell_apart(place: Place) -> Place:
    around = place.path.parent
    return replace(place, title=f"{place.title} ({around.name or around})") if place.kind == "recent" else place


def _candidates(document: Path | None, recent: Iterable[Path], used: Iterable[Path]) -> Iterator[Place]:
    if document is not None:
        yield Place(translate("This document"), document, "document")
    home = Path.home()
    yield Place(translate("Home"), home, "home")
    for name in (mark("Desktop"), mark("Documents"), mark("Pictures")):
        yield Place(translate(name), home / name, "folder")
    for drive in drives():
        yield Place(drive.name or str(drive), drive, "drive")
    for folder in (*used, *recent):
        yield Place(folder.name or str(folder), folder, "recent")


def drives(mounts: Path = Path("/proc/mounts")) -> tuple[Path, ...]:
    """Roots of what is mounted: letters on Windows, volumes on macOS, media and network drives elsewhere."""
    if sys.platform == "win32":
        return tuple(Path(f"{letter}:\\") for letter in string.ascii_uppercase if os.path.exists(f"{letter}:\\"))  # noqa: PTH110
    if sys.platform == "darwin":
        return (Path("/"), *sorted(Path("/Volumes").iterdir()))
    try:
        lines = mounts.read_text(errors="replace").splitlines()
    except OSError:
        lines = []
    points = [line.split()[1].encode().decode("unicode_escape") for line in lines if len(line.split()) > 1]
    return (Path("/"), *(Path(point) for point in sorted(set(points)) if point.startswith(_MOUNTS)))


def complete_path(text: str, folder: Path) -> Path:
    """The path that was typed: `~` is home, what is relative starts in `folder`."""
    path = Path(text.strip().strip('"') or ".")
    try:
        path = path.expanduser()
    except RuntimeError:
        return folder / path
    return Path(os.path.normpath(folder / path))


def complete_name(text: str, folder: Path, endings: Collection[str] = ()) -> str:
    """A typed path with as much added as all names that begin like it share; a folder gets its separator.

    Files count if their name ends in one of `endings` (none: all). Letter case only matters where several names differ
    in nothing else.
    """
    head, stem = split_path(text)
    try:
        with os.scandir(complete_path(head, folder)) as entries:
            names = [entry.name + os.sep if entry.is_dir() else entry.name for entry in entries]
    except (OSError, ValueError):
        return text
    fitting = [
        name
        for name in names
        if name.lower().startswith(stem.lower())
        and (stem.startswith(".") or not name.startswith("."))
        and (name.endswith(os.sep) or not endings or os.path.splitext(name)[1].lower() in endings)  # noqa: PTH122
    ]
    fitting = [name for name in fitting if name.startswith(stem)] or fitting
    shared = os.path.commonprefix(fitting)  # noqa: RUF071 - letters that all share, as shells do
    return head + shared if len(shared) >= len(stem) else text


def is_path(text: str) -> bool:
    """Whether a text that was typed as a name is a path: it has a separator or starts at home."""
    text = text.strip().strip('"')
    return text.startswith("~") or any(separator in text for separator in (os.sep, os.altsep) if separator)


def split_path(text: str) -> tuple[str, str]:
    """A typed path up to its last separator and with it, and what is typed behind."""
    cut = max(text.rfind(separator) for separator in (os.sep, os.altsep or os.sep)) + 1
    return text[:cut], text[cut:]


def last_name(text: str) -> str:
    """What is typed behind the last separator of a path."""
    return split_path(text.strip().strip('"'))[1]


def names_folder(text: str) -> bool:
    """Whether a typed path can only be a folder: nothing at all, `.`, `..`, `~`, or a separator at its end."""
    return last_name(text) in ("", ".", "..", "~")
