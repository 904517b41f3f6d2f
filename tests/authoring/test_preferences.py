"""Preferences: what is kept, what a damaged file costs, and two editors at once."""

from __future__ import annotations

import json

import pytest
from halation.authoring.preferences import Preferences, PreferenceStore, state_folder
from halation.errors import UsageError


@pytest.fixture
def file(tmp_path):
    return tmp_path / "state" / "preferences.json"


@pytest.fixture
def store(file):
    return lambda: PreferenceStore(file.parent)


def written(file, text):
    file.parent.mkdir()
    file.write_text(text if isinstance(text, str) else json.dumps(text))


def test_what_is_changed_is_there_the_next_time(store, file, tmp_path):
    first = store()
    assert first.current == Preferences() and not first.flush() and not file.exists()
    changes = {
        "theme": "light",
        "ui_scale": 1.5,
        "shortcuts": {"save": "Ctrl+K", "open": ""},
        "thumbnails": False,
        "timings": True,
        "minimap": False,
        "autosave": 10.0,
        "memory_budget": 2048,
        "hint_seen": True,
        "proxy_while_dragging": False,
    }
    first.change(**changes)
    first.note_folder("image", tmp_path / "picture.exr")
    assert first.flush() and not first.flush()
    again = store()
    assert {name: getattr(again.current, name) for name in changes} == changes
    assert again.folder("image") == str(tmp_path) and again.folder("export") == "" and again.faults == []


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("theme", "pink"),
        ("ui_scale", 0.5),
        ("ui_scale", float("nan")),
        ("autosave", 11.0),
        ("memory_budget", 1.5),
        ("minimap", 1),
        ("shortcuts", {"save": 3}),
        ("sound", True),
    ],
)
def test_a_value_that_makes_no_sense_is_refused(store, name, value):
    found = store()
    with pytest.raises(UsageError, match=f"preference '{name}'"):
        found.change(**{name: value})
    assert found.current == Preferences()


def test_broken_values_fall_back_one_by_one_and_unknown_ones_stay(store, file):
    recent = [{"path": "a.json", "time": 2.0}, {"path": 7}, {"path": "b.json", "time": 1.0}]
    written(
        file,
        {
            "theme": "pink",
            "minimap": False,
            "ui_scale": 9,
            "shortcuts": {"save": "Ctrl+K", "open": 4},
            "recent": recent,
            "sound": {"loud": 3},
        },
    )
    found = store()
    assert (found.current.theme, found.current.minimap, found.current.ui_scale) == ("dark", False, 0.0)
    assert found.current.shortcuts == {"save": "Ctrl+K"} and [one.path for one in found.current.recent] == [
        "a.json",
        "b.json",
    ]
    assert len(found.faults) == 4 and all(str(file) in fault for fault in found.faults)
    found.change(theme="light")
    assert found.flush()
    tree = json.loads(file.read_text())
    assert tree["sound"] == {"loud": 3} and tree["theme"] == "light" and tree["minimap"] is False
    assert store().faults == []


@pytest.mark.parametrize("text", ["", "{", "[1, 2]", '{"theme": "li', "\x00\xff", "[" * 100_000])
def test_a_damaged_file_is_set_aside(store, file, text):
    written(file, text)
    found = store()
    assert found.current == Preferences() and len(found.faults) == 1 and "preferences.broken.json" in found.faults[0]
    assert (file.parent / "preferences.broken.json").read_text() == text and not file.exists()
    found.change(theme="light")
    assert found.flush() and store().current.theme == "light"


def test_recent_files(store, tmp_path):
    found = store()
    names = [tmp_path / f"{number}.json" for number in range(25)]
    names[24].touch()
    for name in names:
        found.note_opened(name)
    found.note_opened(names[20])
    assert [one.path for one in found.current.recent[:3]] == [str(names[number]) for number in (20, 24, 23)]
    assert len(found.current.recent) == 20
    assert [one.exists for one in found.current.recent[:3]] == [False, True, False]
    found.forget(names[24])
    found.flush()
    assert str(names[24]) not in [one.path for one in store().current.recent]


def test_two_editors_keep_what_the_other_wrote(store):
    store().note_opened("a.json")
    one, two = store(), store()
    one.note_opened("/x/one.json")
    one.change(theme="light")
    two.note_opened("/x/two.json")
    two.change(minimap=False)
    one.flush()
    two.flush()
    found = store().current
    assert [recent.path for recent in found.recent] == ["/x/two.json", "/x/one.json"]
    assert (found.theme, found.minimap) == ("light", False)
    one.forget("/x/two.json")
    one.flush()
    assert [recent.path for recent in store().current.recent] == ["/x/one.json"]


def test_names_that_no_encoding_knows(store):
    found = store()
    found.note_opened("/x/caf\udce9.json")
    assert found.flush() and store().current.recent[0].path == "/x/caf\udce9.json"


def test_a_folder_that_cannot_be_is_a_sentence(tmp_path):
    (tmp_path / "state").write_text("a file, not a folder")
    found = PreferenceStore(tmp_path / "state")
    found.change(theme="light")
    assert not found.flush() and not found.flush()
    assert found.current.theme == "light" and 1 <= len(found.faults) <= 2
    (tmp_path / "state").unlink()
    assert found.flush() and PreferenceStore(tmp_path / "state").current.theme == "light"


def test_the_environment_names_the_folder(monkeypatch, tmp_path):
    monkeypatch.setenv("HALATION_STATE", str(tmp_path))
    assert state_folder() == tmp_path and PreferenceStore().file == tmp_path / "preferences.json"
    monkeypatch.delenv("HALATION_STATE")
    assert state_folder().name == "halation"
