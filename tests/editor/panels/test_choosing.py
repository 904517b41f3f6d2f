"""The file browser and the form for renders, without a window."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from halation.authoring.preferences import PreferenceStore
from halation.authoring.render_queue.queue import RenderJob, RenderQueue
from halation.authoring.session import Session
from halation.editor.browser.browsing import Browsing, begin_browsing, size_text
from halation.editor.browser.places import complete_name
from halation.editor.renders.folders import command, show_folder
from halation.editor.renders.form import RenderForm
from halation.editor.renders.wording import title
from halation.editor.shared.dialogs import Browse
from halation.editor.timeline.state import TimelineState
from halation.errors import UsageError
from halation.presets import paths
from halation.resources.sandbox import UNRESTRICTED

PRESET = next(path for path in paths() if path.stem == "soft_bloom")


@dataclass
class Desk:
    """As much of an editor as these need."""

    store: PreferenceStore
    session: Session = field(default_factory=lambda: Session(sandbox=UNRESTRICTED))
    exports: RenderQueue = field(default_factory=lambda: RenderQueue(sandbox=UNRESTRICTED))
    timeline: TimelineState = field(default_factory=TimelineState)


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    return Desk(PreferenceStore(tmp_path / "state"))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "work"
    (made / "inner").mkdir(parents=True)
    for name in ("a.json", "b.json", "notes.txt", "picture.EXR"):
        (made / name).write_text("{}")
    return made


def browsing(desk: Desk, **options: Any) -> Browsing:
    made = begin_browsing(desk, Browse("Choose", options.pop("purpose", "graph"), print, **options))
    made.listing.wait()
    return made


def names(now: Browsing) -> list[str]:
    now.listing.wait()
    return [item.name for item in now.items]


def test_it_lists_what_is_wanted_where_it_was_last(desk: Desk, folder: Path) -> None:
    desk.store.note_folder("graph", folder / "a.json")
    desk.store.note_folder("image", folder / "x.exr")
    assert names(browsing(desk)) == ["inner", "a.json", "b.json"]
    assert names(browsing(desk, purpose="image")) == ["inner", "picture.EXR"]
    assert names(browsing(desk, purpose="export", name="a.png")) != names(browsing(desk))


def test_opening_and_going_back(desk: Desk, folder: Path) -> None:
    desk.store.note_folder("graph", folder / "a.json")
    now = browsing(desk)
    now.poll()
    assert now.item is not None and now.item.is_folder
    assert now.target is None
    now.go(folder / "inner")
    assert names(now) == []
    now.up()
    while now.listing.busy:
        now.poll()
    assert now.item is not None and now.item.name == "inner"
    now.search("b")
    assert now.target == folder / "b.json"


def test_saving_takes_the_name_and_adds_the_ending(desk: Desk, folder: Path) -> None:
    desk.store.note_folder("graph", folder / "a.json")
    now = browsing(desk, saving=True, name="look.json")
    assert now.item is None
    assert now.target == folder / "look.json"
    now.name = "other"
    assert now.target == folder / "other.json"
    now.choose(1)
    assert (now.name, now.target) == ("a.json", folder / "a.json")
    now.name = " "
    assert now.target is None


@pytest.mark.parametrize(
    ("size", "said"), [(0, "0 B"), (999, "999 B"), (1500, "1.5 kB"), (999_600, "1 MB"), (4_710_000, "4.71 MB")]
)
def test_sizes(size: int, said: str) -> None:
    assert size_text(size) == said


def test_the_form_suggests_files_and_gives_options(desk: Desk, tmp_path: Path) -> None:
    desk.session.files.open(PRESET)
    desk.store.note_folder("export", tmp_path / "x.exr")
    form = RenderForm(desk)
    assert form.list_chosen_outputs() == ("image",)
    assert form.file("image") == tmp_path / "soft_bloom.exr"
    form.files["image"] = str(tmp_path / "mine.exr")
    form.reform(".png")
    assert form.file("image") == tmp_path / "mine.png"
    assert form.options() == RenderJob(sandbox=UNRESTRICTED, frames=(1,))
    form.sizing, form.scale, form.precision, form.view = "scale", 0.25, "float", "none"
    assert form.options() == RenderJob(sandbox=UNRESTRICTED, scale=0.25, frames=(1,), precision="float", view="none")
    form.sizing, form.size = "size", (64, 32)
    assert form.options() == RenderJob(sandbox=UNRESTRICTED, size=(64, 32), frames=(1,), precision="float", view="none")


def test_nothing_chosen_is_refused_with_a_sentence(desk: Desk) -> None:
    desk.session.files.open(PRESET)
    form = RenderForm(desk, chosen={"image": False})
    with pytest.raises(UsageError, match="no file to write to"):
        form.start()


def test_a_render_is_started_and_its_folder_remembered(desk: Desk, tmp_path: Path) -> None:
    desk.session.files.open(PRESET)
    form = RenderForm(desk, sizing="scale", scale=0.1, format=".png")
    form.files["image"] = str(tmp_path / "small.png")
    made = form.start()
    assert title(made) == "small.png"
    assert made.wait(60)
    assert (made.state, made.failure) == ("done", "")
    assert (tmp_path / "small.png").is_file()
    assert desk.store.folder("export") == str(tmp_path)


def test_folders_are_shown_by_the_system_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shutil.which", lambda name: f"/bin/{name}")
    monkeypatch.setenv("DISPLAY", ":0")
    for system, program in (("linux", "xdg-open"), ("darwin", "open"), ("win32", "explorer")):
        monkeypatch.setattr("sys.platform", system)
        assert command(tmp_path) == [f"/bin/{program}", str(tmp_path)]
    monkeypatch.setattr("shutil.which", lambda name: None)
    assert command(tmp_path) is None
    assert not show_folder(tmp_path)


@pytest.mark.parametrize(
    "typed", ["", " ", "/", "~", "~/", ".", "..", "inner/", "./", "inner/..", '"/"', "//", "a" * 5000]
)
def test_every_prefix_of_a_typed_path_is_a_folder_or_a_file(desk: Desk, folder: Path, typed: str) -> None:
    desk.store.note_folder("graph", folder / "a.json")
    now = browsing(desk, saving=True, name="look.json")
    for length in range(min(len(typed), 20) + 1):
        now.name = typed[:length]
        assert now.target is None or now.target.suffix == ".json"
        assert now.target is None or now.target.name.strip(".")
    now.name = typed
    assert (now.target is None) == (len(typed) < 5000)


def test_a_typed_path_is_taken_as_a_path(desk: Desk, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(folder))
    desk.store.note_folder("graph", folder / "a.json")
    now = browsing(desk, saving=True, name="look.json")
    for typed, target in (
        (f"{folder}/inner/mine", folder / "inner" / "mine.json"),
        ("inner/mine.json", folder / "inner" / "mine.json"),
        ("~/mine.json", folder / "mine.json"),
        ("../mine.json", folder.parent / "mine.json"),
        (f'"{folder}/my look.json"', folder / "my look.json"),
    ):
        now.name = typed
        assert (now.target, now.typed_folder) == (target, None)
    for typed, shown in (
        ("/", Path("/")),
        ("..", folder.parent),
        ("inner", folder / "inner"),
        ("inner/", folder / "inner"),
    ):
        now.name = typed
        assert now.typed_folder == shown
    now.go(folder / "inner")
    assert now.name == "look.json"


def test_a_path_that_is_typed_shows_what_its_folder_has(desk: Desk, folder: Path) -> None:
    (folder / "inner" / "look.json").write_text("{}")
    now = browsing(desk)
    for typed, listed in (
        (f"{folder}/", ["inner", "a.json", "b.json"]),
        (f"{folder}/IN", ["inner"]),
        (f"{folder}/inner/", ["look.json"]),
        (f"{folder}/inner/lo", ["look.json"]),
        (f"{folder}/inner/x", []),
    ):
        now.search(typed)
        assert names(now) == listed
    now.search(f"{folder}/inner/lo")
    names(now)
    assert now.target == folder / "inner" / "look.json"
    before = now.folder
    now.search("")  # the folder of the dialog again
    now.listing.wait()
    assert now.listing.folder == now.folder == before
    now = browsing(desk, saving=True, name="mine.json")
    now.rename(f"{folder}/inner/")
    assert names(now) == ["look.json"]
    now.choose(0)
    assert now.target == folder / "inner" / "look.json"


def test_opening_takes_a_typed_path_too(desk: Desk, folder: Path) -> None:
    now = browsing(desk)
    for typed, file, shown in (
        (f"{folder}/b.json", folder / "b.json", None),
        (f"{folder}", None, folder),
        (f"{folder}/", None, folder),
        ("b.json", None, None),
        (f"{folder}/missing.json", None, None),
    ):
        now.search(typed)
        assert (now.typed_file, now.typed_folder) == (file, shown)


def test_it_starts_where_the_document_is(desk: Desk, folder: Path, tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    for purpose in ("graph", "image"):
        desk.store.note_folder(purpose, tmp_path / "elsewhere" / "x")
        assert begin_browsing(desk, Browse("Choose", purpose, print)).folder == tmp_path / "elsewhere"
    desk.session.path = folder / "a.json"
    for purpose in ("graph", "image"):
        assert begin_browsing(desk, Browse("Choose", purpose, print)).folder == folder
    memory = {(folder, "image"): folder / "inner"}
    assert begin_browsing(desk, Browse("Choose", "image", print), memory).folder == folder / "inner"
    assert begin_browsing(desk, Browse("Choose", "graph", print), memory).folder == folder


@pytest.mark.parametrize(("started", "shown"), [("inner", "inner"), ("/", "~")])
def test_only_the_first_document_starts_where_the_editor_was_started(
    desk: Desk, folder: Path, monkeypatch: pytest.MonkeyPatch, started: str, shown: str
) -> None:
    """A menu of the system starts programs at the root of all files, which is nowhere in particular."""
    monkeypatch.chdir(folder / started)
    assert begin_browsing(desk, Browse("Choose", "graph", print)).folder == (
        folder / shown if shown != "~" else Path.home()
    )
    desk.store.note_opened(folder / "a.json")
    assert begin_browsing(desk, Browse("Choose", "graph", print)).folder == folder


def test_graphs_and_pictures_are_offered_to_open(desk: Desk, folder: Path) -> None:
    desk.session.path = folder / "a.json"
    assert names(browsing(desk, has_pictures=True)) == ["inner", "a.json", "b.json", "picture.EXR"]


@pytest.mark.parametrize(
    ("typed", "completed"),
    [
        ("inn", "inner/"),
        ("in", "inner/"),
        ("pic", "picture.EXR"),
        ("PIC", "picture.EXR"),
        ("inner/sh", "inner/shot_"),
        ("inner/shot_a", "inner/shot_a.exr"),
        ("./inner/shot_b", "./inner/shot_b.exr"),
        ("inner/.h", "inner/.hidden.exr"),
        ("nothing", "nothing"),
        ("missing/a", "missing/a"),
        ("inner", "inner/"),
        ("", ""),
    ],
)
@pytest.mark.skipif(os.sep != "/", reason="POSIX paths")
def test_tab_completes_a_path(folder: Path, typed: str, completed: str) -> None:
    for name in ("shot_a.exr", "shot_b.exr", ".hidden.exr", "shot.txt"):
        (folder / "inner" / name).write_text("")
    assert complete_name(typed, folder, {".json", ".exr"}) == completed
    if typed:
        assert complete_name(f"{folder}/{typed}", Path("/"), {".json", ".exr"}) == f"{folder}/{completed}"
