"""What a process makes of chunks, without a device: faulty frames, files that are other ones, and lines."""

from __future__ import annotations

import base64
import os
from collections.abc import Sequence
from hashlib import sha256
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from halation import document
from halation.cli import chunk_worker
from halation.cli.chunk_worker import ChunkRenderer
from halation.cluster.chunk import ChunkStage, FileMark, FrameChunk
from halation.cluster.path_map import PathMap
from halation.cluster.versions import describe_versions
from halation.errors import DeviceError, GraphError, HalationError, InputError, UsageError
from halation.graph import Graph, Input, Port
from halation.nodes import catalogue
from halation.renderer.jobs.header import dump_whole_graph
from halation.renderer.jobs.render_entry import RenderEntry
from halation.renderer.jobs.render_job import RenderJob
from halation.resources.sandbox import UNRESTRICTED, Sandbox
from msgspec.structs import replace


@pytest.fixture
def lines() -> list[Any]:
    """What the renderer has answered."""
    return []


@pytest.fixture
def renderer(tmp_path: Path, lines: list[Any]) -> Any:
    folder = tmp_path / "travelled"
    folder.mkdir()
    return ChunkRenderer(folder, lines.append, UNRESTRICTED)


def make_chunk(*frames: int, graph: Graph | None = None, folder: str = "/show", **more: Any) -> FrameChunk:
    options = more.pop("job", {})
    text = dump_whole_graph(graph or Graph())
    return FrameChunk(RenderJob(sandbox=UNRESTRICTED, frames=frames, document=text, **options), folder, **more)


@pytest.mark.parametrize(
    ("fault", "is_chain", "runs", "faulty"),
    [
        (InputError("no"), False, [(1, 2, 3, 4, 5), (4,), (5,)], [4]),
        (InputError("no"), True, [(1, 2, 3, 4, 5)], [4, 5]),
        (UsageError("no"), False, [(1, 2, 3, 4, 5)], [4, 5]),
        (GraphError("no"), False, [(1, 2, 3, 4, 5)], [4, 5]),
        (None, False, [(1, 2, 3, 4, 5)], []),
    ],
)
def test_after_an_error_the_missing_frames_are_rendered_one_by_one(
    renderer: Any, lines: list[Any], fault: HalationError | None, is_chain: bool, runs: list[Any], faulty: list[int]
) -> None:
    """Frame 4 is at fault; an error that all have alike, or of a chain, is that of all that are missing."""
    seen = list[tuple[int, ...]]()
    renderer._make_item = lambda chunk, graph, frames, history: tuple(frames)

    def run(device: object, frames: Sequence[int], chunk: FrameChunk) -> tuple[set[int], Any, dict[str, Any]]:
        seen.append(tuple(frames))
        is_broken = fault is not None and 4 in frames
        done = {frame for frame in frames if not is_broken or frame < 4}
        return done, fault if is_broken else None, {"passes": len(seen)}

    renderer._run = run
    renderer._render_frames(make_chunk(1, 2, 3, 4, 5, is_chain=is_chain), Graph(), None, None)
    assert seen == runs and len(lines) == 1 and lines[0]["costs"] == {"passes": len(runs)}
    assert list(lines[0]["faults"]) == faulty
    assert all(facts["message"] == "no" for facts in lines[0]["faults"].values())


@pytest.mark.parametrize(
    ("fault", "frames", "is_chain", "parts"),
    [
        (InputError("no"), (1,), False, [1]), (InputError("no"), (1, 2), False, []),
        (InputError("no"), (1, 2), True, [1, 2]),
        (UsageError("no"), (1, 2), False, [1, 2]), (GraphError("no"), (1, 2), False, [1, 2]),
    ],
)  # fmt: skip
def test_an_error_of_several_parts_is_that_of_none_before_each_was_tried(
    fault: HalationError, frames: tuple[int, ...], is_chain: bool, parts: list[int]
) -> None:
    assert list(chunk_worker._spread_fault(make_chunk(*frames, is_chain=is_chain), fault)) == parts


def test_another_version_a_broken_device_and_a_graph_that_is_none_are_answered(renderer: Any, lines: list[Any]) -> None:
    graph = Graph().add("e", catalogue()["exposure"]())
    renderer.render(make_chunk(1, graph=graph, versions={**describe_versions(graph), "node type exposure": "odd"}))
    assert list(lines[-1]) == ["refusal"] and lines[-1]["refusal"].endswith("and the job was sent by odd")

    def fail(job: RenderJob) -> Any:
        raise DeviceError("no driver")

    renderer._open_renderer = fail
    renderer.render(make_chunk(1, graph=graph, versions=describe_versions(graph)))
    assert lines[-1] == {"refusal": "it cannot render: no driver"}
    renderer.open_device(RenderJob(sandbox=UNRESTRICTED))  # says nothing: the first chunk does
    renderer.render(replace(make_chunk(1, 2), job=RenderJob(sandbox=UNRESTRICTED, frames=(1, 2), document="{")))
    assert len(lines) == 3 and lines[-1]["costs"] == {}


def test_a_graph_is_read_once_for_all_chunks_that_have_it(renderer: Any) -> None:
    chunk, paths = make_chunk(1, graph=Graph().add("e", catalogue()["exposure"]())), PathMap(())
    graph = renderer._open_graph(chunk, paths)
    assert renderer._open_graph(chunk.take_parts((1,)), paths) is graph and graph.folder == "/show"
    assert renderer._open_graph(replace(chunk, folder="/other"), paths).folder == "/other"
    assert renderer._open_graph(make_chunk(1), paths).nodes == {}


def mark(path: Path, content: bytes) -> dict[str, FileMark]:
    return {str(path): FileMark(len(content), sha256(content).hexdigest())}


def test_files_are_those_that_the_job_was_sent_with(renderer: Any, tmp_path: Path, monkeypatch) -> None:
    file, hashed, read = tmp_path / "a.exr", list[str](), chunk_worker.content_hash
    file.write_bytes(b"one")
    monkeypatch.setattr(chunk_worker, "content_hash", lambda *words: hashed.append(str(words[0])) or read(*words))
    chunk = make_chunk(1, marks=mark(file, b"one"))
    assert (
        renderer._check_files(chunk, Graph(), PathMap(())) == renderer._check_files(chunk, Graph(), PathMap(())) == {}
    )
    assert hashed == [str(file)], "read once"
    ours, theirs = (sha256(text).hexdigest()[:12] for text in (b"one", b"two"))
    for content, facts in ((b"two", f"SHA-256 {ours}, not {theirs}"), (b"longer", "3 bytes, not 6")):
        with pytest.raises(InputError) as fault:
            renderer._check_files(make_chunk(1, marks=mark(file, content)), Graph(), PathMap(()))
        assert str(fault.value).startswith(
            f"{file}: is another file than on the machine that sent the job (it has {facts})"
        )
    travelled = make_chunk(1, marks=mark(file, b"two"), contents={str(file): ""})
    assert renderer._check_files(travelled, Graph(), PathMap(())) == {}
    with pytest.raises(InputError):
        renderer._check_files(make_chunk(1, marks=mark(tmp_path / "lost", b"")), Graph(), PathMap(()))
    moved = make_chunk(1, marks={"/farm/a.exr": chunk.marks[str(file)]})
    assert renderer._check_files(moved, Graph(), PathMap((("/farm", str(tmp_path)),))) == {}


def test_of_a_chain_the_first_frame_is_named_that_reads_a_wrong_file(renderer: Any, tmp_path: Path) -> None:
    for frame in range(1, 5):
        (tmp_path / f"p.{frame:04d}.exr").write_bytes(b"old")
    graph = Graph(folder=str(tmp_path)).add_input("plate", Input(file="p.####.exr"))
    wrong = {**mark(tmp_path / "p.0001.exr", b"old"), **mark(tmp_path / "p.0003.exr", b"new")}
    chunk = make_chunk(1, 2, 3, 4, graph=graph, folder=str(tmp_path), is_chain=True, marks=wrong)
    faults = renderer._check_files(chunk, graph, PathMap(()))
    assert list(faults) == [1, 2, 3, 4] and {facts["frame"] for facts in faults.values()} == {3}
    other = replace(chunk, marks=mark(tmp_path / "other", b""))
    assert {facts["frame"] for facts in renderer._check_files(other, graph, PathMap(())).values()} == {1}


def test_paths_of_a_graph_are_those_of_this_machine(renderer: Any, tmp_path: Path) -> None:
    graph = Graph(folder="/farm/show").add("lut", catalogue()["lut_file"](file="look.cube"))
    graph = graph.add("near", catalogue()["lut_file"](file="near.cube")).add(
        "far", catalogue()["lut_file"](file="/far/x.cube")
    )
    contents = {"/farm/show/look.cube": base64.b64encode(b"LUT").decode()}
    marks = {"/farm/show/look.cube": FileMark(3, "digest")}
    chunk = make_chunk(1, graph=graph, folder="/farm/show", contents=contents, marks=marks)
    there = renderer._locate_files(chunk, graph, PathMap((("/farm", str(tmp_path)),)))
    files = {id: str(item.file) for id, item in there.nodes.items()}  # pyright: ignore[reportAttributeAccessIssue]
    assert files["near"] == str(tmp_path / "show" / "near.cube") and files["far"] == "/far/x.cube"
    stored = Path(files["lut"])
    assert stored.read_bytes() == b"LUT" and stored.parts[-2:] == ("digest", "look.cube")
    stored.write_bytes(b"kept")
    renderer._locate_files(chunk, graph, PathMap(()))
    assert stored.read_bytes() == b"kept", "it is written once"
    assert renderer._locate_files(replace(chunk, contents={}), graph, PathMap(())) is graph


def test_a_job_has_paths_and_a_root_of_this_machine(tmp_path: Path) -> None:
    for name in ("in", "out"):
        (tmp_path / name).mkdir()
    paths = PathMap((("/farm", str(tmp_path)),))
    entry = RenderEntry("a", inputs={"x": "/farm/in/e.exr"}, destinations=(("", "/farm/out/e.exr"),))
    job = RenderJob(
        sandbox=Sandbox("/farm"),
        inputs={"": "/farm/in/a.exr"},
        destinations=(("b", "/farm/out/b.exr"),),
        entries=(entry,),
    )
    renderer: Any = ChunkRenderer(tmp_path, lambda line: None, Sandbox(str(tmp_path)))
    local = renderer._localize_job(job, paths)
    assert local.sandbox.root == str(tmp_path) and local.inputs == {"": str(tmp_path / "in/a.exr")}
    assert local.destinations == (("b", str(tmp_path / "out/b.exr")),)
    assert local.entries[0].inputs == {"x": str(tmp_path / "in/e.exr")}
    assert local.entries[0].destinations == (("", str(tmp_path / "out/e.exr")),)
    own = renderer._localize_job(RenderJob(sandbox=UNRESTRICTED), paths)
    assert own.sandbox.root == str(tmp_path), "whatever a chunk says"


def test_what_frames_share_is_kept_for_the_chunks_of_one_job(renderer: Any) -> None:
    textures = SimpleNamespace(budget=0, peak=9, allocated=4)
    renderer._renew_job(make_chunk(1, topic="a"), textures, Graph())
    hashes = renderer._file_hashes
    assert textures.peak == 4
    textures.peak = 9
    renderer._renew_job(make_chunk(2, topic="a"), textures, Graph())
    assert textures.peak == 9 and renderer._file_hashes is hashes
    renderer._renew_job(make_chunk(2, topic="b"), textures, Graph())
    assert textures.peak == 4 and renderer._file_hashes is not hashes


def test_the_history_of_others_is_opened_and_what_is_old_removed(renderer: Any, tmp_path: Path) -> None:
    (tmp_path / "old").write_bytes(b"")
    (tmp_path / "new").write_bytes(b"")
    stage = ChunkStage("frames", "/farm", frame_before=7, drops=("old",))
    history = renderer._open_history(make_chunk(8, stage=stage), PathMap((("/farm", str(tmp_path)),)))
    assert history.frame == 7 and not (tmp_path / "old").exists() and (tmp_path / "new").exists()
    assert renderer._open_history(make_chunk(8), PathMap(())) is None


def test_an_item_is_what_the_chunk_says(renderer: Any) -> None:
    graph = Graph().add("c", catalogue()["constant"]())
    item = renderer._make_item(make_chunk(4, 5, graph=graph, job={"node": "c"}), graph, [5], None)
    assert item.frames == (5,) and item.request.targets == {"c": Port("c", "out")} and item.history is None
    assert document.loads(item.graph_text, sandbox=UNRESTRICTED) == graph


def test_lines_are_read_in_pieces_until_the_end_or_a_long_silence(monkeypatch: pytest.MonkeyPatch) -> None:
    near, far = os.pipe()
    monkeypatch.setattr(chunk_worker.sys, "stdin", SimpleNamespace(fileno=lambda: near))
    monkeypatch.setattr(chunk_worker, "_PIECE_BYTES", 4)
    monkeypatch.setattr(chunk_worker, "IDLE_SECONDS", 0.05)
    os.write(far, "first\n\nünd zweitens\nhalf".encode())
    lines = chunk_worker._read_lines()
    assert [*lines] == ["first", "", "ünd zweitens"], "half a line is none"
    os.write(far, b"last\n")
    os.close(far)
    monkeypatch.setattr(chunk_worker, "IDLE_SECONDS", 60.0)
    assert [*chunk_worker._read_lines()] == ["last"]
    os.close(near)
