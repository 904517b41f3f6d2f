"""Files and versions that workers compare with those of the sender: without a cluster."""

from __future__ import annotations

import base64
from hashlib import sha256
from pathlib import Path
from types import SimpleNamespace
from typing import Annotated, Any

import pytest
from halation.cli.cluster_job import prepare_entries
from halation.cluster import file_marks, versions
from halation.cluster.campaign_report import CampaignReport
from halation.cluster.chunk import FileMark
from halation.cluster.file_marks import FileHashing, FileMarker
from halation.cluster.versions import describe_versions, find_version_fault
from halation.graph import Graph, Group, Input, Unknown
from halation.nodes import Image, Pointwise, Slider, catalogue
from halation.renderer.jobs.render_entry import RenderEntry
from halation.renderer.jobs.render_job import RenderJob
from halation.resources.sandbox import UNRESTRICTED, Sandbox
from halation.version import VERSION


def test_a_file_has_its_size_and_sha_256_and_is_read_once(tmp_path: Path, monkeypatch) -> None:
    read, hashed = file_marks.content_hash, list[str]()

    def note(path: str, sandbox: Sandbox) -> str:
        hashed.append(path)
        return read(path, sandbox)

    monkeypatch.setattr(file_marks, "content_hash", note)
    paths = [str(tmp_path / name) for name in ("a", "b", "lost", "folder")]
    for path, content in zip(paths, (b"one", b"", None), strict=False):
        if content is not None:
            Path(path).write_bytes(content)
    Path(paths[3]).mkdir()
    hashing = FileHashing(UNRESTRICTED)
    first = {paths[0]: FileMark(3, sha256(b"one").hexdigest())}
    assert hashing.mark_paths([paths[0], paths[0]]) == first and hashed == [paths[0]]
    marks = first | {paths[1]: FileMark(0, sha256(b"").hexdigest())}
    assert hashing.mark_paths(paths) == marks and hashing.mark_paths(paths) == marks
    assert sorted(hashed) == sorted([*paths[:2], paths[3]]), "each once, and the missing one not at all"


def make_marker(folder: Path, sandbox: Sandbox = UNRESTRICTED, **inputs: str) -> FileMarker:
    """A graph with a sequence, a picture and tables in a folder."""
    graph = Graph(folder=str(folder)).add_input("plate", Input(file="p.####.exr", missing="hold"))
    graph = graph.add_input("still", Input(file="still.exr"))
    for id, file in (("lut", "Look.CUBE"), ("lost", "lost.cube"), ("odd", "table.bin"), ("large", "large.cube")):
        graph = graph.add(id, catalogue()["lut_file"](file=file))
    return FileMarker(graph, inputs, sandbox)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch) -> Path:
    """The files of `make_marker`; a table may have eight bytes."""
    monkeypatch.setattr(file_marks, "MAX_TRAVELLING_BYTES", 8)
    for name, count in (("p.0001.exr", 1), ("p.0003.exr", 3), ("still.exr", 2), ("Look.CUBE", 8), ("table.bin", 1),
                        ("large.cube", 9)):  # fmt: skip
        (tmp_path / name).write_bytes(b"x" * count)
    return tmp_path


def list_names(marker: FileMarker, folder: Path, *frames: int, history: range = range(0)) -> list[str]:
    files = marker.list_files(frames, history)
    assert len(set(files)) == len(files) and all(Path(file).parent == folder for file in files)
    return [Path(file).name for file in files]


def test_frames_read_tables_pictures_and_their_own_files_of_a_sequence(folder: Path) -> None:
    """Frame 2 is missing, and the one before it stands for it."""
    tables = ["Look.CUBE", "lost.cube", "table.bin", "large.cube"]
    marker = make_marker(folder)
    assert marker.names_sequences
    assert list_names(marker, folder, 3) == [*tables, "p.0003.exr", "still.exr"]
    assert list_names(marker, folder, 2, 1) == [*tables, "p.0001.exr", "still.exr"]
    assert list_names(marker, folder, 3, history=range(1, 3)) == [*tables, "p.0001.exr", "p.0003.exr", "still.exr"]
    bound = make_marker(folder, plate=str(folder / "still.exr"))
    assert not bound.names_sequences and list_names(bound, folder, 1, 2) == [*tables, "still.exr"]
    marks = marker.mark_files((3,), range(0))
    assert {Path(path).name: mark.size for path, mark in marks.items()} == {
        "Look.CUBE": 8, "table.bin": 1, "large.cube": 9, "p.0003.exr": 3, "still.exr": 2,
    }  # fmt: skip


def test_a_graph_without_sequences_reads_the_same_files_in_all_frames(folder: Path) -> None:
    graph = Graph(folder=str(folder)).add_input("still", Input(file="still.exr"))
    marker = FileMarker(graph, {}, UNRESTRICTED)
    assert not marker.names_sequences and list_names(marker, folder, 1, 2, history=range(5)) == ["still.exr"]


def test_tables_travel_unless_they_are_large_or_of_a_kind_that_may_name_other_files(folder: Path) -> None:
    contents = make_marker(folder).read_contents()
    assert contents == {str(folder / "Look.CUBE"): base64.b64encode(b"x" * 8).decode()}


def test_files_may_be_marked_by_several_and_are_read_once(folder: Path, monkeypatch) -> None:
    hashing, graph = FileHashing(UNRESTRICTED), Graph(folder=str(folder)).add_input("still", Input(file="still.exr"))
    first = FileMarker(graph, {}, UNRESTRICTED, hashing).mark_files((1,), range(0))
    monkeypatch.setattr(file_marks, "content_hash", None)
    assert FileMarker(graph, {}, UNRESTRICTED, hashing).mark_files((1,), range(0)) == first != {}


def test_parts_that_are_files_have_the_marks_of_their_own(tmp_path: Path) -> None:
    entries = tuple(RenderEntry(f"{name}.exr", {"photo": str(tmp_path / f"{name}.exr")}) for name in "abc")
    for size, entry in enumerate(entries, 1):
        Path(entry.inputs["photo"]).write_bytes(b"x" * size)
    graph = Graph(folder=str(tmp_path)).add_input("photo", Input())
    job = RenderJob(sandbox=UNRESTRICTED, entries=entries, frames=(1,), destinations=(("", "{stem}.exr"),))
    chunk, mark_files = prepare_entries(job, graph, ())
    assert chunk.numbers == (1, 2, 3)
    for numbers in ((1,), (2,), (3, 1)):
        found = {Path(path).name: mark.size for path, mark in mark_files(numbers).items()}
        assert found == {entries[number - 1].file: number for number in numbers}


class Plugged(Pointwise):
    """Stands for the node of a plug-in."""

    image = Image()
    amount: Annotated[float, Slider(0.0, 1.0, unit="ratio")] = 0.5


def test_the_versions_of_a_graph_are_those_of_all_code_that_it_runs(monkeypatch) -> None:
    inner = Graph().add("deep", catalogue()["grade"]())
    graph = Graph().add("a", catalogue()["exposure"]()).add("b", catalogue()["exposure"]()).add("g", Group(inner))
    graph = graph.add("u", Unknown("odd", {}))
    found = describe_versions(graph)
    assert list(found) == ["Halation", "node type exposure", "node type grade"] and found["Halation"] == VERSION
    assert all(len(found[name]) == 12 and int(found[name], 16) >= 0 for name in [*found][1:])
    assert found["node type exposure"] != found["node type grade"]
    assert describe_versions(Graph().add("x", catalogue()["exposure"](stops=3.0))) == {
        name: found[name] for name in ("Halation", "node type exposure")
    }
    plugin = [SimpleNamespace(namespace=name, package=f"halation-{name}", version="1.2") for name in ("mine", "other")]
    monkeypatch.setattr(versions, "plugins", lambda: plugin)
    monkeypatch.setattr(Plugged, "id", "mine.plugged")
    assert list(describe_versions(Graph())) == ["Halation"]
    with_plugin = describe_versions(graph.add("p", Plugged()))
    assert with_plugin["the plug-in halation-mine"] == "1.2" and "the plug-in halation-other" not in with_plugin


def test_the_code_of_a_node_is_its_file_and_the_shaders_that_it_includes(monkeypatch) -> None:
    graph = Graph().add("a", catalogue()["exposure"]())
    found = describe_versions(graph)
    library = versions.load_library()
    shader = catalogue()["exposure"].shader
    other: Any = SimpleNamespace(texts=library.texts, digest=lambda names, asker: "other")
    monkeypatch.setattr(versions, "load_library", lambda: other)
    changed = describe_versions(graph)
    assert shader in library.texts and changed["node type exposure"] != found["node type exposure"]
    source = Path(versions.inspect.getfile(catalogue()["exposure"])).read_bytes()
    assert changed["node type exposure"] == sha256(source + b"\0other").hexdigest()[:12]
    monkeypatch.setattr(versions, "load_library", lambda: SimpleNamespace(texts={}))
    assert describe_versions(graph)["node type exposure"] == sha256(source).hexdigest()[:12]


def test_what_differs_between_versions_is_said_in_a_sentence() -> None:
    ours = {"Halation": "1.0", "node type a": "00", "the plug-in p": "2"}
    assert find_version_fault(ours, {}) == find_version_fault(ours, {"Halation": "1.0", "node type a": "00"}) == ""
    assert find_version_fault(ours, {"Halation": "1.0", "node type a": "11"}) == (
        "it has node type a 00, and the job was sent by 11"
    )
    assert find_version_fault(ours, {"the plug-in q": "3"}) == "it has no plug-in q, which the job needs (3)"


def test_parts_of_which_nothing_is_known_are_missing() -> None:
    report = CampaignReport(seconds={1: 0.0, 4: 1.0}, faults={2: {"message": "no"}})
    assert report.list_missing((4, 3, 2, 1, 7)) == (3, 7)
