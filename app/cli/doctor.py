"""`halation doctor`: looks at everything that Halation needs on this machine."""

from __future__ import annotations

import getpass
import os
import platform
import re
import shutil
import tempfile
from collections.abc import Collection, Iterator
from contextlib import suppress
from importlib import metadata
from pathlib import Path
from typing import Literal

import msgspec
from msgspec import Struct

from ..errors import HalationError
from ..resources.machine import available_cores, has_display, machine_memory, memory_limit
from ..resources.sandbox import read_process_sandbox
from ..resources.user_folders import list_preset_folders, state_folder
from ..version import VERSION
from .options import AsJson
from .outcome import print_json, write_count
from .plugins import list_refused_plugins

State = Literal["ok", "note", "fault"]
"""A note is worth knowing and stops nothing; a fault stops a part of Halation from working."""

_LITTLE_DISK = 1 << 30
"""Bytes. A shot of 100 frames in 4K takes a few times this."""

_LITTLE_MEMORY = 2 << 30
"""Bytes. The largest presets need about 1 GB in 4K, and pictures are decoded and encoded beside them."""
_USERS = ("home", "Users", "media")
"""Folders in which each user has one with their name."""

_EXTRAS = (
    ("video", "av", "videos cannot be read or written"),
    ("denoise", "pyoidn", "the node denoise cannot work"),
    ("cluster", "distributed", "frames cannot be rendered on other machines"),
    ("fit", "cma", "halation fit cannot work"),
    ("wgsl", "slangpy", "halation export --to wgsl, reshade and unity cannot work"),
)
"""Extras, a distribution of each, and what is lacking without it."""


class MachineCheck(Struct, frozen=True):
    """The state of one thing, in a sentence that says what to do where something is wrong."""

    topic: str
    state: State
    sentence: str


def doctor(as_json: AsJson = False) -> int:
    """Check what Halation needs on this machine.

    It looks at packages, OpenGL, memory, disk, folders, caches, fonts, color management and plug-ins, and says what to
    do where something is missing. Paste its output into reports of bugs: paths in your home folder are shortened. The
    exit code is 1 if something does not work.
    """
    checks = list(examine_machine())
    if as_json:
        print_json({"checks": [msgspec.to_builtins(check) for check in checks]})
    else:
        width = max(len(check.topic) for check in checks)
        for check in checks:
            print(f"{check.state:5}  {check.topic:{width}}  {check.sentence}")
    return 1 if any(check.state == "fault" for check in checks) else 0


def examine_machine() -> Iterator[MachineCheck]:
    """All checks, one after the other. No sentence names the user: reports of bugs are public."""
    homes = list_homes()
    for check in _examine_everything():
        yield msgspec.structs.replace(check, sentence=hide_users(check.sentence, homes))


def hide_users(sentence: str, homes: Collection[str]) -> str:
    """A sentence with ~ for these home folders, and ... for the names of users in other paths."""
    for home in sorted(homes, key=len, reverse=True):
        sentence = re.sub(rf"(?<![\w.-]){re.escape(home)}(?![\w.-])", "~", sentence)
    return re.sub(rf"([/\\](?:{'|'.join(_USERS)})[/\\])[^/\\\s]+", r"\1...", sentence)


def list_homes() -> set[str]:
    """The home folders of the user as paths may spell them: that of the environment, and that of the account.

    The two may differ, such as after `su` or in a job of a farm.
    """
    names = ["~"]
    with suppress(KeyError, OSError, ImportError):  # an account without an entry, as containers may have
        names.append(f"~{getpass.getuser()}")
    homes: set[Path] = set()
    for name in names:
        with suppress(RuntimeError):  # a user that the system does not know
            home = Path(name).expanduser()
            homes |= {home, home.resolve()}
    return {spelling for home in homes if home != home.parent for spelling in (str(home), home.as_posix())}


def _examine_everything() -> Iterator[MachineCheck]:
    """All checks, with names of users still in their sentences. What cannot be examined is a fault of its own."""
    yield MachineCheck(
        "halation", "ok", f"{VERSION}, Python {platform.python_version()}, {platform.platform(terse=True)}"
    )
    yield from _examine_packages()
    yield _examine_opengl()
    yield _examine_display()
    yield _examine_memory()
    yield from _examine_folders()
    yield _examine_shader_cache()
    yield _examine_fonts()
    yield _examine_color()
    yield from _examine_plugins()


def _examine_packages() -> Iterator[MachineCheck]:
    """The packages that Halation declares: their versions, or which are missing."""
    try:
        requirements = metadata.requires("halation") or []
    except metadata.PackageNotFoundError:
        yield MachineCheck(
            "packages", "note", "Halation runs from its source folder: ./dev test installs what it needs"
        )
        return
    needed = [match[0] for text in requirements if ";" not in text and (match := re.match(r"[\w.-]+", text))]
    versions: list[str] = []
    for name in needed:
        try:
            versions.append(f"{name} {metadata.version(name)}")
        except metadata.PackageNotFoundError:
            yield MachineCheck("packages", "fault", f"{name} is missing: run pip install --upgrade halation")
    yield MachineCheck("packages", "ok", ", ".join(versions))
    for name, distribution, lack in _EXTRAS:
        try:
            yield MachineCheck(name, "ok", f"{distribution} {metadata.version(distribution)}")
        except metadata.PackageNotFoundError:
            yield MachineCheck(name, "note", f"{lack}: run pip install 'halation[{name}]'")


def _examine_opengl() -> MachineCheck:
    """The device that renders, tried for real."""
    from ..renderer import open_device

    try:
        return MachineCheck("opengl", "ok", open_device(sandbox=read_process_sandbox()).description)
    except HalationError as fault:
        return MachineCheck("opengl", "fault", str(fault))


def _examine_display() -> MachineCheck:
    """Whether a window can be opened: only the editor needs one."""
    if has_display():
        return MachineCheck("display", "ok", "the editor can open a window")
    return MachineCheck(
        "display", "note", "there is no display (DISPLAY is not set): rendering works, the editor does not"
    )


def _examine_memory() -> MachineCheck:
    memory = min(memory_limit(), machine_memory())
    sentence = f"{memory / 2**30:.1f} GiB for {available_cores()} cores"
    if memory < _LITTLE_MEMORY:
        return MachineCheck("memory", "note", f"{sentence}: large pictures need more; --memory renders them in tiles")
    return MachineCheck("memory", "ok", sentence)


def _examine_folders() -> Iterator[MachineCheck]:
    """Folders that are written to, with the space on their disks, and folders of presets."""
    from ..renderer.calibration import timings_folder

    places = {
        "temporary files": Path(tempfile.gettempdir()),
        "preferences": state_folder(),
        "measured times": timings_folder(),
    }
    for topic, folder in places.items():
        yield _examine_folder(topic, folder)
    own, *shared = list_preset_folders()
    yield _examine_folder("own presets", own)
    for folder in shared:
        if not folder.is_dir():
            yield MachineCheck("shared presets", "note", f"{folder.as_posix()} does not exist: see HALATION_PATH")


def _examine_folder(topic: str, folder: Path) -> MachineCheck:
    nearest = next(parent for parent in (folder, *folder.parents) if parent.exists())
    name = folder.as_posix()
    if not nearest.is_dir() or not os.access(nearest, os.W_OK):
        return MachineCheck(topic, "fault", f"{name} cannot be written: change its permissions")
    free = shutil.disk_usage(nearest).free
    sentence = f"{name}, {free / 2**30:.1f} GiB free"
    if free < _LITTLE_DISK:
        return MachineCheck(topic, "note", f"{sentence}: make room before long renders")
    return MachineCheck(topic, "ok", sentence)


def _examine_shader_cache() -> MachineCheck:
    """Where Mesa keeps compiled shaders; other drivers have folders of their own and need no help."""
    from ..renderer.opengl.shader_cache import DISABLING, find_base_folder

    if folder := find_base_folder():
        return _examine_folder("shader cache", folder)
    if any(name in os.environ for name in DISABLING):
        sentence = f"each start compiles all shaders again: unset {' and '.join(DISABLING)}"
        return MachineCheck("shader cache", "note", sentence)
    return MachineCheck("shader cache", "ok", "that of the driver")


def _examine_fonts() -> MachineCheck:
    """The font that comes with Halation, and those that are installed."""
    from halation.nodes import Typeface

    from ..media.lettering.fonts import list_installed_families, load_font

    try:
        font = load_font(Typeface(), read_process_sandbox())
    except (HalationError, OSError) as fault:
        return MachineCheck("fonts", "fault", f"{fault}: install Halation again")
    families = list_installed_families()
    return MachineCheck(
        "fonts", "ok", f"{font.name}, and {write_count(len(families), 'family', 'families')} of this system"
    )


def _examine_color() -> MachineCheck:
    """The OpenColorIO config: that of $OCIO, or the built-in one."""
    from ..color.management import get_default_color_manager

    config = os.environ.get("OCIO", "")
    try:
        manager = get_default_color_manager()
        spaces = len(manager.config.getColorSpaceNames())
    except HalationError as fault:
        return MachineCheck("color", "fault", f"{fault}; correct or unset OCIO")
    name = Path(config).as_posix() if config else "the built-in config"
    return MachineCheck("color", "ok", f"{name}, {spaces} color spaces")


def _examine_plugins() -> Iterator[MachineCheck]:
    from halation.nodes import plugins

    refused_plugins = list_refused_plugins()
    for refused in refused_plugins:
        sentence = f"{refused['package']} {refused['version']} cannot be loaded: {refused['fault']}"
        yield MachineCheck("plug-ins", "fault", sentence)
    loaded = [f"{plugin.package} {plugin.version}" for plugin in plugins() if not plugin.fault]
    if loaded or not refused_plugins:
        yield MachineCheck("plug-ins", "ok", ", ".join(loaded) or "none")
