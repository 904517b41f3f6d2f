"""`halation render --cluster`: frames on workers of Dask, which are processes of their own."""

from __future__ import annotations

import json
import shutil

import pytest
from farms import FRAMES, Farm, make_graph, read_frames, start_halation

pytest.importorskip("distributed", reason="Dask is not installed")


@pytest.fixture
def local_frames(halation, shot):
    """The bytes of all frames as one process writes them."""
    (shot / "one").mkdir()
    ending = halation("render", "shot.json", "-o", "one/f.####.exr", "--deterministic")
    assert ending.code == 0, ending.err
    return read_frames(shot / "one")


def render(halation, shot, farm, *words, output="many"):
    (shot / output).mkdir(exist_ok=True)
    words = ("-o", f"{output}/f.####.exr", "--deterministic", "--cluster", farm.address, *words)
    return halation("render", "shot.json", *words)


def test_frames_are_those_of_one_process_to_the_byte(halation, shot, farm, local_frames):
    ending = render(halation, shot, farm, "--json")
    assert ending.code == 0, ending.err
    report = json.loads(ending.out)
    assert report["frames"] == list(FRAMES) and report["failed"] == {}
    assert report["written"][0] == "many/f.0001.exr" and report["workers"] == 2
    assert read_frames(shot / "many") == local_frames
    assert json.loads(render(halation, shot, farm, "--json", "--resume").out)["kept"] == list(FRAMES)


def test_workers_here_need_no_scheduler(halation, shot, local_frames):
    (shot / "many").mkdir()
    words = ("-o", "many/f.####.exr", "--deterministic", "--cluster", "local:2")
    ending = halation("render", "shot.json", *words)
    assert ending.code == 0 and "8 of 8 frames" in ending.err and "2 workers" in ending.err, ending.err
    assert read_frames(shot / "many") == local_frames


def test_a_folder_with_another_path_on_workers_is_mapped(halation, shot, farm, local_frames):
    """The worker has the show elsewhere, and no table at all: that travels with the graph, as groups do."""
    elsewhere = shot.parent.parent / "volumes"
    shutil.copytree(shot.parent, elsewhere)
    for name in ("look.cube", "group.json", "shot.json"):
        (elsewhere / "shot" / name).unlink()
    (elsewhere / "shot" / "many").mkdir()
    ending = render(halation, shot, farm, "--map", f"{shot.parent}={elsewhere}")
    assert ending.code == 0, ending.err
    assert read_frames(elsewhere / "shot" / "many") == local_frames
    assert not list((shot / "many").iterdir())


def test_another_file_on_a_worker_is_refused_by_its_size_and_its_content(halation, shot, farm):
    elsewhere = shot.parent.parent / "volumes"
    shutil.copytree(shot.parent, elsewhere)
    (elsewhere / "shot" / "many").mkdir()
    plate = elsewhere / "shot" / "plates" / "p.0003.exr"
    content = bytearray(plate.read_bytes())
    content[-1] ^= 1
    plate.write_bytes(content)
    (elsewhere / "shot" / "plates" / "p.0005.exr").write_bytes(b"short")
    ending = render(halation, shot, farm, "--map", f"{shot.parent}={elsewhere}")
    assert ending.code == 1
    assert f"frame 3: {plate}: is another file" in ending.err and "it has SHA-256" in ending.err
    assert "frame 5: " in ending.err and "it has 5 bytes, not" in ending.err
    written = sorted(path.name for path in (elsewhere / "shot" / "many").iterdir())
    assert written == [f"f.{frame:04d}.exr" for frame in FRAMES if frame not in (3, 5)]


def test_a_graph_with_a_memory_is_one_chain(halation, shot, farm):
    graph = make_graph()
    graph["nodes"]["blur"] = {"type": "feedback"}
    del graph["animation"]
    (shot / "shot.json").write_text(json.dumps(graph))
    (shot / "one").mkdir()
    assert halation("render", "shot.json", "-o", "one/f.####.exr", "--deterministic").code == 0
    ending = render(halation, shot, farm, "--json")
    assert ending.code == 0, ending.err
    assert json.loads(ending.out)["chunks"] == 1 and "needs the frame before each" in ending.err
    assert read_frames(shot / "many") == read_frames(shot / "one")


def test_an_error_that_all_frames_have_is_that_of_one_process(halation, shot, farm):
    graph = make_graph()
    graph["nodes"]["blur"]["values"] = {"nonsense": 1}
    graph["nodes"]["blur"]["type"] = "blurr"
    (shot / "shot.json").write_text(json.dumps(graph))
    here = halation("render", "shot.json", "-o", "f.####.exr")
    there = halation("render", "shot.json", "-o", "f.####.exr", "--cluster", farm.address)
    assert (here.code, here.err) == (there.code, there.err) and here.code == 3


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--cluster", "tcp://127.0.0.1:9"), "no scheduler answers there: start one with 'dask scheduler'"),
        (("--cluster", "farm"), "--cluster farm: write tcp://HOST:PORT of a Dask scheduler"),
        (("--cluster", "local:2", "-j", "2"), "--cluster and -j: give one of them"),
        (("--cluster", "local:2", "--map", "a=b"), "--map a=b: write --map FROM=TO with two absolute folders"),
        (("--priority", "3"), "--map, --priority and --detach are for a cluster"),
    ],
)
def test_what_cannot_be_is_one_sentence(halation, words, sentence):
    ending = halation("render", "shot.json", "-o", "f.####.exr", *words)
    assert ending.code in (1, 2) and sentence in ending.err and ending.err.count("\n") == 1, ending.err


def test_a_missing_folder_is_named_before_anything_is_sent(halation, shot, farm, local_frames):
    """As one process says it, not once for each frame and worker. A folder that is mapped need not be here."""
    here = halation("render", "shot.json", "-o", "none/f.####.exr")
    there = halation("render", "shot.json", "-o", "none/f.####.exr", "--cluster", farm.address)
    assert here.code == there.code == 1 and there.err.splitlines() == here.err.splitlines()[-1:], (here, there)
    assert "none/f.0001.exr: cannot be written: there is no such folder: create it first" in there.err
    (shot / "elsewhere").mkdir()
    words = ("--cluster", farm.address, "--map", f"{shot / 'none'}={shot / 'elsewhere'}", "--deterministic")
    assert halation("render", "shot.json", "-o", "none/f.####.exr", *words).code == 0
    assert read_frames(shot / "elsewhere") == local_frames


def test_a_new_farm_starts_when_a_worker_comes(make_farm, shot):
    farm: Farm = make_farm()
    words = ("render", "shot.json", "-o", "f.####.exr", "--deterministic", "--cluster", farm.address)
    process = start_halation(*words, cwd=shot)
    assert process.stderr is not None
    lines = [process.stderr.readline()]
    while "no worker is connected" not in lines[-1]:
        assert lines[-1], lines
        lines.append(process.stderr.readline())
    farm.start_worker()
    process.communicate(timeout=60)
    assert process.returncode == 0 and len(list(shot.glob("f.*.exr"))) == len(FRAMES)
