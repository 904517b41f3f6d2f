"""Reads from the header of a picture how it was made."""

from __future__ import annotations

import re
import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path, PurePath
from typing import Any, cast

from halation.nodes import Node
from msgspec import Struct

from ... import document, media
from ...errors import InputError
from ...graph import Graph
from ...graph.frames import parse_frames
from ...resources.library_names import restore_bytes
from ...resources.sandbox import Sandbox
from ..jobs.header import PREFIX
from ..jobs.picture_settings import RecordedSettings

_DIGEST = re.compile(r"(?P<name>.+) sha256:(?P<digest>[0-9a-f]{64})")
_LAYERED = re.compile(r"(?P<name>.*?\.\w{1,5}):(?P<layer>.+)")
_SUPPORTED_FORMATS = "EXR and PNG hold what is needed, and so do TIFF and JPEG"


class RecordedFile(Struct, frozen=True):
    """A file that was read, by the input or node that read it: see `SourceFile`.

    Of a sequence, `frames` of `pattern` were read; `sequence_digest` is the hash of all of them.
    """

    owner: str
    name: str
    digest: str
    layer: str = ""
    pattern: str = ""
    frames: tuple[int, ...] = ()
    sequence_digest: str = ""


class Recipe(Struct, frozen=True):
    """What a header says: the graph, the files that it read, and the settings."""

    path: Path
    graph: Graph
    version: str
    renderer: str
    driver: str
    files: tuple[RecordedFile, ...]
    settings: RecordedSettings
    color: str = ""
    """A hash of the color settings; "" for the default ones."""


def read_recipe(path: str | Path, catalogue: Mapping[str, type[Node]] | None = None, *, sandbox: Sandbox) -> Recipe:
    """Read the recipe of a picture. Relative paths in the graph start at the folder of the picture.

    `catalogue` are the node types by id, by default all that are installed.

    Raises:
        InputError: the file cannot be read, or its header holds no graph.
        DocumentError: this version cannot read the graph.
    """
    metadata = {
        name: str(item) for name, item in media.read_metadata(path, sandbox=sandbox).items() if name.startswith(PREFIX)
    }
    text = metadata.get("halation:graph")
    if not text:
        raise InputError(
            f"{path}: its header holds no graph: Halation did not write it, its format cannot hold one "
            f"({_SUPPORTED_FORMATS}), or another program saved it since"
        )
    graph = document.loads(text, f"{path}, halation:graph", str(Path(path).parent), catalogue, sandbox=sandbox)
    try:
        settings = _read_settings(metadata)
        files = _parse_files(metadata)
    except ValueError as fault:
        raise InputError(f"{path}: its header is damaged ({fault}): render the picture again") from None
    return Recipe(
        Path(path),
        graph,
        metadata.get("halation:version", ""),
        metadata.get("halation:renderer", ""),
        metadata.get("halation:driver", ""),
        files,
        settings,
        metadata.get("halation:color", ""),
    )


def has_recipe(path: str | Path, sandbox: Sandbox) -> bool:
    """True for a picture whose header holds the graph that made it. Raises InputError for no picture."""
    return bool(media.read_metadata(path, sandbox=sandbox).get("halation:graph"))


def _read_settings(metadata: Mapping[str, str]) -> RecordedSettings:
    """The settings in a header. Raises ValueError."""
    if "halation:job" in metadata:
        return RecordedSettings.from_json(metadata["halation:job"])
    return _parse_settings(metadata.get("halation:settings", ""))


def _parse_settings(text: str) -> RecordedSettings:
    """The settings of a header of an earlier version, which has them as `name=value` words. Raises ValueError."""
    words: dict[str, list[str]] = {}
    for word in shlex.split(text):
        name, _, value = word.partition("=")
        words.setdefault(name, []).append(value)
    settings: dict[str, Any] = {"outputs": tuple(words.pop("output", ()))}
    plain = {name: values[-1] for name, values in words.items()}
    for name in ("node", "view", "display", "look", "colorspace", "compression"):
        if name in plain:
            settings[name] = plain[name]
    for name, options in (
        ("precision", ("half", "float")),
        ("intermediates", ("half", "float")),
        ("form", ("fragment", "compute")),
    ):
        if plain.get(name) in options:
            settings[name] = plain[name]
    if "frame" in plain:
        settings["frame"] = int(plain["frame"])
    if "scale" in plain:
        settings["scale"] = float(plain["scale"])
    if "size" in plain:
        settings["size"] = _parse_pair(plain["size"], "x")
    if "frames" in plain:
        settings["frames"] = _parse_pair(plain["frames"], "..")
    return RecordedSettings(**settings)


def _parse_pair(text: str, between: str) -> tuple[int, int]:
    first, _, second = text.partition(between)
    return int(first), int(second)


def _parse_files(metadata: Mapping[str, str]) -> tuple[RecordedFile, ...]:
    """The files that a header names. Raises ValueError."""
    files: list[RecordedFile] = []
    for name, text in metadata.items():
        if not name.startswith("halation:input:"):
            continue
        owner = name.removeprefix("halation:input:")
        file, digest = _split_digest(text)
        layered = _LAYERED.fullmatch(file)
        file, layer = (layered["name"], layered["layer"]) if layered else (file, "")
        pattern, frames, sequence_digest = "", (), ""
        if sequence_text := metadata.get(f"halation:frames:{owner}"):
            rest, sequence_digest = _split_digest(sequence_text)
            pattern, _, listed = rest.rpartition(" ")
            frames = parse_frames(listed)
        files.append(
            RecordedFile(owner, PurePath(file).name, digest, layer, PurePath(pattern).name, frames, sequence_digest)
        )
    return tuple(sorted(files, key=lambda recorded: recorded.owner))


def _split_digest(text: str) -> tuple[str, str]:
    match = _DIGEST.fullmatch(text)
    if match is None:
        raise ValueError(f"'{text[:60]}' is no file and its hash")
    return restore_bytes(cast("Sequence[str]", match.groups())[0]), match["digest"]
