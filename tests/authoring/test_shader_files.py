"""Shaders of this machine: what is found in folders, by whom it says it is."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from halation.authoring.background.shader_files import ShaderFile, ShaderFiles
from halation.editor.shared.entries import shader_entries


def put(path: Path, **head: object) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"/*{json.dumps({'ISFVSN': '2', **head})}*/\nvoid main() {{ gl_FragColor = vec4(1.0); }}")


@pytest.fixture
def files() -> Iterator[ShaderFiles]:
    made = ShaderFiles()
    yield made
    made.close()


def found(files: ShaderFiles, *folders: Path) -> tuple[ShaderFile, ...]:
    end = time.monotonic() + 120.0
    while (known := files.find(map(str, folders))) is None:
        assert time.monotonic() < end
        time.sleep(0.01)
    return known


def test_shaders_are_found_under_their_categories(files: ShaderFiles, tmp_path: Path) -> None:
    top = tmp_path / "isf"
    put(
        top / "Blur It.fs",
        CATEGORIES=["Blur", "Other"],
        DESCRIPTION="Blurs.\nA lot.",
        INPUTS=[
            {"NAME": "inputImage", "TYPE": "image"},
        ],
    )
    put(top / "Mine" / "bars.FS", INPUTS=[])
    (top / "broken.fs").write_text("void main() {}")
    (top / "binary.fs").write_bytes(b"\xff\xfe\x00")
    (top / "note.txt").write_text("no shader")
    got = found(files, top, tmp_path / "gone")
    assert [(one.path.name, one.category, one.has_image_input) for one in got] == [
        ("Blur It.fs", "Blur", True),
        ("bars.FS", "Mine", False),
    ]
    entry = shader_entries(got)[0]
    assert (entry.title, entry.category, entry.doc) == ("Blur It", "ISF blur", "Blurs.")


def test_no_folder_starts_no_thread(files: ShaderFiles, tmp_path: Path) -> None:
    assert all("ISF" not in str(one.path) or one.path.is_file() for one in found(files, tmp_path / "none"))
