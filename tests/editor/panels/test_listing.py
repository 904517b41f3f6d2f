"""Folders as lists: read in a thread, sorted, filtered."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from halation.editor.browser.listing import Item, Listing, arrange_items, make_folder, read_folder
from halation.editor.browser.places import complete_path, drives, places
from halation.errors import InputError


def item(name: str, is_folder: bool = False, size: int = 0, time: float = 0.0) -> Item:
    return Item(name, is_folder, size, time, name.startswith("."))


ITEMS = (
    item("b10.exr", size=1, time=3.0),
    item("b9.exr", size=5, time=1.0),
    item("A.json", size=3, time=2.0),
    item(".hidden.exr"),
    item("zoo", True),
    item("Attic", True),
)


def names(**options: object) -> list[str]:
    return [one.name for one in arrange_items(ITEMS, options.pop("endings", frozenset()), **options)]


def test_folders_first_and_numbers_in_order() -> None:
    assert names() == ["Attic", "zoo", "A.json", "b9.exr", "b10.exr"]
    assert names(down=True) == ["zoo", "Attic", "b10.exr", "b9.exr", "A.json"]
    assert names(order="size")[2:] == ["b10.exr", "A.json", "b9.exr"]
    assert names(order="time")[2:] == ["b9.exr", "A.json", "b10.exr"]


def test_filters() -> None:
    assert names(endings=frozenset({".exr"})) == ["Attic", "zoo", "b9.exr", "b10.exr"]
    assert ".hidden.exr" in names(hidden=True)
    assert names(query="b1") == ["b10.exr"]


def test_reading_a_folder(tmp_path: Path) -> None:
    (tmp_path / "inner").mkdir()
    (tmp_path / "a.json").write_text("12345")
    (tmp_path / "gone").symlink_to(tmp_path / "nowhere")
    found = {one.name: one for one in read_folder(tmp_path)}
    assert found.keys() == {"inner", "a.json"}
    assert found["inner"].is_folder
    assert found["a.json"].size == 5


def test_what_cannot_be_read_is_a_sentence(tmp_path: Path) -> None:
    listing = Listing()
    listing.show(tmp_path / "nowhere")
    listing.wait()
    assert listing.fault.endswith("there is no such folder")
    file = tmp_path / "file"
    file.write_text("")
    listing.show(file)
    listing.wait()
    assert listing.fault.endswith("this is a file, not a folder")
    assert listing.items == ()
    listing.show(tmp_path)
    listing.wait()
    assert not listing.fault
    assert len(listing.items) == 1


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="the superuser may read everything")
def test_permissions(tmp_path: Path) -> None:
    closed = tmp_path / "closed"
    closed.mkdir(mode=0)
    with pytest.raises(InputError, match="permission denied"):
        read_folder(closed)


def test_a_new_folder(tmp_path: Path) -> None:
    assert make_folder(tmp_path, " new ").is_dir()
    with pytest.raises(InputError, match="of this name already exists"):
        make_folder(tmp_path, "new")
    for wrong in ("", "..", "a/b", "a:b"):
        with pytest.raises(InputError, match="not a valid name"):
            make_folder(tmp_path, wrong)


def test_ten_thousand_files_are_arranged_once(tmp_path: Path) -> None:
    listing = Listing()
    listing.items = tuple(item(f"shot{index}.exr", time=float(-index)) for index in range(10_000))
    first = listing.arrange(frozenset({".exr"}), "", "name", False, False)
    assert [one.name for one in first[:2]] == ["shot0.exr", "shot1.exr"]
    assert listing.arrange(frozenset({".exr"}), "", "name", False, False) is first
    assert listing.arrange(frozenset({".exr"}), "", "time", False, False)[0].name == "shot9999.exr"
    listing.items = ()
    assert listing.arrange(frozenset({".exr"}), "", "time", False, False) == ()


def test_places(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / "Pictures").mkdir()
    shots = tmp_path / "shots"
    shots.mkdir()
    found = places(shots, [shots, tmp_path / "gone"], [tmp_path])
    assert [(one.title, one.kind) for one in found if one.kind != "drive"] == [
        ("This document", "document"),
        ("Home", "home"),
        ("Pictures", "folder"),
    ]
    assert [one.kind for one in found][-1] == "drive"


def test_recent_folders_of_one_name_are_told_apart(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    folders = [tmp_path / "monday" / "comp", tmp_path / "friday" / "comp", tmp_path / "plates"]
    for folder in folders:
        folder.mkdir(parents=True)
    titles = [one.title for one in places(None, folders, []) if one.kind == "recent"]
    assert titles == ["comp (monday)", "comp (friday)", "plates"]


def test_drives(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.platform", "linux")
    table = tmp_path / "mounts"
    table.write_text("/dev/sda1 / ext4 rw 0 0\nproc /proc proc rw 0 0\n/dev/sdb1 /media/a\\040disk vfat rw 0 0\n")
    assert drives(table) == (Path("/"), Path("/media/a disk"))
    assert drives(tmp_path / "none") == (Path("/"),)


def test_typed_paths(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    assert complete_path("~/a", Path("/b")) == tmp_path / "a"
    assert complete_path("../c", tmp_path / "b") == tmp_path / "c"
    assert complete_path(f'"{tmp_path}"', Path("/b")) == tmp_path
    assert complete_path("", tmp_path) == tmp_path
