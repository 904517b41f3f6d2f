"""Flipbooks: which pictures they play, and when these must be read anew."""

from __future__ import annotations

from pathlib import Path

import pytest
from halation.authoring.flipbook import Flipbook, FlipbookStrip
from halation.authoring.render_queue.queued_render import QueuedJob, QueuedRender
from halation.errors import InputError
from halation.graph import OUTPUTS, Graph, Output, Port
from halation.renderer.jobs.render_job import RenderJob
from halation.resources.sandbox import UNRESTRICTED


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for frame in range(3, 9):
        (tmp_path / f"shot_v1.{frame:04d}.exr").touch()
    (tmp_path / "alone.png").touch()
    return tmp_path


def render(path: Path, frames: tuple[int, ...], view: str = "") -> QueuedRender:
    """A render that somebody else moves on."""
    graph = Graph().add_output("image", Output(view=view))
    return QueuedRender(
        QueuedJob(RenderJob(destinations=(("", str(path)),), frames=frames, sandbox=UNRESTRICTED), graph)
    )


def write(export: QueuedRender, *frames: int) -> None:
    path = str(export.destinations[0][1])
    export.written_files = (*export.written_files, *(Path(path.replace("####", f"{frame:04d}")) for frame in frames))


def test_a_file_stands_for_its_sequence(folder: Path) -> None:
    strip = FlipbookStrip.from_file(folder / "shot_v1.0005.exr", sandbox=UNRESTRICTED)
    assert (strip.path, strip.frames, strip.name) == (folder / "shot_v1.####.exr", (3, 8), "shot_v1.####.exr")
    assert FlipbookStrip.from_file(folder / "alone.png", sandbox=UNRESTRICTED) == FlipbookStrip(
        folder / "alone.png", (1, 1)
    )
    with pytest.raises(InputError, match="does not exist"):
        FlipbookStrip.from_file(folder / "gone.exr", sandbox=UNRESTRICTED)


def test_it_is_a_document_of_its_own(folder: Path) -> None:
    one, other = (
        FlipbookStrip.from_file(folder / "shot_v1.0005.exr", sandbox=UNRESTRICTED),
        FlipbookStrip(folder / "shot_v1.####.png", (1, 4), "AgX"),
    )
    session = Flipbook((one, other), 12.0, 40).session
    assert (session.time.frames, session.root.settings.rate, session.time.frame) == ((1, 8), 12.0, 8)
    assert session.views.find_port("A") == Port(OUTPUTS, "shot_v1")
    assert session.views.find_port("B") == Port(OUTPUTS, "shot_v12")
    assert session.graph.value(Port("flipbook: shot_v1", "path")) == str(one.path)
    assert {session.graph.value(Port(name, "missing")) for name in session.graph.nodes} == {"hold"}
    assert [output.view for output in session.root.outputs.values()] == ["", "none"]
    assert session.problems == {}


@pytest.mark.parametrize(
    ("name", "called"),
    [("inputs.####.exr", "inputs"), ("____.exr", "pictures"), ("####.exr", "pictures"), ("a.v2_%04d.png", "a_v2")],
)
def test_any_name_will_do(tmp_path: Path, name: str, called: str) -> None:
    session = Flipbook((FlipbookStrip(tmp_path / name, (1, 2)),), 24.0, 1).session
    assert session.views.find_port("A") == Port(OUTPUTS, called) and session.views.find_port("B") is None


def test_a_render_is_shown_as_its_output_asks(tmp_path: Path) -> None:
    strip = FlipbookStrip.from_render(render(tmp_path / "s.####.exr", (4, 2, 9), "none"))
    assert (strip.frames, strip.view) == ((2, 9), "none")


def test_only_what_was_seen_too_early_is_read_anew(tmp_path: Path) -> None:
    export = render(tmp_path / "s.####.exr", tuple(range(1, 9)))
    write(export, 1)
    book = Flipbook((FlipbookStrip.from_render(export),), 24.0, 1)
    assert not book.follow(())
    write(export, 2)
    assert not book.follow((1,))
    write(export, 3)
    assert book.follow((1, 3))
    assert not book.follow((1, 3))
    book.session.time.seek(5)
    write(export, 4, 5)
    assert book.follow(())
    export.ended_at = 1.0
    assert book.follow(())
    assert not book.follow(())
