"""`halation worker --chunks`: what one process renders, chunk after chunk."""

from __future__ import annotations

import json
import subprocess

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
