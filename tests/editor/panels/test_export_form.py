"""What the form for renders makes of what is chosen: frames, names, and what would be written."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import pytest
from halation.authoring.commands import ReplaceGraph, SetFrameRange
from halation.authoring.preferences import PreferenceStore
from halation.authoring.render_queue.queue import RenderQueue
from halation.authoring.session import Session
from halation.editor.renders.form import RenderForm
from halation.editor.renders.wording import aim_text, exist_text, time_text
from halation.editor.timeline.state import TimelineState
from halation.errors import UsageError
from halation.graph import Output, Port
from halation.nodes import Kind
from halation.presets import paths
from halation.resources.sandbox import UNRESTRICTED

PRESET = next(path for path in paths() if path.stem == "soft_bloom")


@dataclass
class Desk:
    """As much of an editor as the form needs."""

    store: PreferenceStore
    session: Session = field(default_factory=lambda: Session(sandbox=UNRESTRICTED))
    exports: RenderQueue = field(default_factory=lambda: RenderQueue(sandbox=UNRESTRICTED))
    timeline: TimelineState = field(default_factory=TimelineState)


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    """A preset of 24 frames, whose renders go to a folder of their own."""
    made = Desk(PreferenceStore(tmp_path / "state"))
    made.session.files.open(PRESET)
    made.session.apply(SetFrameRange(1, 24))
    (tmp_path / "out").mkdir()
    made.store.note_folder("export", tmp_path / "out" / "x.exr")
    return made


def test_all_frames_are_offered_where_there_are_several(desk: Desk, tmp_path: Path) -> None:
    form = RenderForm(desk)
    assert list(form.extents()) == ["this frame", "all frames", "listed frames", "many files"]
    assert (form.extent_of(), form.frames()) == ("all frames", tuple(range(1, 25)))
    assert form.file("image") == tmp_path / "out" / "soft_bloom.####.exr"
    aim = form.targets(0.0)
    assert (aim.files, aim.exist, aim.fault) == (24, 0, "")
    assert aim_text(aim) == "Writes 24 files: soft_bloom.0001.exr \u2026 soft_bloom.0024.exr"
    desk.session.time.seek(7)
    form.extend("this frame")
    assert form.frames() == (7,)
    assert aim_text(form.targets(0.0)) == "Writes soft_bloom.exr"
    desk.session.apply(SetFrameRange(None))
    assert list(RenderForm(desk).extents()) == ["this frame", "listed frames", "many files"]
    assert RenderForm(desk).extent_of() == "this frame"


def test_the_part_that_is_played_is_one_more_choice(desk: Desk) -> None:
    form = RenderForm(desk)
    desk.timeline.set_part(desk.session, 5, 9)
    form.extend("playback range")
    assert form.frames() == (5, 6, 7, 8, 9)
    desk.timeline.part = None
    assert form.extent_of() == "all frames"


def test_typed_frames_are_checked(desk: Desk) -> None:
    form = RenderForm(desk)
    form.extend("listed frames")
    assert (form.listed, form.list_fault) == ("1-24", "")
    form.listed = "1-24x2,40"
    assert form.frames() == (*range(1, 25, 2), 40)
    assert form.targets(0.0).last.endswith("soft_bloom.0040.exr")
    form.listed = "1-x"
    assert form.frames() == ()
    assert "is not a frame or a range" in form.targets(0.0).fault
    with pytest.raises(UsageError, match="is not a frame or a range"):
        form.start()
    assert desk.exports.all == ()


def test_names_get_a_place_for_the_number(desk: Desk, tmp_path: Path) -> None:
    form = RenderForm(desk, files={"image": str(tmp_path / "out" / "mine.png")}, extent="this frame")
    form.extend("all frames")
    assert form.file("image").name == "mine.####.png"
    form.files["image"] = str(tmp_path / "out" / "mine.png")
    assert "cannot go into one file" in form.targets(0.0).fault
    form.number()
    assert form.targets(0.0).fault == ""
    form.files["image"] = str(tmp_path / "out" / "mine.%03d.png")
    form.extend("listed frames")
    assert form.targets(0.0).first.endswith("mine.001.png")


def test_files_that_are_there_are_counted(desk: Desk, tmp_path: Path) -> None:
    form = RenderForm(desk)
    for frame in (1, 2, 3, 40):
        (tmp_path / "out" / f"soft_bloom.{frame:04d}.exr").touch()
    aim = form.targets(0.0)
    assert aim.exist == 3
    (tmp_path / "out" / "soft_bloom.0004.exr").touch()
    assert form.targets(0.9) is aim and form.targets(1.1).exist == 4, "the disk is asked once in a second"
    assert exist_text(aim, False) == "3 of them exist and will be replaced."
    assert exist_text(aim, True).startswith("3 of them exist. Those up to date are kept")
    form.chosen["image"] = False
    assert "Choose an output" in form.targets(0.0).fault


def test_options_hold_frames_processes_and_resume(desk: Desk) -> None:
    form = RenderForm(desk, jobs=4, resume=True, extent="listed frames", listed="3,5-6")
    options = form.options()
    assert (options.frames, options.processes, options.resume) == ((3, 5, 6), 4, True)
    form.listed = "3"
    assert form.options().processes == 1


@pytest.mark.parametrize(
    ("seconds", "said"), [(0.04, "0.0 s"), (9.9, "9.9 s"), (12.4, "12 s"), (185.0, "3:05"), (3750.0, "1:02:30")]
)
def test_lengths_of_time(seconds: float, said: str) -> None:
    assert time_text(seconds) == said


def test_files_are_told_apart_by_their_output_where_there_are_several(desk: Desk, tmp_path: Path) -> None:
    form, out = RenderForm(desk), tmp_path / "out"
    wanted = {"all frames": "soft_bloom{}.####.exr", "this frame": "soft_bloom{}.exr", "many files": "{{stem}}{}.exr"}
    for extent, name in wanted.items():
        form.extend(extent)
        assert form.suggest_file("image") == out / name.format("")
    graph = desk.session.root
    source = graph.links[Port("outputs", "image")]
    graph = graph.add_output("second", Output(Kind.IMAGE, 4)).connect(source, Port("outputs", "second"))
    desk.session.apply(ReplaceGraph("Add", graph))
    for extent, name in wanted.items():
        form.extend(extent)
        for output in ("image", "second"):
            assert form.suggest_file(output) == out / name.format(f"_{output}")
