"""The table of drivers counts what differs, names what is missing, and measures light by what a screen shows of it.

Every night all pictures are drawn on every driver that the machine has.
"""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bench import driver_pictures
from bench.driver_list import DRIVERS, Driver, MissingDriverError, describe_environment
from bench.driver_pictures import (
    Pictures,
    draw_in_processes,
    draw_pictures,
    list_pictures,
    list_ports,
    read_pictures,
    replace_angles,
)
from bench.drivers import compare, describe_row, draw_driver, draw_reference, format_rows, measure_difference
from bench.explained_differences import CAUSES, find_unexplained
from bench.newer_mesa import UnavailableError, find_source
from placed_corners import place_all_corners

BLACK = np.zeros(4)


@pytest.mark.parametrize(
    ("found", "expected", "difference"),
    [
        ([0.5, 0.25], [0.5, 0.0], 0.25),
        ([99.0, 0.0], [100.0, 0.0], 0.01),
        ([np.inf, 1.0], [np.inf, 1.0], 0.0),
        ([np.nan, 1.0], [0.0, 1.0], np.inf),
        ([0.0], [0.0, 1.0], np.inf),
    ],
)
def test_differences_are_those_of_the_larger_of_one_and_the_light(
    found: list[float], expected: list[float], difference: float
) -> None:
    assert measure_difference(np.array(found), np.array(expected)) == pytest.approx(difference)


def test_what_differs_and_what_is_missing_is_named() -> None:
    expected: Pictures = {"device": "a", "node.x": BLACK, "node.y": BLACK, "node.z": BLACK, "preset.p": BLACK}
    found: Pictures = {"device": "b", "node.x": BLACK + 0.003, "node.y": "ShaderError: no", "preset.p": BLACK + 0.5}
    row = compare("zink", found, expected)
    assert (row.device, row.nodes, row.presets, row.differing) == ("b", 1, 1, {"preset.p": 0.5})
    assert row.failures == ("node.y: ShaderError: no", "node.z: not drawn")
    assert describe_row(row) == [*row.failures, "preset.p: 0.5"]
    assert format_rows([row]).splitlines()[-1] == "| zink: b | 1 | 1 | 1 | 0.5 preset.p |"


def test_pictures_are_drawn_or_say_why_not() -> None:
    drawn = dict(draw_pictures(("node.exposure", "node.none", "inside.soft_bloom.glow.out")))
    assert isinstance(drawn["node.exposure"], np.ndarray) and drawn["node.exposure"].size == 48 * 27 * 4
    assert drawn["node.none"] == "KeyError: 'none'"
    assert compare("same", drawn, drawn).largest == 0.0


def test_a_program_gets_functions_for_angles_after_its_extensions() -> None:
    text = "#version 430\n#extension GL_ARB_a : require\nvoid main() { float x = cos(1.0); }\n"
    lines = replace_angles(text).splitlines()
    assert lines[:2] == text.splitlines()[:2] and lines[-1] == "void main() { float x = exact_cos(1.0); }"
    assert any(line.startswith("float exact_cos(") for line in lines[2:-1])
    assert replace_angles("") == ""


def test_corners_of_triangles_are_where_they_are_asked_for() -> None:
    """Llvmpipe places them at 256ths of a pixel by itself; at whole pixels the picture is another one."""

    def draw(parts: int) -> Pictures:
        with place_all_corners(parts):
            return dict(draw_pictures(["node.scene"]))

    free = dict(draw_pictures(["node.scene"]))
    assert not compare("256", draw(256), free).differing
    assert compare("1", draw(1), free).largest > 0.1


def test_all_nodes_and_presets_are_pictures_and_a_preset_has_those_of_its_nodes() -> None:
    names = list_pictures()
    assert {"node.fxaa", "preset.turntable"} < set(names) and len(names) == len(set(names)) > 220
    inside = list_ports("turntable")
    assert {"inside.turntable.key.out", "inside.turntable.stage.normal"} < set(inside)
    assert "inside.turntable.stage.camera" not in inside


def end_at(name: str, words: Sequence[str], **_: Any) -> subprocess.CompletedProcess[str]:
    """A process that draws black pictures and is killed by one of them."""
    folder = Path(words[2])
    for drawn in words[3:]:
        (folder / "drawing").write_text(drawn)
        if drawn == name:
            return subprocess.CompletedProcess(words, -11, "", "")
        np.save(folder / f"{drawn}.npy", BLACK)
    (folder / "words.jsonl").write_text('["device", "a driver"]\n')
    return subprocess.CompletedProcess(words, 0, "", "")


def test_a_driver_that_ends_the_process_costs_one_picture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(driver_pictures.subprocess, "run", lambda words, **_: end_at("node.b", words))
    drawn = draw_in_processes(["node.a", "node.b", "node.c"], tmp_path, {})
    assert drawn["node.b"] == "the process ended: it ended with -11"
    assert isinstance(drawn["node.a"], np.ndarray) and isinstance(drawn["node.c"], np.ndarray)


def test_what_a_folder_keeps_is_not_drawn_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = draw_driver(DRIVERS[0], ["node.exposure", "node.none"], tmp_path)
    assert str(first["device"]).startswith("llvmpipe") and ", OpenGL 4" in str(first["device"])
    assert first["node.none"] == "KeyError: 'none'"
    monkeypatch.setattr(driver_pictures.subprocess, "run", None)
    again = draw_driver(DRIVERS[0], ["node.exposure", "node.none"], tmp_path)
    assert np.array_equal(again["node.exposure"], first["node.exposure"]) and again["node.none"] == first["node.none"]
    assert set(read_pictures(tmp_path / "llvmpipe-256")) == {"device", "node.exposure", "node.none"}


def test_a_driver_that_is_not_there_says_why(tmp_path: Path) -> None:
    newer = Driver("newer", "llvmpipe", newer=True)
    with pytest.raises(MissingDriverError, match="no newer Mesa is unpacked"):
        describe_environment(newer, tmp_path, tmp_path)
    library = tmp_path / "usr" / "lib" / "arm" / "libEGL_mesa.so.0"
    vendors = tmp_path / "usr" / "share" / "glvnd" / "egl_vendor.d"
    for folder in (library.parent, vendors):
        folder.mkdir(parents=True)
    library.touch()
    variables = describe_environment(newer, tmp_path, tmp_path)
    assert variables["LD_LIBRARY_PATH"].startswith(str(library.parent))
    assert variables["__EGL_VENDOR_LIBRARY_DIRS"] == str(vendors)
    with pytest.raises(MissingDriverError, match="there is no driver of Vulkan: lavapipe"):
        describe_environment(Driver("zink", "zink", vulkan="lavapipe", newer=True), tmp_path, tmp_path)
    with pytest.raises(MissingDriverError, match="cannot be opened"):
        draw_driver(Driver("none", "none", {"MESA_GL_VERSION_OVERRIDE": "3.3"}), ["node.exposure"], tmp_path)
    with pytest.raises(MissingDriverError, match="named other: llvmpipe"):
        draw_driver(Driver("other", "softpipe", {"GALLIUM_DRIVER": "llvmpipe"}), [], tmp_path)


def test_backports_come_from_where_the_system_comes_from() -> None:
    debian = "https://mirror.example/debian/|{0}|{1}|Debian"
    places = [("bookworm-updates", "main"), ("bookworm", "contrib"), ("bookworm", "main")]
    targets = ["https://mirror.example/other/|stable|main|Other", *(debian.format(*place) for place in places)]
    line = find_source("\n".join(targets)).split()
    assert (line[0], line[-3:]) == ("deb", ["https://mirror.example/debian/", "bookworm-backports", "main"])
    for other in ("", "https://mirror.example/ubuntu/|noble|main|Ubuntu", debian.format("sid", "main")):
        with pytest.raises(UnavailableError, match="stable Debian"):
            find_source(other)


def test_a_difference_is_explained_for_drivers_of_a_name_and_for_no_other() -> None:
    differing = {"node.oil": 1.0, "preset.soft_bloom": 0.1}
    assert find_unexplained("newer softpipe", differing) == {"preset.soft_bloom": 0.1}
    assert find_unexplained("OpenGL 4.1", differing) == differing
    assert frozenset[str]().union(*(cause.pictures for cause in CAUSES)) <= set(list_pictures())
    assert all(any(cause.word in driver.name for driver in DRIVERS) for cause in CAUSES)


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of this night's pictures: llvmpipe's are drawn once for all drivers."""
    return tmp_path_factory.mktemp("drivers")


@pytest.mark.nightly  # minutes for each driver
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("driver", DRIVERS[1:], ids=lambda driver: driver.name)
def test_another_driver_draws_the_same_pictures(driver: Driver, drawn: Path) -> None:
    """All nodes and presets. What differs has a known cause; `tests/bench/drivers.py` prints the table."""
    names = list_pictures()
    try:
        found = draw_driver(driver, names, drawn)
    except MissingDriverError as error:
        pytest.skip(str(error))
    row = compare(driver.name, found, draw_reference(driver, names, drawn))
    assert not row.failures
    assert not find_unexplained(driver.name, row.differing)
