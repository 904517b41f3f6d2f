"""The library of presets: those of Halation, of plug-ins and of the user's folders, with what each says about itself.

A preset is a graph file. Its name is that of the file, its description and tags are in `ui.about`, and its small
picture is beside it in `pictures`. Nothing else has to be kept: a file that is copied into a folder of the library is
a preset, and a file that is deleted is none.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

from halation.presets import paths as shipped_paths
from halation.presets import picture
from msgspec import Struct, field

from ..color.transforms import Array
from ..custom_nodes.plugins import name_presets
from ..document import save
from ..document.about import About, read_about, with_about
from ..errors import HalationError, OutputError, UsageError
from ..graph import Graph
from ..language.translation import mark, translate
from ..media.pictures.thumbnail import save_thumbnail
from ..resources.sandbox import UNRESTRICTED, Sandbox
from ..resources.user_folders import own_presets_folder
from .edits import paths

LONGEST_NAME = 60
"""Letters of a preset's name: what fits below its picture on the start screen, twice."""

_RESERVED = frozenset(
    {"con", "prn", "aux", "nul", *(f"{port}{number}" for port in ("com", "lpt") for number in range(10))}
)
"""Names that Windows gives to devices, whatever their ending: shared folders are read there too."""


class PresetFacts(Struct, frozen=True):
    """A preset in the library. `fault` says why its file cannot be read, "" if it can."""

    path: Path
    name: str
    about: About = field(default_factory=About)
    fault: str = ""
    is_own: bool = False
    """True for a preset in a folder of the user."""

    @property
    def category(self) -> str:
        """The first tag, or where it comes from."""
        return (
            mark("my presets", "category")
            if self.is_own
            else self.about.tags[0]
            if self.about.tags
            else mark("other", "category")
        )


class PresetLibrary:
    """Lists the presets. A file is read again only after it has changed."""

    def __init__(self) -> None:
        self._read: dict[Path, tuple[tuple[int, int], PresetFacts]] = {}

    def list_presets(self) -> tuple[PresetFacts, ...]:
        """Every preset: the user's own first, then those of Halation and of plug-ins, by name."""
        shipped = frozenset(shipped_paths())
        presets = [self._find(name, path, path not in shipped) for name, path in name_presets().items()]
        return tuple(sorted(presets, key=lambda preset: not preset.is_own))

    def _find(self, name: str, path: Path, is_foreign: bool) -> PresetFacts:
        try:
            status = path.stat()
            version = status.st_mtime_ns, status.st_size
        except OSError as fault:
            return PresetFacts(path, name, fault=f"{path}: {fault.strerror}", is_own=is_foreign)
        if path not in self._read or self._read[path][0] != version:
            self._read[path] = version, _read_facts(name, path, is_foreign and "." not in name)
        return self._read[path][1]


def _read_facts(name: str, path: Path, is_own: bool) -> PresetFacts:
    try:
        return PresetFacts(path, name, read_about(path, sandbox=UNRESTRICTED), is_own=is_own)
    except HalationError as fault:
        return PresetFacts(path, name, fault=str(fault), is_own=is_own)


def make_preset_name(text: str) -> str:
    """The file name, without ending, of a preset that the user calls `text`: `My glow` is my_glow.

    Raises UsageError for what is no name in every system, and for the name of a preset of Halation.
    """
    name = re.sub(r"\s+", "_", text.strip()).lower()
    if not name:
        raise UsageError(translate("type a name"))
    if len(name) > LONGEST_NAME:
        raise UsageError(translate("the name is too long: use at most {most} letters", most=LONGEST_NAME))
    if not re.fullmatch(r"[\w-]+", name) or name.startswith("-"):
        raise UsageError(translate("use letters, digits, spaces, - and _ only, and no - at the start"))
    if name in _RESERVED:
        raise UsageError(translate("Windows gives the name '{name}' to a device: choose another one", name=name))
    if name in {path.stem for path in shipped_paths()}:
        raise UsageError(translate("'{name}' is a preset of Halation: choose another name", name=name))
    return name


def find_preset_file(name: str, folder: Path) -> Path:
    """The file of a preset in a folder: the one that is there, also where only capitals differ."""
    files = {file.stem.casefold(): file for file in folder.glob("*.json")}
    return files.get(name.casefold(), folder / f"{name}.json")


def save_preset(graph: Graph, about: About, path: Path, pixels: Array | None, sandbox: Sandbox) -> None:
    """Write a graph as a preset, with a picture [h, w, 3] of uint8 if there is one. Files that it names stay the same.

    Raises OutputError, and UsageError if the graph uses that file as a group.
    """
    paths.check_target(graph, path)
    try:
        (path.parent / "pictures").mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        raise OutputError(
            translate(
                "{parent}: the folder cannot be made ({reason}): choose another",
                parent=path.parent,
                reason=fault.strerror,
            )
        ) from None
    save(with_about(paths.rebase_paths(graph, str(path.parent)), about), path, sandbox=sandbox)
    if pixels is not None:
        save_thumbnail(picture(path), pixels, sandbox=sandbox)
    elif picture(path).is_file():
        os.remove(picture(path))  # noqa: PTH107


def list_folders(shared: tuple[str, ...]) -> tuple[Path, ...]:
    """Folders that presets can be saved to: the user's own, and those of the preferences."""
    return tuple(dict.fromkeys((own_presets_folder(), *map(Path, shared))))


def split_tags(text: str) -> tuple[str, ...]:
    """The tags in a text with commas, each once, in lower case."""
    return tuple(dict.fromkeys(tag for part in text.split(",") if (tag := " ".join(part.split()).lower())))
