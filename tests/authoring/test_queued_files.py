"""Queued renders of many files and on clusters: the same processes and files as those of the command line."""

from __future__ import annotations

import json
import time
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from exr_files import write_exr
from farms import start_halation
from halation import document
from halation.authoring.render_queue.queue import QueuedFiles, RenderJob, RenderQueue
from halation.errors import UsageError
from halation.graph import Expression, Graph, Input, Output, Port, Settings
from halation.nodes import catalogue
from halation.resources.sandbox import UNRESTRICTED

make_job = partial(RenderJob, sandbox=UNRESTRICTED, deterministic=True, scale=float("1"))
"""As the command line makes it: the header of a picture has a scale that was given, even if it is the default."""
STEM = "{stem}.exr"


@pytest.fixture
def exports():
    made = RenderQueue(sandbox=UNRESTRICTED)
    yield made
    made.close()


@pytest.fixture
def project(tmp_path) -> Path:
    """A project with three photos and a text among them."""
    made = tmp_path / "project"
    (made / "photos").mkdir(parents=True)
    for number, name in enumerate("abc", 1):
        picture = np.random.default_rng(number).random((12, 16, 4), np.float32)
        write_exr(made / "photos" / f"{name}.exr", {"Combined": picture}, {"Combined": "half"})
    (made / "photos" / "notes.txt").write_text("no picture")
    return made


def make_look(folder: Path) -> Graph:
    graph = Graph(folder=str(folder)).add_input("photo", Input()).add_output("image", Output())
    graph = graph.add("blur", catalogue()["gaussian_blur"](sigma=2.0))
    graph = graph.connect(Port("inputs", "photo"), Port("blur", "image"))
    return graph.connect(Port("blur", "out"), Port("outputs", "image"))


def read_folder(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.glob("*.exr")}


def render_each(project: Path, *words: str) -> dict[str, bytes]:
    """What the command line writes for the same files."""
    document.save(make_look(project), project / "look.json", sandbox=UNRESTRICTED)
    words = ("--each", "photos/*.exr", "-o", f"here/{STEM}", "--deterministic", *words)
    process = start_halation("render", "look.json", *words, cwd=project)
    _, said = process.communicate(timeout=120)
    assert process.returncode == 0, said
    return read_folder(project / "here")


@pytest.mark.parametrize(("jobs", "cluster"), [(1, ""), (2, ""), (1, "local:2")])
def test_a_folder_is_rendered_as_by_the_command_line(exports, project, jobs, cluster):
    if cluster:
        pytest.importorskip("distributed", reason="Dask is not installed")
    queued = exports.start(
        make_look(project),
        [("", project / "out" / STEM)],
        options=make_job(processes=jobs),
        files=QueuedFiles("photos"),
        cluster=cluster,
    )
    assert queued.wait(120) and (queued.state, queued.failure) == ("done", ""), (queued.failure, queued.notes)
    assert (queued.done, queued.total, queued.faulty, queued.has_many_files) == (3, 3, 0, True)
    assert queued.workers == (2 if cluster else 0) and queued.folder == project / "out"
    assert sorted(queued.written_files) == [project / "out" / f"{name}.exr" for name in "abc"]
    assert read_folder(project / "out") == render_each(project)
    again = exports.resume(queued)
    assert again.wait(120) and (again.state, again.reused) == ("done", 3), again.failure


def test_a_file_that_fails_is_counted_and_named(exports, project):
    (project / "photos" / "b.exr").write_bytes(b"no picture")
    out = [("", project / "out" / STEM)]
    queued = exports.start(make_look(project), out, options=make_job(), files=QueuedFiles("photos/*.exr"))
    assert queued.wait(120) and (queued.state, queued.faulty, queued.done) == ("failed", 1, 3)
    assert queued.failure == "1 of 3 files failed" and any("b.exr: is not an EXR file" in note for note in queued.notes)
    assert sorted(read_folder(project / "out")) == ["a.exr", "c.exr"]


@pytest.mark.parametrize(
    ("files", "name", "sentence"),
    [
        ("nowhere/*.exr", STEM, "no file matches this pattern"),
        ("", STEM, "no files are chosen"),
        ("@", STEM, "no files are chosen"),
        (".", STEM, "no picture is in this folder"),
        ("photos", "same.exr", "would be written to this one file"),
        ("photos", "{steam}.exr", "'{steam}' is not a place"),
    ],
)
def test_what_cannot_be_is_said_before_it_is_queued(exports, project, files, name, sentence):
    with pytest.raises(UsageError, match=sentence):
        exports.start(make_look(project), [("", project / "out" / name)], files=QueuedFiles(files))
    assert exports.all == ()


def test_a_list_names_files_and_an_input_is_chosen(exports, project):
    """The list is beside the graph; the other input keeps what it is bound to."""
    (project / "chosen.txt").write_text(f"{project}/photos/a.exr\n{project}/photos/c.exr\n")
    graph = make_look(project).add_input("plate", Input()).add("mix", catalogue()["merge"]())
    graph = graph.connect(Port("inputs", "plate"), Port("mix", "b"))
    graph = graph.connect(Port("blur", "out"), Port("mix", "a"))
    graph = graph.connect(Port("mix", "out"), Port("outputs", "image"))
    bound = {"plate": str(project / "photos" / "b.exr")}
    files = QueuedFiles("@chosen.txt", "photo")
    queued = exports.start(graph, [("", project / "out" / STEM)], bound, make_job(), files=files)
    assert queued.wait(120) and queued.state == "done", queued.failure
    assert sorted(read_folder(project / "out")) == ["a.exr", "c.exr"]
    assert [dict(entry.inputs)["plate"] for entry in queued.job.order.entries] == [bound["plate"]] * 2


def test_frames_are_shared_by_a_cluster_and_cancelled(exports, project):
    """The workers of another process render; what is finished stays, and nothing unfinished."""
    pytest.importorskip("distributed", reason="Dask is not installed")
    graph = make_look(project).animate(Port("blur", "sigma"), Expression("2 + frame * 0.01"))
    graph = replace(graph, settings=Settings(frames=(1, 400)))
    options = make_job(frames=tuple(range(1, 401)))
    bound = {"photo": str(project / "photos" / "a.exr")}
    queued = exports.start(graph, [("", project / "f.####.exr")], bound, options, cluster="local:2")
    while queued.done < 3 and queued.state == "running":
        time.sleep(0.02)
    assert queued.state == "running", (queued.failure, queued.notes)
    assert queued.workers == 2 and queued.written_files[0].is_file()
    queued.cancel()
    assert queued.wait(20) and queued.state == "cancelled", queued.failure
    count = len(list(project.glob("f.*.exr")))
    assert 3 <= count < 400 and not list(project.glob(".halation-*"))


def test_a_cluster_that_is_not_there_is_a_sentence(exports, project):
    pytest.importorskip("distributed", reason="Dask is not installed")
    bound = {"photo": str(project / "photos" / "a.exr")}
    queued = exports.start(make_look(project), [("", project / "o.exr")], bound, cluster="farm")
    assert queued.wait(60) and queued.state == "failed"
    assert "write tcp://HOST:PORT of a Dask scheduler" in queued.failure


def test_a_report_that_is_longer_than_a_pipe_is_read(exports, tmp_path):
    """The names of 2,000 frames are more than the 64 KB that a pipe holds."""
    graph = Graph(folder=str(tmp_path)).add_output("image", Output()).add("c", catalogue()["constant"]())
    graph = replace(graph.connect(Port("c", "out"), Port("outputs", "image")), settings=Settings(size=(4, 4)))
    name = tmp_path / f"{'n' * 60}.####.exr"
    options = RenderJob(sandbox=UNRESTRICTED, frames=tuple(range(1, 1001)))
    queued = exports.start(graph, [("", name)], options=options)
    assert queued.wait(200) and (queued.state, queued.done) == ("done", 1000), queued.failure
    assert len(queued.written_files) == 1000 and len(json.dumps([str(path) for path in queued.written_files])) > 2**16
