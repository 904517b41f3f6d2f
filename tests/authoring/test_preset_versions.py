"""Versions of the user's own presets."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from halation.authoring.library import save_preset
from halation.authoring.preset_versions import keep_version, list_versions, restore_version
from halation.document import load
from halation.document.about import About, find_about
from halation.graph import Graph
from halation.nodes import catalogue
from halation.presets import picture
from halation.resources.sandbox import UNRESTRICTED


def save(path: Path, doc: str, level: int | None) -> None:
    graph = Graph().add("read", catalogue()["read_image"](path=str(path.parent / "shot.exr")))
    pixels = None if level is None else np.full((9, 16, 3), level, np.uint8)
    save_preset(graph, About(doc), path, pixels, UNRESTRICTED)


def describe(path: Path) -> str:
    return find_about(load(path, sandbox=UNRESTRICTED)).doc


def test_a_preset_goes_back_to_any_of_its_versions_and_loses_none(tmp_path: Path) -> None:
    path = tmp_path / "glow.json"
    save(path, "first", 10)
    first = path.read_bytes(), picture(path).read_bytes()
    assert list_versions(path) == ()
    for doc, level in (("second", None), ("third", 200)):
        keep_version(path, UNRESTRICTED)
        save(path, doc, level)
    assert [(version.number, describe(version.path)) for version in list_versions(path)] == [
        (2, "second"),
        (1, "first"),
    ]
    oldest = list_versions(path)[-1]
    restore_version(path, oldest, UNRESTRICTED)
    assert (path.read_bytes(), picture(path).read_bytes()) == first
    assert [describe(version.path) for version in list_versions(path)] == ["third", "second", "first"]
    restore_version(path, list_versions(path)[1], UNRESTRICTED)
    assert describe(path) == "second" and not picture(path).exists(), "the second version had no picture"
    read = load(path, sandbox=UNRESTRICTED).nodes["read"]
    assert Path(tmp_path, read.path).resolve() == (tmp_path / "shot.exr").resolve()  # type: ignore[union-attr]


def test_versions_are_no_presets_and_those_of_another_preset_are_not_listed(tmp_path: Path) -> None:
    save(tmp_path / "glow.json", "glow", 10)
    save(tmp_path / "fog.json", "fog", 10)
    keep_version(tmp_path / "glow.json", UNRESTRICTED)
    assert list_versions(tmp_path / "fog.json") == ()
    assert sorted(path.stem for path in tmp_path.glob("*.json")) == ["fog", "glow"]
