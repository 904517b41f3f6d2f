"""Tables and configs that OpenColorIO would read for ever are refused before it gets them."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from random import Random

import numpy as np
import pytest
from halation.color.config_files import MAX_NAMES, check_table, may_name_files
from halation.color.lut_files import apply_table_file
from halation.color.management import get_color_manager
from halation.errors import GraphError, InputError
from halation.nodes import ColorSettings
from halation.resources.sandbox import UNRESTRICTED, Sandbox

STEPS = "2\n0 1\n0 1\n" * 3
ROWS = "2 2 2\n" + "".join(f"{r} {g} {b}\n" for b in (0, 1) for g in (0, 1) for r in (0, 1))
HEAD = "CSPLUTV100\n3D\n\n"
CONFIG = """ocio_profile_version: 2
search_path: .
roles: {{default: a{roles}}}
displays: {{d: [!<View> {{name: v, colorspace: a}}{views}]}}
colorspaces:
  - !<ColorSpace>
    name: a
    aliases: [x{aliases}]
    from_scene_reference: {transform}
{spaces}"""
PLAIN = {
    "roles": "",
    "views": "",
    "aliases": "",
    "spaces": "",
    "transform": "!<MatrixTransform> {offset: [0, 0, 0, 0]}",
}


@pytest.mark.parametrize(
    "text",
    [
        HEAD + "BEGIN METADATA",
        HEAD + "begin metadata\nnothing\n" + STEPS + ROWS,
        "\n\n csplutv100\r\n1D\r\nBEGIN METADATA\r\nEND METADATA nearly\r\n",
    ],
)
@pytest.mark.parametrize("ending", ["csp", "cube"])  # OpenColorIO tries every format, whatever the ending says
def test_metadata_without_an_end(tmp_path: Path, text: str, ending: str) -> None:
    table = tmp_path / f"a.{ending}"
    table.write_bytes(text.encode())
    with pytest.raises(InputError, match=rf"a\.{ending}: has metadata without an end"):
        apply_table_file(table, np.zeros((1, 3), np.float32), UNRESTRICTED)


@pytest.mark.parametrize(
    "metadata", ["", "BEGIN METADATA\nhouse\nEND METADATA\n", "BEGIN METADATA\r\nEND METADATA\r\n"]
)
def test_tables_with_an_end_are_read(tmp_path: Path, metadata: str) -> None:
    (tmp_path / "a.csp").write_bytes((HEAD + metadata + "\n" + STEPS + "\n" + ROWS).encode())
    colors = np.array([(0.25, 0.5, 0.75)], np.float32)
    np.testing.assert_allclose(apply_table_file(tmp_path / "a.csp", colors, UNRESTRICTED), colors, atol=1e-6)


def open_config(path: Path) -> int:
    """How many color spaces a config has, once a conversion was made."""
    manager = get_color_manager(ColorSettings(str(path)), UNRESTRICTED)
    manager.make_processor(manager.find("a"), manager.find("a"))
    return len(manager.config.getColorSpaceNames())


def write_config(**parts: str) -> str:
    return CONFIG.format(**{**PLAIN, **parts})


@pytest.mark.parametrize(
    "parts",
    [
        {"spaces": "".join(f"  - !<ColorSpace> {{name: s{n}}}\n" for n in range(MAX_NAMES))},
        {"views": "".join(f", !<View> {{name: v{n}, colorspace: a}}" for n in range(MAX_NAMES))},
        {"aliases": "".join(f", x{n}" for n in range(MAX_NAMES + 1))},
        {"roles": "".join(f", role_{n}: a" + " " * 990 for n in range(MAX_NAMES))},
    ],
    ids=["spaces", "views", "aliases", "letters"],
)
def test_configs_with_too_many_names(tmp_path: Path, parts: dict[str, str]) -> None:
    (tmp_path / "a.ocio").write_text(write_config(**parts), "utf-8")
    with pytest.raises(GraphError, match=r"a\.ocio: has more than 2,000 color spaces"):
        open_config(tmp_path / "a.ocio")


def test_a_large_config_is_read(tmp_path: Path) -> None:
    spaces = "".join(f"  - !<ColorSpace> {{name: s{n}}}\n" for n in range(500))
    (tmp_path / "a.ocio").write_text(write_config(spaces=spaces), "utf-8")
    assert open_config(tmp_path / "a.ocio") == 501


def test_archives_are_looked_into(tmp_path: Path) -> None:
    table = "!<FileTransform> {src: a.csp}"
    for name, text in (("good", HEAD + STEPS + "\n" + ROWS), ("bad", HEAD + "BEGIN METADATA")):
        with zipfile.ZipFile(tmp_path / f"{name}.ocioz", "w") as archive:
            archive.writestr("config.ocio", write_config(transform=table))
            archive.writestr("a.csp", text)
    assert open_config(tmp_path / "good.ocioz") == 1
    with pytest.raises(GraphError, match=r"bad\.ocioz: its table a\.csp has metadata without an end"):
        open_config(tmp_path / "bad.ocioz")


@pytest.mark.parametrize("method", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_damaged_archives(tmp_path: Path, method: int) -> None:
    """Each kind of compression has exceptions of its own."""
    with zipfile.ZipFile(tmp_path / "whole.ocioz", "w", method) as archive:
        archive.writestr("config.ocio", write_config())
        archive.writestr("a.csp", HEAD + STEPS + "\n" + ROWS)
    whole, rng, refused = (tmp_path / "whole.ocioz").read_bytes(), Random(method), 0
    for number in range(60):
        damaged = bytearray(whole)
        damaged[rng.randrange(len(damaged))] ^= rng.randrange(1, 256)
        path = tmp_path / f"{number}.ocioz"
        path.write_bytes(damaged)
        try:
            open_config(path)
        except GraphError as fault:
            refused += 1
            assert path.name in str(fault)
    assert refused > 20


def test_a_config_does_not_lead_to_an_endless_table(tmp_path: Path) -> None:
    (tmp_path / "a.csp").write_text(HEAD + "BEGIN METADATA", "utf-8")
    (tmp_path / "b.ocio").write_text(
        write_config(transform="!<FileTransform> {src: a.csp}", spaces="  - !<ColorSpace> {name: b}\n"), "utf-8"
    )
    manager = get_color_manager(ColorSettings(str(tmp_path / "b.ocio")), UNRESTRICTED)
    with pytest.raises(Exception, match=r"a\.csp"):
        manager.make_processor(manager.find("b"), manager.find("a"))


@pytest.mark.parametrize("read", [check_table, may_name_files])
def test_what_the_system_cannot_read_is_one_sentence(tmp_path: Path, read: Callable[[str, Sandbox], object]) -> None:
    with pytest.raises(InputError, match=f"^{re.escape(str(tmp_path))}: cannot be read: "):
        read(str(tmp_path), UNRESTRICTED)
