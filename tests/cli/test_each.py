"""`halation render --each`: one graph for many files."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from exr_files import header, read, write_exr
from halation.errors import UsageError
from halation.renderer.jobs.pipeline import FramePipeline


@pytest.fixture
def graphs(graphs):
    """As everywhere, but by default the light passes through unchanged."""
    return lambda name="graph.json", **parts: graphs(name, **{"nodes": {"light": {"type": "exposure"}}, **parts})


def flat(path: Path, number: float) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    return write_exr(path, {"Combined": np.full((8, 12, 4), number, np.float32)}, {"Combined": "float"})


@pytest.fixture
def photos(tmp_path, monkeypatch) -> Path:
    """in/a.exr, in/b.exr and in/deep/c.exr: 1, 2 and 3 everywhere. Names are relative to the current folder."""
    monkeypatch.chdir(tmp_path)
    for number, name in enumerate(("a", "b", "deep/c"), 1):
        flat(tmp_path / "in" / f"{name}.exr", float(number))
    return tmp_path


def lines(result) -> list[dict]:
    return [json.loads(line) for line in result.out.splitlines()]


def level(path: Path) -> float:
    return float(read(path)[3, 4, 0])


def each(cli, graph: Path, *words: object):
    return cli("render", graph, *words, "--precision=float", "--json")


def feed(monkeypatch, *texts: object) -> None:
    content = "\n".join(text if isinstance(text, str) else json.dumps(text) for text in texts).encode()
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(content), encoding="utf-8"))


def test_a_pattern_keeps_its_folders(cli, graphs, photos):
    result = each(cli, graphs(), "--each", "in/**/*.exr", "-i", "beauty={}", "-o", "out/{parent}/{index:02}_{name}")
    assert result.code == 0, result.err
    *entries, total = lines(result)
    assert [entry["file"] for entry in entries] == ["in/a.exr", "in/b.exr", "in/deep/c.exr"]
    assert (total["files"], total["failed"], total["kept"]) == (3, 0, 0)
    written = {str(path.relative_to(photos)): level(path) for path in photos.glob("out/**/*.exr")}
    assert written == {"out/in/01_a.exr": 1.0, "out/in/02_b.exr": 2.0, "out/in/deep/03_c.exr": 3.0}


def test_files_are_those_of_single_commands_to_the_byte(cli, graphs, photos):
    """Also where one item shares results with the next."""
    graph = graphs()
    for ending in ("exr", "png", "jpg", "tif"):
        assert each(cli, graph, "--each", "in/**/*.exr", "-i", "beauty={}", "-o", f"many/{{stem}}.{ending}").code == 0
        for path in photos.glob("in/**/*.exr"):
            single = photos / f"{path.stem}.{ending}"
            file = path.relative_to(photos)
            assert cli("render", graph, "-i", f"beauty={file}", "-o", single, "--precision=float").code == 0
            assert single.read_bytes() == (photos / "many" / single.name).read_bytes()


def test_the_only_input_needs_no_name(cli, graphs, photos):
    assert each(cli, graphs(), "--each", "in/b.exr", "-o", "{stem}.exr").code == 0
    assert level(photos / "b.exr") == 2.0


def test_values_and_other_inputs_may_depend_on_the_file(cli, graphs, photos):
    words = ("-i", "beauty={parent}/{stem}.exr", "--set", "light.stops={index}", "-o", "{stem}.exr")
    assert each(cli, graphs(), "--each", "in/a.exr", "--each", "in/b.exr", *words).code == 0
    assert (level(photos / "a.exr"), level(photos / "b.exr")) == (2.0, 8.0)


def test_a_list_names_files(cli, graphs, photos):
    (photos / "list.txt").write_text("in/b.exr\n\n  in/a.exr  \n")
    result = each(cli, graphs(), "--each", "@list.txt", "-o", "{index}.exr")
    assert [entry["file"] for entry in lines(result)[:-1]] == ["in/b.exr", "in/a.exr"]
    assert (level(photos / "1.exr"), level(photos / "2.exr")) == (2.0, 1.0)


def test_lines_of_json_have_their_own_options(cli, graphs, photos, monkeypatch):
    feed(
        monkeypatch,
        {"file": "in/a.exr", "set": {"light.stops": 2}},
        "",
        {"input": {"beauty": "in/b.exr"}, "output": "second.exr"},
        '"in/deep/c.exr"',
    )
    result = each(cli, graphs(), "--each", "-", "--set", "light.stops=1", "-o", "{stem}.exr")
    assert result.code == 0, result.err
    assert [entry["file"] for entry in lines(result)[:-1]] == ["in/a.exr", "line 2", "in/deep/c.exr"]
    assert [level(photos / f"{name}.exr") for name in ("a", "second", "c")] == [4.0, 4.0, 6.0]


@pytest.mark.parametrize("processes", [1, 2])
def test_a_file_that_fails_is_named_and_the_others_are_finished(cli, graphs, photos, processes):
    (photos / "in" / "aa.exr").write_bytes(b"no picture")
    whole = (photos / "in" / "b.exr").read_bytes()
    (photos / "in" / "bb.exr").write_bytes(whole[: len(whole) // 2])  # its header is read, its pixels are not
    result = each(cli, graphs(), "--each", "in/**/*.exr", "-o", "{stem}.exr", "-j", processes)
    assert result.code == 1
    *entries, total = lines(result)
    faults = {entry["file"]: entry["error"] for entry in entries if "error" in entry}
    assert set(faults) == {"in/aa.exr", "in/bb.exr"} and (total["files"], total["failed"]) == (5, 2)
    assert all(fault["kind"] == "InputError" and fault["exit_code"] == 4 for fault in faults.values())
    assert sorted(path.name for path in photos.glob("*.exr")) == ["a.exr", "b.exr", "c.exr", "shot.exr"]
    notes = result.err.strip().splitlines()
    assert len([note for note in notes if "in/aa.exr" in note]) == 1, notes
    assert not list(photos.glob(".halation-*"))


def test_a_value_that_fails_for_one_file_ends_no_other(cli, graphs, photos, monkeypatch):
    feed(monkeypatch, {"file": "in/a.exr", "set": {"light.stopps": 2}}, {"file": "in/b.exr"})
    (photos / "b.exr").unlink(missing_ok=True)
    result = each(cli, graphs(), "--each", "-", "-o", "{stem}.exr")
    # the values of the first file are checked before anything is rendered, as those of a single one are
    assert result.code == 2 and "light.stopps" in result.err
    feed(monkeypatch, {"file": "in/b.exr"}, {"file": "in/a.exr", "set": {"light.stopps": 2}})
    result = each(cli, graphs(), "--each", "-", "-o", "{stem}.exr")
    assert result.code == 1 and level(photos / "b.exr") == 2.0
    (fault,) = (entry["error"] for entry in lines(result) if "error" in entry)
    assert "light.stopps" in fault["message"] and fault["kind"] == "UsageError"


def test_resume_keeps_what_is_up_to_date(cli, graphs, photos):
    words = ("--each", "in/**/*.exr", "-o", "out/{stem}.exr", "--resume")
    assert [entry["kept"] for entry in lines(each(cli, graphs(), *words))[:-1]] == [False] * 3
    times = {path: path.stat().st_mtime_ns for path in photos.glob("out/*.exr")}
    flat(photos / "in" / "b.exr", 7.0)
    (photos / "out" / "c.exr").unlink()
    *entries, total = lines(each(cli, graphs(), *words))
    assert {entry["file"]: entry["kept"] for entry in entries} == {
        "in/a.exr": True,
        "in/b.exr": False,
        "in/deep/c.exr": False,
    }
    assert total["kept"] == 1 and level(photos / "out" / "b.exr") == 7.0
    assert (photos / "out" / "a.exr").stat().st_mtime_ns == times[photos / "out" / "a.exr"]


def test_each_file_may_be_a_sequence(cli, graphs, photos):
    for frame in (3, 4):
        flat(photos / "in" / f"take.{frame:04d}.exr", float(frame))
    result = each(cli, graphs(), "--each", "in/take.####.exr", "--each", "in/a.exr", "-o", "out/{stem}.####.exr")
    assert result.code == 0, result.err
    assert lines(result)[0]["frames"] == [3, 4]
    assert level(photos / "out" / "take.0004.exr") == 4.0 and header(photos / "out" / "take.0004.exr")["halation:job"]


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (("--each", "in/*.exr", "-o", "out.exr"), "in/a.exr and in/b.exr would be written to this one file"),
        (("--each", "in/*.exr", "-o", "in/{name}"), "this file is read for in/a.exr"),
        (("--each", "in/*.exr", "-o", "{steam}.exr"), "'{steam}' is not a place"),
        (("--each", "in/*.tif", "-o", "{stem}.exr"), "no file matches this pattern"),
        (("--each", "@none.txt", "-o", "{stem}.exr"), "--each @none.txt: the list cannot be read"),
        (("--each", "in/a.exr"), "has no output: write -o FILE"),
        ((), "missing option '-o' / '--output'"),
    ],
)
def test_what_is_refused_before_anything_is_rendered(cli, graphs, photos, words, reason):
    result = cli("render", graphs(), *words)
    assert result.code == 2 and reason in result.err and result.err.count("\n") == 1
    assert sorted(path.name for path in photos.glob("*.exr")) == ["shot.exr"]


@pytest.mark.parametrize("line", ["{", '{"fiel": "in/a.exr"}', "[1]", '{"input": 3}', '{"output": "{stem}.exr"}'])
def test_invalid_lines_are_named(cli, graphs, photos, monkeypatch, line):
    feed(monkeypatch, '"in/a.exr"', line)
    result = cli("render", graphs(), "--each", "-", "-o", "{index}.exr")
    assert result.code == 2 and "line 2" in result.err and result.err.count("\n") == 1


def test_nothing_outside_of_the_root_is_read_or_written(cli, graphs, photos):
    (photos / "fence").mkdir()
    flat(photos / "fence" / "d.exr", 4.0)
    words = ("--each", "in/a.exr", "--each", "fence/d.exr", "-i", "beauty={}", "--root", photos / "fence")
    graph = graphs("fence/graph.json", inputs={"beauty": {"type": "Image"}})
    result = each(cli, graph, *words, "-o", photos / "fence" / "new" / "{stem}.exr")
    assert result.code == 1 and "lies outside of" in lines(result)[0]["error"]["message"]
    assert [path.name for path in (photos / "fence" / "new").iterdir()] == ["d.exr"]
    result = cli("render", graph, "--each", "in/*.exr", *words[4:], "-o", photos / "fence" / "{stem}.exr")
    assert result.code == 2 and "--each in/*.exr: in: lies outside of" in result.err
    result = each(cli, graph, *words, "-o", photos / "elsewhere" / "{stem}.exr")
    assert result.code == 1 and not (photos / "elsewhere").exists()


def test_a_file_is_planned_when_its_turn_comes(cli, graphs, photos, monkeypatch):
    """So memory does not grow with the number of files: at most two are planned ahead of the one on the device."""
    for number in range(12):
        flat(photos / "many" / f"{number:02}.exr", number)
    ahead: list[int] = []
    render = FramePipeline._try_render
    counts = {"rendered": 0}

    def count_sessions(self, task, following):
        counts["rendered"] += 1
        ahead.append(len(self._sessions))
        return render(self, task, following)

    monkeypatch.setattr(FramePipeline, "_try_render", count_sessions)
    assert each(cli, graphs(), "--each", "many/*.exr", "-o", "out/{stem}.exr").code == 0
    assert counts["rendered"] == 12
    writers = 4
    assert max(ahead) <= 3 + writers + 2  # rendered and planned, written and waiting


def test_an_interrupt_leaves_finished_files_whole(graphs, photos):
    for number in range(200):
        os.link(photos / "in" / "a.exr", photos / "in" / f"x{number:03}.exr")
    words = ["render", str(graphs()), "--each", "in/*.exr", "-o", "out/{stem}.exr", "--progress=json"]
    with subprocess.Popen(
        [sys.executable, "-m", "halation.cli", *words], stderr=subprocess.PIPE, text=True, cwd=photos
    ) as process:
        assert process.stderr is not None
        for line in process.stderr:
            if line.startswith("{") and json.loads(line)["done"] == 5:
                process.terminate()
                break
        threading.Thread(target=process.stderr.read, daemon=True).start()
        assert process.wait(60) == 130
    files = list((photos / "out").iterdir())
    assert 5 <= len(files) < 200 and all(level(path) == 1.0 or path.name == "b.exr" for path in files)


def test_places_are_refused_where_a_line_has_no_file():
    from halation.renderer.jobs.entry_list import expand_entries
    from halation.resources.sandbox import UNRESTRICTED

    with pytest.raises(UsageError, match="line 1 of --each names no file"):
        expand_entries(["-"], {}, {}, [], lambda: '{"input": "a.exr", "output": "{stem}.png"}', UNRESTRICTED)


def test_the_picture_is_what_another_library_computes(cli, photos):
    """JPEG in, PNG out, through one exposure: compared with OpenImageIO's own decoding and the formula of sRGB."""
    rng = np.random.default_rng(3)
    for name in ("one", "two"):
        codes = rng.integers(0, 256, (16, 16, 3), dtype=np.uint8)
        image = oiio.ImageBuf(oiio.ImageSpec(16, 16, 3, "uint8"))
        image.set_pixels(oiio.ROI(0, 16, 0, 16, 0, 1, 0, 3), codes)
        image.write(str(photos / f"{name}.png"))
    graph = photos / "dim.json"
    nodes = {"dim": {"type": "exposure", "values": {"stops": -1.0}}}
    links = {"dim.image": "inputs.beauty", "outputs.image": "dim.out"}
    graph.write_text(
        json.dumps({"halation": 1, "inputs": {"beauty": {"type": "Image"}}, "outputs": {"image": {}}, "nodes": nodes,
                    "links": links})
    )  # fmt: skip
    words = ("--each", "one.png", "--each", "two.png", "-o", "dim/{stem}.png", "--dither=none", "--view=none")
    assert cli("render", graph, *words, "--precision=float").code == 0
    for name in ("one", "two"):
        codes = oiio.ImageBuf(str(photos / f"{name}.png")).get_pixels(oiio.FLOAT)
        light = np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4) / 2.0
        wanted = np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)
        written = oiio.ImageBuf(str(photos / "dim" / f"{name}.png")).get_pixels(oiio.FLOAT)[..., :3]
        assert np.abs(written - wanted).max() <= 0.51 / 255
