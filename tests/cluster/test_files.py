"""`halation render --each --cluster`: files on workers of Dask, which are processes of their own."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from exr_files import header, write_exr
from farms import Farm, customize

pytest.importorskip("distributed", reason="Dask is not installed")

PHOTOS = ("a", "b", "deep/c", "deep/d")

WORDS = ("--each", "photos/**/*.exr", "-i", "photo={}", "--deterministic", "--json")


@pytest.fixture
def looks(shot: Path) -> Path:
    """The folder of the shot with four photos, and a graph `look.json` for them, with a LUT and a group."""
    for number, name in enumerate(PHOTOS, 1):
        path = shot / "photos" / f"{name}.exr"
        path.parent.mkdir(parents=True, exist_ok=True)
        picture = np.random.default_rng(number).random((12, 16, 4), np.float32)
        write_exr(path, {"Combined": picture}, {"Combined": "half"})
    nodes = {
        "inner": {"type": "group", "path": "group.json"},
        "lut": {"type": "lut_file", "values": {"file": "look.cube"}},
        "blur": {"type": "gaussian_blur", "values": {"sigma": 1.5}},
    }
    links = {
        "inner.image": "inputs.photo",
        "lut.image": "inner.image",
        "blur.image": "lut.out",
        "outputs.image": "blur.out",
    }
    inputs, outputs = {"photo": {"type": "Image"}}, {"image": {"type": "Image"}}
    graph = {"halation": 1, "inputs": inputs, "outputs": outputs, "nodes": nodes, "links": links}
    (shot / "look.json").write_text(json.dumps(graph))
    return shot


def read_lines(text: str) -> list[dict]:
    return [json.loads(line) for line in text.splitlines()]


def read_files(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*.*")}


def test_files_are_those_of_one_process_to_the_byte(halation, looks, farm):
    here = halation("render", "look.json", *WORDS, "-o", "one/{parent}/{stem}.exr")
    there = halation("render", "look.json", *WORDS, "-o", "many/{parent}/{stem}.exr", "--cluster", farm.address)
    assert (here.code, there.code) == (0, 0), there.err
    assert read_files(looks / "many") == read_files(looks / "one") and len(read_files(looks / "one")) == 4
    *files, total = read_lines(there.out)
    local = {facts["file"]: facts for facts in read_lines(here.out)[:-1]}
    for facts in files:
        assert facts == {**local[facts["file"]], "written": [f"many/{Path(facts['file']).with_suffix('.exr')}"]}
    assert (total["files"], total["failed"], total["kept"], total["workers"]) == (4, 0, 0, 2)
    words = ("-o", "many/{parent}/{stem}.exr", "--cluster", farm.address, "--resume")
    again = read_lines(halation("render", "look.json", *WORDS, *words).out)
    assert again[-1]["kept"] == 4 and all(facts["kept"] for facts in again[:-1])


def test_values_of_one_file_reach_its_worker_and_its_header(halation, looks, farm):
    """The name of the table depends on the file: it goes by path, and the header of the picture has it."""
    for name in ("a", "b"):
        shutil.copy(looks / "look.cube", looks / f"{name}.cube")
    table = (looks / "b.cube").read_text()
    (looks / "b.cube").write_text(table.replace("0.9", "0.2"))
    words = ("--each", "photos/*.exr", "--set", "lut.file={stem}.cube", "--set", "blur.sigma={index}")
    words = ("look.json", *words, "-i", "photo={}", "--deterministic")
    here = halation("render", *words, "-o", "one/{stem}.exr")
    there = halation("render", *words, "-o", "many/{stem}.exr", "--cluster", farm.address)
    assert (here.code, there.code) == (0, 0), there.err
    assert read_files(looks / "many") == read_files(looks / "one")
    graph = json.loads(header(looks / "many" / "b.exr")["halation:graph"])
    assert graph["nodes"]["lut"]["values"]["file"] == "b.cube" and graph["nodes"]["blur"]["values"]["sigma"] == 2


def test_each_file_may_be_a_sequence(halation, looks, farm):
    words = ("look.json", "--each", "plates/p.####.exr", "--each", "photos/a.exr", "-i", "photo={}", "--deterministic")
    here = halation("render", *words, "-o", "one/{stem}.####.exr")
    there = halation("render", *words, "-o", "many/{stem}.####.exr", "--cluster", farm.address, "--json")
    assert (here.code, there.code) == (0, 0), there.err
    assert read_files(looks / "many") == read_files(looks / "one") and len(read_files(looks / "one")) == 9
    by_file = {facts.get("file"): facts for facts in read_lines(there.out)}
    assert by_file["plates/p.####.exr"]["frames"] == list(range(1, 9))
    assert by_file["plates/p.####.exr"]["written"] == [f"many/p.{frame:04d}.exr" for frame in range(1, 9)]


def test_a_file_that_fails_is_named_and_ends_no_other(halation, looks, farm):
    (looks / "photos" / "b.exr").write_bytes(b"no picture")
    words = ("look.json", *WORDS, "-o", "many/{stem}.exr", "--cluster", farm.address)
    ending = halation("render", *words, "--set", "blur.sigma={index}")
    assert ending.code == 1 and "photos/b.exr: is not an EXR file" in ending.err
    assert sorted(read_files(looks / "many")) == ["a.exr", "c.exr", "d.exr"]
    *files, total = read_lines(ending.out)
    assert (total["files"], total["failed"]) == (4, 1)
    facts = next(facts for facts in files if facts["file"] == "photos/b.exr")
    assert facts["error"]["kind"] == "InputError" and facts["written"] == []


def test_a_file_that_ends_its_process_is_tried_elsewhere_and_named(halation, looks, make_farm, tmp_path):
    """The worker dies at frame 5, which only the file `p` has."""
    farm: Farm = make_farm()
    crash = """
import os, sys
if "--chunks" in sys.orig_argv:
    from halation.renderer.jobs import item_session
    plan = item_session.ItemSession.plan_task
    def plan_task(self, frame):
        if frame == 5:
            os.kill(os.getpid(), 9)
        return plan(self, frame)
    item_session.ItemSession.plan_task = plan_task
"""
    variables = customize(tmp_path / "crash", crash)
    for _ in range(2):
        farm.start_worker(**variables)
    words = ("look.json", "--each", "plates/p.####.exr", "--each", "photos/*.exr", "-i", "photo={}")
    ending = halation("render", *words, "-o", "many/{stem}.####.exr", "--cluster", farm.address, "--deterministic")
    assert ending.code == 1 and "2 of 3 files" in ending.err, ending.err
    assert "plates/p.####.exr: on 3 tries, the last on tcp://" in ending.err and "SIGKILL" in ending.err
    assert {"a.0001.exr", "b.0001.exr"} <= read_files(looks / "many").keys()


def test_a_folder_with_another_path_on_workers_is_mapped(halation, looks, farm):
    """Neither table nor group is there: they travel with the graph."""
    elsewhere = looks.parent.parent / "volumes"
    shutil.copytree(looks.parent, elsewhere)
    for name in ("look.cube", "group.json", "look.json"):
        (elsewhere / "shot" / name).unlink()
    here = halation("render", "look.json", *WORDS, "-o", "one/{stem}.exr")
    words = ("-o", "many/{stem}.exr", "--cluster", farm.address, "--map", f"{looks.parent}={elsewhere}")
    there = halation("render", "look.json", *WORDS, *words)
    assert (here.code, there.code) == (0, 0), there.err
    assert read_files(elsewhere / "shot" / "many") == read_files(looks / "one") and not (looks / "many").exists()


def test_a_job_of_files_goes_on_by_itself(halation, looks, farm):
    sent = halation("render", "look.json", *WORDS, "-o", "many/{stem}.exr", "--cluster", farm.address, "--detach")
    assert sent.code == 0, sent.err
    assert json.loads(sent.out)["files"] == 4
    followed = halation("jobs", "--cluster", farm.address, "--follow", json.loads(sent.out)["job"])
    assert followed.code == 0 and "finished  4 of 4 files" in followed.out, followed
    assert sorted(read_files(looks / "many")) == ["a.exr", "b.exr", "c.exr", "d.exr"]
