"""`halation worker --chunks`: what one process renders, chunk after chunk."""

from __future__ import annotations

import json
import subprocess
from collections import Counter
from collections.abc import Callable

import pytest
from farms import PYTHON, make_graph
from halation.cli.cluster_job import prepare_chunk
from halation.cli.execute import open_job_graph
from halation.cluster.assignments import CHUNK_SECONDS, AssignmentQueue
from halation.cluster.render_process import RenderProcess
from halation.renderer.jobs.render_job import RenderJob
from halation.resources.sandbox import UNRESTRICTED
from msgspec.structs import replace


def count_passes(folder, chunks) -> list[int]:
    """The passes of each chunk, which one process renders in order."""
    text = "".join(f"{chunk.to_json()}\n" for chunk in chunks)
    command = [PYTHON, "-m", "halation.cli", "worker", "--chunks"]
    ended = subprocess.run(command, cwd=folder, input=text, capture_output=True, text=True, check=True)
    answers = [json.loads(line) for line in ended.stdout.splitlines()]
    assert all(answer["faults"] == {} for answer in answers if "frame" not in answer)
    return [answer["costs"]["passes"] for answer in answers if "frame" not in answer]


def test_lines_that_come_together_are_all_answered_before_the_input_ends(shot):
    """The device is asked for while a process starts, so that its first chunk may lie in the pipe too."""
    job = RenderJob(
        sandbox=UNRESTRICTED,
        graph=str(shot / "shot.json"),
        frames=(1, 2),
        destinations=(("", str(shot / "f.####.exr")),),
        deterministic=True,
    )
    chunk, mark_files = prepare_chunk(job, open_job_graph(job), ())
    chunk = replace(chunk, marks=mark_files(job.frames))
    process = RenderProcess(1)
    process.open_device(job)
    try:
        reports = [process.render(chunk.take_parts((frame,)), lambda _: None, lambda: False, 0) for frame in job.frames]
    finally:
        process.stop()
    assert [list(report.seconds) for report in reports] == [[1], [2]]
    assert not any(report.death or report.refusal or report.faults for report in reports)


def test_a_worker_gets_one_chunk_until_it_is_known_what_a_frame_costs():
    """The first frame of a worker takes its start too: it decides how long chunks are only while it is all there is."""
    queue = AssignmentQueue(range(1000), is_chain=False)
    assert len(queue.take(2).frames) == 1 and not queue.sends_ahead
    queue.note_cost([2.0], is_first=True)
    assert queue.sends_ahead and len(queue.take(2).frames) == CHUNK_SECONDS / 2.0
    queue.note_cost([0.5, 0.5])
    assert len(queue.take(2).frames) == CHUNK_SECONDS / 0.5
    queue.note_cost([9.0], is_first=True)
    assert len(queue.take(2).frames) == CHUNK_SECONDS / 0.5


def end_chunks(queue: AssignmentQueue, is_deadly: Callable[[tuple[int, ...]], bool]) -> tuple[set[int], dict[int, str]]:
    """Take chunks until there are none, where some end their process: the frames that are finished, and why others
    are not."""
    finished, faults = set[int](), dict[int, str]()
    while len(queue):
        assignment = queue.take(2)
        assert assignment is not None
        if is_deadly(assignment.frames):
            lost = queue.put_suspects(assignment.frames, assignment, "near")
            faults |= dict.fromkeys(lost, queue.explain_loss(lost, "it ends"))
            queue.finish(lost)
        else:
            finished |= set(assignment.frames)
            queue.finish(assignment.frames)
    return finished, faults


def test_the_frame_of_a_chain_that_ends_its_process_is_found_and_the_others_are_finished():
    tries = Counter[tuple[int, ...]]()

    def is_deadly(frames: tuple[int, ...]) -> bool:
        tries[frames] += 1
        return 6 in frames

    queue = AssignmentQueue((5, 6, 7, 8, 9, 10), is_chain=True)
    assert end_chunks(queue, is_deadly) == ({5, 7, 8, 9, 10}, {6: "it ends"})
    assert tries == {(5, 6, 7, 8, 9, 10): 1, (5,): 1, (6,): 2, (7, 8, 9, 10): 1}


def test_frames_of_a_chain_that_need_one_that_ends_its_process_are_tried_once():
    sentence = "one worker renders all frames, and frame 6 cannot be rendered"
    queue = AssignmentQueue(range(5, 100), is_chain=True)
    finished, faults = end_chunks(queue, lambda frames: frames[-1] >= 6)
    assert finished == {5} and faults == {6: "it ends"} | dict.fromkeys(range(7, 100), sentence)


def test_frames_after_a_suspect_of_a_chain_wait_for_it():
    queue = AssignmentQueue((1, 2, 3), is_chain=True)
    whole = queue.take(2)
    assert whole is not None and queue.put_suspects((1, 2, 3), whole, "near") == ()
    suspect = queue.take(2)
    assert suspect is not None and (suspect.frames, suspect.attempts, suspect.tried) == ((1,), 1, {"near"})
    assert queue.take(2) is None and len(queue) == 2
    queue.finish((1,))
    following = queue.take(2)
    assert following is not None and following.frames == (2,)


def test_a_video_whose_process_ends_begins_anew():
    queue = AssignmentQueue((1, 2), is_chain=True, is_whole=True)
    tries: list[tuple[int, ...]] = []
    finished, faults = end_chunks(queue, lambda frames: bool(tries.append(frames) or True))
    assert tries == [(1, 2)] * 3 and not finished and faults == {1: "it ends", 2: "it ends"}


def test_what_all_frames_share_is_computed_by_the_first_chunk_alone(shot):
    """However the frames are cut, a process draws as many passes as one that gets them together."""
    graph = make_graph()
    graph["nodes"] = {"noise": {"type": "noise"}, "wide": {"type": "gaussian_blur"}, "blur": {"type": "gaussian_blur"}}
    graph["nodes"]["wide"] |= {"values": {"sigma": 9.0}}
    graph["links"] = {"wide.image": "noise.out", "blur.image": "wide.out", "outputs.image": "blur.out"}
    graph["animation"] = {"blur.sigma": {"keys": [{"frame": 1, "value": 2.0}, {"frame": 8, "value": 3.0}]}}
    graph["inputs"] = {}
    (shot / "shot.json").write_text(json.dumps({**graph, "settings": {"size": [64, 48]}}))
    job = RenderJob(
        sandbox=UNRESTRICTED,
        graph=str(shot / "shot.json"),
        frames=(1, 2, 3, 4),
        destinations=(("", str(shot / "f.####.exr")),),
        deterministic=True,
    )
    chunk, _ = prepare_chunk(job, open_job_graph(job), ())
    chunk = replace(chunk, topic="job")
    together = count_passes(shot, [chunk])
    alone = count_passes(shot, [chunk.take_parts((frame,)) for frame in job.frames])
    halves = count_passes(shot, [chunk.take_parts((1, 2)), chunk.take_parts((3, 4))])
    assert alone[1] < alone[0] and len(set(alone[1:])) == 1
    assert sum(alone) == sum(halves) == sum(together)


@pytest.mark.parametrize(
    ("frames", "has_stage"), [((1,), False), ((2,), False), ((1, 2), True), ((2, 3), True), ((0, 1), False)]
)
def test_two_frames_with_a_history_share_it(shot, frames: tuple[int, ...], has_stage: bool):
    """One frame has nobody to share its history with; a history begins with the first frame of the range."""
    graph = {**make_graph(), "settings": {"size": [64, 48], "frames": [1, 9]}, "inputs": {}}
    graph["nodes"] = {"noise": {"type": "noise"}, "blur": {"type": "gaussian_blur"}, "echo": {"type": "light_trails"}}
    graph["links"] = {"blur.image": "noise.out", "echo.image": "blur.out", "outputs.image": "echo.out"}
    (shot / "shot.json").write_text(json.dumps(graph))
    destinations = (("", str(shot / "f.####.exr")),)
    job = RenderJob(
        sandbox=UNRESTRICTED,
        graph=str(shot / "shot.json"),
        frames=frames,
        destinations=destinations,
        deterministic=True,
    )
    chunk, _ = prepare_chunk(job, open_job_graph(job), ())
    assert chunk.is_chain != has_stage
    assert has_stage == (chunk.stage is not None and chunk.stage.frame_before == 1)
