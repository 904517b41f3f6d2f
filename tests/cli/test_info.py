"""info: the same facts for people, in columns, and for machines."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from exr_files import write_exr

ROOT = Path(__file__).parents[2]
NEON = ROOT / "presets/samples/neon.exr"
CROP = ROOT / "tests/data/blender45_multilayer.exr"


def section(out: str, title: str) -> list[str]:
    """The rows under a heading."""
    return out.split(f"\n\n{title}\n")[1].split("\n\n")[0].splitlines()


def test_a_render_is_told_in_full(cli):
    result = cli("info", NEON)
    assert (result.code, result.err) == (0, "")
    head = result.out.splitlines()[:3]
    assert head == [
        str(NEON),
        "  480 x 270, openexr, 12 parts, 12 layers",
        "  made by Blender: Software is 'Blender 5.0.1'",
    ]
    sections = re.findall(r"^(\w[\w ]+)$", result.out, re.M)
    assert sections == ["parts", "layers", "color", "conventions", "camera", "metadata"]
    assert len(section(result.out, "parts")) == len(section(result.out, "layers")) == 12
    assert section(result.out, "parts")[4].split() == [
        "4",
        "ViewLayer.Vector",
        *"XYZW",
        "float",
        "piz",
        "scan",
        "lines",
        "data",
    ]
    rows = section(result.out, "layers")
    assert "  Diffuse Color   RGB   half   albedo              Blender's name for albedo" in rows
    assert len({match.end() for row in rows for match in re.finditer(r" (half|float) +", row)}) == 1
    rules = section(result.out, "conventions")
    assert [row.split()[:3] for row in rules[:3]] == [
        ["depth", "planar", "measured"],
        ["normal", "world", "measured"],
        ["position", "world", "measured"],
    ]
    camera = dict(re.split(r"\s{2,}", row.strip(), maxsplit=1) for row in section(result.out, "camera"))
    assert camera["eye"] == "-0.23478, -8.5043, 2.2043" and camera["field of view"] == "50.69 x 29.84 degrees"
    assert camera["found"] == "solved from the positions" and "px" in camera["residual"]
    assert any(row.split() == ["Frame", "012"] for row in section(result.out, "metadata"))
    assert all(line == line.rstrip() for line in result.out.splitlines())


@pytest.mark.parametrize("path", [NEON, CROP], ids=["5.0", "4.5"])
def test_a_render_for_machines(cli, path):
    said = cli("info", path, "--json")
    found = json.loads(said.out, parse_constant=lambda word: pytest.fail(f"{word} is not JSON"))
    assert said.code == 0 and said.err == ""
    assert set(found) == {
        "file",
        "format",
        "size",
        "pixel_aspect",
        "renderer",
        "renderer_reason",
        "parts",
        "layers",
        "color_spaces",
        "roles",
        "undecided",
        "conventions",
        "camera",
        "metadata",
    }
    assert found["renderer"] == "Blender" and found["roles"]["depth"] == "Depth" and found["undecided"] == {}
    assert {layer["role"] for layer in found["layers"]} >= {"beauty", "albedo", "object_id", "cryptomatte_object"}
    assert found["conventions"]["velocity"]["scale"] == [-1.0, 1.0, -1.0, 1.0]
    assert len(found["camera"]["rows"]) == 12 and found["camera"]["residual_px"] < 1e-3
    names = [name for part in found["parts"] for name in part["channels"]]
    assert len(names) == 38 and found["metadata"]["Frame"] == "012"


def test_what_is_open_is_listed(cli, tmp_path):
    picture, vector = np.zeros((3, 4, 4), np.float32), np.zeros((3, 4, 3), np.float32)
    layers = {"beauty": picture, "diffuse": picture, "foo": vector, "worldNormals": vector, "normalsCS": vector}
    path = write_exr(tmp_path / "x.exr", layers, dict.fromkeys(layers, "float"))
    result = cli("info", path)
    assert "made by an unknown program: neither its header nor its layers say who made it" in result.out
    assert [re.split(r"\s{2,}", row.strip()) for row in section(result.out, "to be decided")] == [
        ["diffuse", "may be diffuse or albedo"],
        ["foo", "may be normal, position or velocity"],
        ["normal", "may be worldNormals or normalsCS"],
    ]
    assert section(result.out, "camera") == ["  none  no positions to solve it from, and the header names none"]
    found = cli("info", path, "--json").json
    assert found["undecided"] == {"normal": ["worldNormals", "normalsCS"]} and found["roles"]["normal"] is None
    assert {layer["name"]: layer["candidates"] for layer in found["layers"]}["diffuse"] == ["diffuse", "albedo"]


def test_windows_and_odd_values(cli, tmp_path):
    path = tmp_path / "x.exr"
    spec = oiio.ImageSpec(4, 3, 1, "half")
    spec.channelnames = ("Z",)
    spec.x, spec.y, spec.full_width, spec.full_height = 2, -1, 10, 8
    spec.attribute("gain", float("inf"))
    spec.attribute("notes", "two\nlines " + "and much more " * 20)
    file = oiio.ImageOutput.create(str(path))
    assert file.open(str(path), spec) and file.write_image(np.ones((3, 4, 1), np.float32)) and file.close()
    result = cli("info", path)
    assert "  10 x 8, openexr, 1 part, 1 layer\n" in result.out
    assert "data 4x3+2-1 of 10x8+0+0" in section(result.out, "parts")[0]
    notes = next(row for row in section(result.out, "metadata") if row.startswith("  notes"))
    assert "two lines and much" in notes and notes.endswith("...") and len(notes) < 120
    found = json.loads(cli("info", path, "--json").out, parse_constant=lambda word: pytest.fail(word))
    assert found["metadata"]["gain"] == "inf" and found["parts"][0]["data_window"] == [2, -1, 4, 3]
    assert found["camera"] == {"reason": "no positions to solve it from, and the header names none"}


def test_the_frame_before(cli, fails, tmp_path):
    assert fails(4, "info", NEON, "--before", CROP).endswith("is 480x270: name the frame before")
    assert "no such file" in fails(4, "info", NEON, "--before", tmp_path / "no.exr")


@pytest.fixture
def frames(tmp_path: Path) -> Path:
    """Frames 1, 2, 3 and 5 of a picture, as large as their number."""
    for frame in (1, 2, 3, 5):
        write_exr(tmp_path / f"shot.{frame:04d}.exr", {"rgba": np.zeros((3, frame, 4), np.float32)}, {"rgba": "half"})
    return tmp_path


@pytest.mark.parametrize("name", ["shot.####.exr", "shot.%04d.exr", "shot.$F4.exr", ""])
def test_a_sequence_is_told_first_and_then_its_first_frame(cli, frames, name):
    result = cli("info", frames / name)
    shown = frames / (name or "shot.####.exr")
    assert (result.code, result.err) == (0, "")
    assert result.out.splitlines()[:5] == [
        str(shown),
        "  4 frames: 1-3,5",
        "  1 missing: 4",
        "",
        str(frames / "shot.0001.exr"),
    ]
    first = cli("info", frames / "shot.0001.exr").out
    said = f"\n  one of 4 frames of {frames / 'shot.####.exr'}: 1-3,5"
    assert said in first and result.out.split("\n\n", 1)[1] == first.replace(said, "")


def test_a_sequence_for_machines(cli, frames):
    found = cli("info", frames / "shot.####.exr", "--json").json
    alone = cli("info", frames / "shot.0001.exr", "--json").json
    assert found.pop("sequence") == {
        "pattern": str(frames / "shot.####.exr"),
        "count": 4,
        "first": 1,
        "last": 5,
        "frames": [1, 2, 3, 5],
        "gaps": [[4, 4]],
        "missing": 1,
    }
    assert found == alone


def test_a_sequence_without_frames(fails, frames):
    assert fails(4, "info", frames / "shto.####.exr").endswith("no file has such a name; did you mean 'shot.####.exr'?")
    assert "more than 16 digits" in fails(2, "info", frames / "shot.%099d.exr")


def test_one_frame_and_no_gap(cli, frames):
    (frames / "only.7.exr").write_bytes((frames / "shot.0001.exr").read_bytes())
    result = cli("info", frames / "only.#.exr")
    assert result.out.splitlines()[:3] == [str(frames / "only.#.exr"), "  1 frame: 7", ""]
    assert "one of" not in cli("info", frames / "only.7.exr").out


def test_faults_are_one_sentence(fails, tmp_path):
    cut, text, empty = tmp_path / "cut.exr", tmp_path / "text.exr", tmp_path / "empty.exr"
    cut.write_bytes(CROP.read_bytes()[:60000])
    text.write_text("no picture")
    empty.touch()
    assert fails(4, "info", cut) == f"{cut}: is cut short or damaged: copy or render it again"
    assert "is not an EXR file" in fails(4, "info", text)
    assert "is empty" in fails(4, "info", empty)
    assert "is a folder" in fails(4, "info", tmp_path)
    assert "no such file" in fails(4, "info", tmp_path / "gone.exr")
    assert "missing argument" in fails(2, "info").lower()
