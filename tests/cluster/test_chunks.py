"""`halation worker --chunks`: what one process renders, chunk after chunk."""

from __future__ import annotations

import json
import subprocess

from farms import PYTHON, make_graph
from halation.cli.cluster_job import prepare_chunk
from halation.cli.execute import open_job_graph
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
