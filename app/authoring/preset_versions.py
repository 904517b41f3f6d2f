"""Earlier versions of the user's own presets, in `versions/<name>` beside the preset.

A version is a copy of the file and of its picture, with the number of the save as its name. Going back copies it to
the place of the preset, where the files that it names are found as before; what was there becomes a version itself,
so nothing is ever lost.
"""

from __future__ import annotations

from pathlib import Path

from halation.presets import picture
from msgspec import Struct

from ..errors import InputError, OutputError
from ..language.translation import translate
from ..resources.atomic_write import write_bytes_atomically
from ..resources.sandbox import Sandbox


class PresetVersion(Struct, frozen=True):
    """An earlier version of a preset. `kept_at` is when another one took its place, in seconds since 1970."""

    number: int
    path: Path
    kept_at: float


def list_versions(preset: Path) -> tuple[PresetVersion, ...]:
    """The earlier versions of a preset, newest first."""
    files = [path for path in _find_folder(preset).glob("*.json") if path.stem.isdecimal()]
    versions = (PresetVersion(int(path.stem), path, path.stat().st_mtime) for path in files)
    return tuple(sorted(versions, key=lambda version: -version.number))


def keep_version(preset: Path, sandbox: Sandbox) -> PresetVersion:
    """Keep what a preset is now as its newest version. Raises OutputError if it cannot be written."""
    versions = list_versions(preset)
    number = versions[0].number + 1 if versions else 1
    path = _find_folder(preset) / f"{number}.json"
    try:
        picture(path).parent.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        raise OutputError(
            translate(
                "{parent}: the folder cannot be made ({reason}): free the name",
                parent=path.parent,
                reason=fault.strerror,
            )
        ) from None
    _copy(preset, path, sandbox)
    return PresetVersion(number, path, path.stat().st_mtime)


def restore_version(preset: Path, version: PresetVersion, sandbox: Sandbox) -> None:
    """Go back to a version of a preset; what it is now becomes a version."""
    keep_version(preset, sandbox)
    _copy(version.path, preset, sandbox)


def _find_folder(preset: Path) -> Path:
    return preset.parent / "versions" / preset.stem


def _copy(source: Path, target: Path, sandbox: Sandbox) -> None:
    """Copy a preset with its picture."""
    for start, end in ((source, target), (picture(source), picture(target))):
        try:
            content = start.read_bytes()
        except FileNotFoundError:  # a preset may have no picture
            end.unlink(missing_ok=True)
        except OSError as fault:
            raise InputError(
                translate(
                    "{start}: the file cannot be read ({reason}): check its rights", start=start, reason=fault.strerror
                )
            ) from None
        else:
            write_bytes_atomically(end, content, sandbox)
