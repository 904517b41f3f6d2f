"""Graphs with a memory are cut into stages whose results workers share."""

from __future__ import annotations

import json
import time

import pytest
from farms import end_group, read_frames, start_halation
from halation.cli.execute import open_job_graph
from halation.cli.job_setup import find_remembering_node
from halation.cli.parsing import find_targets
from halation.cluster.chunk import ChunkStage, StageReport
from halation.cluster.staged_assignments import StagedAssignments
from halation.renderer.jobs.render_job import RenderJob
from halation.resources.sandbox import UNRESTRICTED
from msgspec.structs import replace

pytest.importorskip("distributed", reason="Dask is not installed")

GRAPH = {
    "halation": 1,
    "nodes": {
        "noise": {"type": "noise"},
        "paint": {"type": "kuwahara"},
        "trail": {"type": "feedback"},
        "glow": {"type": "gaussian_blur", "values": {"sigma": 5.0}},
    },
    "outputs": {"image": {"type": "Image"}},
    "links": {
        "paint.image": "noise.out",
        "trail.image": "paint.out",
        "glow.image": "trail.out",
        "outputs.image": "glow.out",
    },
    "animation": {"noise.evolution": {"keys": [{"frame": 1, "value": 0.0}, {"frame": 12, "value": 6.0}]}},
    "settings": {"size": [160, 90], "frames": [1, 12]},
}
FRAMES = range(1, 13)


@pytest.fixture
def local_frames(halation, shot):
    """The bytes of all frames as one process writes them."""
    (shot / "shot.json").write_text(json.dumps(GRAPH))
    for folder in ("one", "many"):
        (shot / folder).mkdir()
    ending = halation("render", "shot.json", "-o", "one/f.####.exr", "--deterministic")
    assert ending.code == 0, ending.err
    return read_frames(shot / "one", FRAMES)


def cluster_words(farm, *words):
    return ("render", "shot.json", "-o", "many/f.####.exr", "--deterministic", "--cluster", farm.address, *words)


def test_each_frame_of_a_history_is_computed_once_and_all_are_those_of_one_process(halation, shot, farm, local_frames):
    ending = halation(*cluster_words(farm, "--json"))
    assert ending.code == 0, ending.err
    assert "one worker at a time renders what it stores" in ending.err
    report = json.loads(ending.out)
    # the survey renders the first two frames whole; the last frame stores nothing for others
    assert report["stages"] == {"ahead": 9, "history": 11} and report["workers"] == 2
    assert read_frames(shot / "many", FRAMES) == local_frames
    assert sorted(path.name for path in (shot / "many").iterdir())[0] == "f.0001.exr"  # no folder of results is left
    for frame in (2, 7):
        (shot / "many" / f"f.{frame:04d}.exr").unlink()
    report = json.loads(halation(*cluster_words(farm, "--json", "--resume")).out)
    assert report["kept"] == [frame for frame in FRAMES if frame not in (2, 7)] and report["stages"]["history"] == 6
    assert read_frames(shot / "many", FRAMES) == local_frames


def test_an_effect_that_begins_at_nothing_is_a_stage_too(shot):
    """At the first frame the glow has no passes, so that all of it is the memory."""
    graph = json.loads(json.dumps(GRAPH))
    del graph["nodes"]["paint"]
    graph["links"]["trail.image"] = "noise.out"
    graph["animation"]["glow.sigma"] = {"keys": [{"frame": 1, "value": 0.0}, {"frame": 12, "value": 5.0}]}
    (shot / "shot.json").write_text(json.dumps(graph))
    job = RenderJob(sandbox=UNRESTRICTED, graph=str(shot / "shot.json"), frames=tuple(FRAMES))
    loaded = open_job_graph(job)
    targets = find_targets(loaded, "")
    assert find_remembering_node(job, loaded, targets) == ("trail", True)
    assert find_remembering_node(replace(job, frames=(1,)), loaded, targets) == ("trail", False)


def test_a_worker_that_is_killed_during_a_history_leaves_it_to_others(halation, shot, make_farm, local_frames):
    farm = make_farm()
    for _ in range(2):
        farm.start_worker()
    process = start_halation(*cluster_words(farm), cwd=shot)
    while not list((shot / "many").glob(".halation-shared-*/*")):
        time.sleep(0.02)
        assert process.poll() is None
    end_group(farm.workers[0])
    farm.start_worker()
    _, err = process.communicate(timeout=100)
    assert process.returncode == 0, err
    assert read_frames(shot / "many", FRAMES) == local_frames


def test_a_history_that_cannot_go_on_names_the_frames_that_need_it(halation, shot, farm):
    graph = json.loads(json.dumps(GRAPH))
    graph["inputs"] = {"plate": {"type": "Image", "file": "plates/p.####.exr"}}
    del graph["nodes"]["noise"], graph["animation"], graph["settings"]
    graph["links"]["paint.image"] = "inputs.plate"
    (shot / "shot.json").write_text(json.dumps(graph))
    (shot / "plates" / "p.0005.exr").unlink()
    (shot / "many").mkdir()
    ending = halation(*cluster_words(farm))
    assert ending.code == 1 and "frame 6: " in ending.err and "p.0005.exr" in ending.err, ending.err
    written = [path.name for path in sorted((shot / "many").iterdir())]
    assert written == [f"f.{frame:04d}.exr" for frame in range(1, 5)]


def open_queue(frames, *, checks=False):
    return StagedAssignments(frames, 1, "/shared", checks=checks)


def finish(queue, assignment, **facts):
    """Report that all frames of a stage are stored, in a file each."""
    names = {frame: (f"{assignment.stage.kind}{frame}",) for frame in assignment.frames}
    seconds = dict.fromkeys(assignment.frames, 1.0)
    memories = dict.fromkeys(assignment.frames, ()) if assignment.stage.kind == "history" else {}
    queue.finish_stage(StageReport(seconds, names, memories, **facts), assignment)


def test_nothing_is_rendered_before_its_history():
    queue = open_queue(range(3, 9))
    survey = queue.take(4)
    assert survey.stage == ChunkStage("history", "/shared", (1, 2), 0, is_survey=True)
    assert queue.take(4) is None
    finish(queue, survey, frame_bytes=1000, ahead_pays=True)
    assert queue.take(4).frames == (3,)  # its history is there, and what lies ahead of that of frame 3 is not
    ahead = queue.take(4)
    assert (ahead.stage.kind, ahead.frames[0]) == ("ahead", 3)
    assert queue.take(1).stage.kind == "ahead"
    finish(queue, ahead, frame_bytes=1000)
    piece = queue.take(4)
    assert piece.stage.kind == "history" and piece.frames == ahead.frames


def test_files_are_removed_once_nobody_reads_them():
    queue = open_queue(range(1, 5))
    finish(queue, queue.take(1), frame_bytes=1000)
    queue.finish([1])
    chunk = queue.take(1)
    assert chunk.stage.kind == "history" and chunk.stage.drops == ()  # frame 2 reads what frame 1 has stored
    finish(queue, chunk, frame_bytes=1000)
    queue.finish([2])
    assert queue.take(1).stage.drops == ("history1",)


def test_results_take_a_limited_part_of_the_disk():
    queue = open_queue(range(1, 101))
    finish(queue, queue.take(1), frame_bytes=2 << 30)
    frames = []
    while (assignment := queue.take(2)) is not None:
        if assignment.stage.kind == "history":
            frames += assignment.frames
            finish(queue, assignment, frame_bytes=2 << 30)
    assert frames[-1] <= 5  # 8 GiB hold four frames, and the first one is not finished
    assert len(queue) == 100


def test_frames_after_a_history_that_ends_its_process_are_given_up():
    queue = open_queue(range(1, 5))
    finish(queue, queue.take(1), frame_bytes=1000)
    for worker in ("a", "b", "c"):
        piece = queue.take(1)
        assert piece.frames == (3,) and piece.stage.kind == "history"
        lost = queue.put_suspects(piece.frames, piece, worker)
    assert lost == (4,)
    queue.finish(lost)
    targets = []
    while (assignment := queue.take(1)) is not None:
        targets += assignment.frames
    assert targets == [1, 2, 3]


def test_the_frame_of_a_history_that_ends_its_process_is_found():
    """A piece that ends its process is rendered frame by frame: frames up to the faulty one are not lost."""
    queue = open_queue(range(1, 11))
    finish(queue, queue.take(1), frame_bytes=1000)
    for _ in range(40):
        assignment = queue.take(1)
        if assignment is None:
            break
        if assignment.stage.kind == "frames":
            queue.finish(assignment.frames)
        elif 6 in assignment.frames:
            queue.finish(queue.put_suspects(assignment.frames, assignment, "a"))
        else:
            finish(queue, assignment, frame_bytes=1000)
    assert len(queue) == 0 and queue.stage_frames["history"] == 5  # frames 1 to 5
