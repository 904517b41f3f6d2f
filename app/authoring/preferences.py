"""The preferences of the user, in a file of their own, never in documents."""

from __future__ import annotations

import contextlib
import json
import os
import time
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, Literal, cast, get_type_hints

import msgspec
from msgspec import Struct, field
from msgspec.structs import fields, replace

from ..errors import OutputError, UsageError
from ..language.translation import translate
from ..resources.atomic_write import write_text_atomically
from ..resources.sandbox import UNRESTRICTED
from ..resources.typed_data import convert_data
from ..resources.user_folders import PREFERENCES, state_folder
from .recovery.file_locks import hold_lock

MAX_RECENT = 20
MAX_SCALE = 3.0
MIN_SCALE = 0.75
MAX_SWATCHES = 24
"""Recent files, the range of the interface's scale, and colors that a user keeps: choices of design."""

SwatchColor = tuple[float, float, float, float]
"""A scene-linear color with its alpha."""

Purpose = Literal["graph", "image", "table", "scene", "font", "config", "code", "export"]


def _scale(number: float) -> float:
    if number and not MIN_SCALE <= number <= MAX_SCALE:
        raise ValueError(f"Expected 0 or a number in {MIN_SCALE:g}..{MAX_SCALE:g}")
    return number


class Recent(Struct, frozen=True):
    """A graph file that was open; `time` is in seconds since 1970."""

    path: str
    time: float = 0.0

    @property
    def exists(self) -> bool:
        """True if the file is still there."""
        return os.path.isfile(self.path)  # noqa: PTH113 - False, not an error, for a path that no system allows


class Preferences(Struct, frozen=True):
    """`ui_scale` is 0 for what the system says, `language` is "" then. `keymap` is the program whose shortcuts
    are used, `shortcuts` are those that differ from it, by action; "" stands for none. `separate_windows` lets panels
    be torn off.

    `recent` has the newest first. `folders` are those used last, by purpose. `autosave` is in seconds,
    `memory_budget` in MiB. `isf_folders` hold shaders that can be added, `preset_folders` presets. `swatches` are
    colors that the user keeps. `lessons` are those that were finished, by their ids. `extra` is what another
    version of Halation wrote.
    """

    theme: Literal["dark", "light", "contrast"] = "dark"
    reduced_motion: bool = False
    separate_windows: bool = False
    ui_scale: float = 0.0
    language: Literal["", "en", "de"] = ""
    keymap: Literal["halation", "nuke", "blender", "fusion"] = "halation"
    shortcuts: Mapping[str, str] = field(default_factory=lambda: MappingProxyType[str, str]({}))
    recent: tuple[Recent, ...] = ()
    folders: Mapping[Purpose, str] = field(default_factory=lambda: MappingProxyType[Purpose, str]({}))
    thumbnails: bool = True
    timings: bool = False
    minimap: bool = True
    autosave: Annotated[float, msgspec.Meta(ge=0.5, le=10.0)] = 5.0
    memory_budget: Annotated[int, msgspec.Meta(ge=64, le=2**20)] = 512
    hint_seen: bool = False
    proxy_while_dragging: bool = True
    isf_folders: tuple[str, ...] = ()
    preset_folders: tuple[str, ...] = ()
    swatches: tuple[SwatchColor, ...] = ()
    lessons: tuple[str, ...] = ()
    extra: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType[str, Any]({}))


TYPES = get_type_hints(Preferences, include_extras=True)
FAULTS = (msgspec.ValidationError, ValueError, TypeError)
CHECKS = {"ui_scale": _scale}
NAMES = tuple(field.name for field in fields(Preferences) if field.name != "extra")


class PreferenceStore:
    """Preferences in a folder. `now` is what holds; `faults` are sentences about what could not be read or written.

    Several editors share the file: each writes only what changed in it, over what the others wrote.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self.file = (folder or state_folder()) / PREFERENCES
        self.faults: list[str] = []
        self.current = self._read(Preferences())
        self._written = self.current
        self._forgotten: set[str] = set()

    def change(self, **values: Any) -> None:
        """Set preferences. Raises UsageError for an invalid value."""
        checked: dict[str, Any] = {}
        for name, value in values.items():
            if name not in NAMES:
                raise UsageError(translate("there is no preference '{name}'", name=name))
            try:
                checked[name] = _check_value(name, value)
            except FAULTS as fault:
                raise UsageError(
                    translate(
                        "the preference '{name}' cannot be {value!r}: {fault}",
                        name=name,
                        value=value,
                        fault=_lower_first(fault),
                    )
                ) from None
        self.current = replace(self.current, **checked)

    def note_opened(self, path: str | Path) -> None:
        """Note that a graph file was opened or saved."""
        here = os.path.abspath(path)  # noqa: PTH100 - links stay as they were named
        self._forgotten.discard(here)
        self.current = replace(self.current, recent=_merge_recent((Recent(here, time.time()),), self.current.recent))

    def forget(self, path: str | Path) -> None:
        """Take a file off the list of recent files."""
        self._forgotten.add(str(path))
        self.current = replace(
            self.current, recent=tuple(recent for recent in self.current.recent if recent.path != str(path))
        )

    def add_swatch(self, color: SwatchColor) -> None:
        """Keep a color among the swatches, the newest last; the oldest one goes when there are too many."""
        others = (swatch for swatch in self.current.swatches if swatch != color)
        self.change(swatches=(*others, color)[-MAX_SWATCHES:])

    def remove_swatch(self, color: SwatchColor) -> None:
        """Take a color off the swatches."""
        self.change(swatches=tuple(swatch for swatch in self.current.swatches if swatch != color))

    def folder(self, purpose: Purpose) -> str:
        """The folder that was used last for a purpose; "" if there is none."""
        folder = self.current.folders.get(purpose, "")
        return folder if os.path.isdir(folder) else ""  # noqa: PTH112 - as above

    def note_folder(self, purpose: Purpose, path: str | Path) -> None:
        """Note the folder of a file that was chosen."""
        self.change(folders={**self.current.folders, purpose: str(Path(path).absolute().parent)})

    def flush(self) -> bool:
        """Write what changed, if anything did; True if so. What cannot be written is tried again the next time."""
        if self.current == self._written and not self._forgotten:
            return False
        try:
            self.file.parent.mkdir(parents=True, exist_ok=True)
            with hold_lock(self.file.with_suffix(".lock")):
                self.current = self._merge_with_file()
                write_text_atomically(
                    self.file, json.dumps(_tree(self.current), indent=2, sort_keys=True) + "\n", sandbox=UNRESTRICTED
                )
        except OSError as fault:
            self._report(
                translate(
                    "preferences cannot be saved in {parent} ({reason})", parent=self.file.parent, reason=fault.strerror
                )
            )
            return False
        except OutputError as fault:
            self._report(translate("preferences cannot be saved: {fault}", fault=fault))
            return False
        self._written = self.current
        self._forgotten.clear()
        return True

    def _merge_with_file(self) -> Preferences:
        """The preferences of the file, with the changes of this editor."""
        there = self._read(self._written)
        changed = _list_differences(self.current, self._written)
        recent = tuple(entry for entry in there.recent if entry.path not in self._forgotten)
        return replace(there, **changed | {"recent": _merge_recent(self.current.recent, recent)})

    def _read(self, fallback: Preferences) -> Preferences:
        """The file's preferences; what is broken in it is reported, and `fallback` stands for it."""
        try:
            tree = json.loads(self.file.read_bytes())
            if not isinstance(tree, dict):
                raise ValueError("it is not a JSON object")
        except (FileNotFoundError, NotADirectoryError):
            return fallback
        except OSError as fault:
            self._report(
                translate("{file}: the preferences cannot be read ({reason})", file=self.file, reason=fault.strerror)
            )
            return fallback
        except (ValueError, RecursionError) as fault:
            self._set_aside(fault)
            return fallback
        values: dict[str, Any] = {}
        for name in NAMES:
            try:
                if name in tree:
                    values[name] = _check_value(name, self._sound_entries(name, tree[name]))
            except FAULTS as fault:
                self._report(
                    translate(
                        "{file}: '{name}' is left out ({fault})", file=self.file, name=name, fault=_lower_first(fault)
                    )
                )
                values[name] = getattr(fallback, name)
        extra = {name: item for name, item in tree.items() if name not in NAMES}
        return Preferences(**values, extra=MappingProxyType(extra))

    def _sound_entries(self, name: str, raw: Any) -> Any:
        """A list or object without the entries that are broken: one of them is no reason to lose the others."""
        if isinstance(raw, list):
            return [entry for entry in raw if self._is_sound(name, [entry])]
        if isinstance(raw, dict):
            return {key: entry for key, entry in raw.items() if self._is_sound(name, {key: entry})}
        return raw

    def _is_sound(self, name: str, raw: Any) -> bool:
        try:
            _check_value(name, raw)
        except FAULTS as fault:
            self._report(
                translate(
                    "{file}: an entry of '{name}' is left out ({fault})",
                    file=self.file,
                    name=name,
                    fault=_lower_first(fault),
                )
            )
            return False
        return True

    def _set_aside(self, fault: Exception) -> None:
        aside = self.file.with_name("preferences.broken.json")
        with contextlib.suppress(OSError):
            self.file.replace(aside)
        self._report(
            translate(
                "{file}: the preferences are damaged ({fault}); they are set aside as {name}",
                file=self.file,
                fault=fault,
                name=aside.name,
            )
        )

    def _report(self, sentence: str) -> None:
        if sentence not in self.faults:
            self.faults.append(sentence)


def _check_value(name: str, value: Any) -> Any:
    """A value converted to the type of its field. Raises ValidationError or ValueError."""
    converted = convert_data(msgspec.to_builtins(value, enc_hook=dict), TYPES[name])
    return CHECKS[name](converted) if name in CHECKS else converted


def _merge_recent(first: tuple[Recent, ...], second: tuple[Recent, ...]) -> tuple[Recent, ...]:
    """Both lists merged, newest first, every path once."""
    newest: dict[str, Recent] = {}
    for recent in sorted((*first, *second), key=lambda recent: recent.time, reverse=True):
        newest.setdefault(recent.path, recent)
    return tuple(newest.values())[:MAX_RECENT]


def _list_differences(preferences: Preferences, before: Preferences) -> dict[str, Any]:
    """The fields of `preferences` that differ from another one."""
    return {name: getattr(preferences, name) for name in NAMES if getattr(preferences, name) != getattr(before, name)}


def _tree(preferences: Preferences) -> dict[str, Any]:
    """What is written: fields that differ from their default, and what was there that means nothing here."""
    changed = msgspec.to_builtins(_list_differences(preferences, Preferences()), enc_hook=dict)
    return {**preferences.extra, **cast("dict[str, Any]", changed)}


def _lower_first(fault: Exception) -> str:
    message = str(fault)
    return message[:1].lower() + message[1:]
