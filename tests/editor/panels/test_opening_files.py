"""What Enter does in the browser of files: folders are entered, files are handed over, none is replaced unasked."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from halation.editor.browser import browser
from halation.editor.browser.browser import FileBrowser


class Opened:
    """A browser of a folder with a file and a folder in it."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, folder: Path, *, saving: bool = False) -> None:
        (folder / "inner").mkdir()
        (folder / "a.json").write_text("{}")
        self.given, self.entered, self.noted = list[Path](), list[Path](), list[tuple[str, Path]]()
        self.dialogs = SimpleNamespace(question=None, browse=object())
        context: Any = SimpleNamespace(
            dialogs=self.dialogs, log=SimpleNamespace(attempt=lambda act: act()),
            store=SimpleNamespace(note_folder=lambda purpose, path: self.noted.append((purpose, path))),
        )  # fmt: skip
        monkeypatch.setattr(browser, "find_own_folder", lambda context: folder)
        self.browser: Any = SimpleNamespace(
            _context=context, _memory={}, _go_to=lambda browsing, place: self.entered.append(place)
        )
        self.browser._answer = lambda *words: FileBrowser._answer(self.browser, *words)  # pyright: ignore
        browse = SimpleNamespace(saving=saving, purpose="graph", then=self.given.append)
        self.browsing: Any = SimpleNamespace(
            typed_folder=None, typed_file=None, item=None, target=None, folder=folder, browse=browse,
            listing=SimpleNamespace(folder=folder),
        )  # fmt: skip

    def open(self, **facts: Any) -> None:
        vars(self.browsing).update(facts)
        FileBrowser._open_chosen(self.browser, self.browsing)  # pyright: ignore[reportPrivateUsage]


def test_folders_are_entered(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    opened = Opened(monkeypatch, tmp_path)
    opened.open(typed_folder=Path("/"), target=tmp_path / "a.json")
    opened.open(typed_folder=None, item=SimpleNamespace(is_folder=True, name="inner"))
    assert opened.entered == [Path("/"), tmp_path / "inner"] and not opened.given
    opened.open(item=None, target=None)
    assert opened.dialogs.browse is not None and not opened.given, "nothing is chosen"


def test_a_file_is_handed_over_and_its_folder_remembered(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    opened = Opened(monkeypatch, tmp_path)
    opened.dialogs.question = object()
    opened.open(target=tmp_path / "a.json", item=SimpleNamespace(is_folder=False, name="a.json"))
    assert not opened.given, "a question is open"
    opened.dialogs.question = None
    opened.open(typed_file=Path("inner/b.json"))
    assert opened.given == [tmp_path / "inner" / "b.json"] and opened.noted == [
        ("graph", tmp_path / "inner" / "b.json")
    ]
    assert opened.browser._memory == {(tmp_path, "graph"): tmp_path / "inner"} and opened.dialogs.browse is None


@pytest.mark.parametrize(("name", "is_asked"), [("a.json", True), ("new.json", False), ("x\0.json", False)])
def test_a_file_is_replaced_only_where_the_user_says_so(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, name: str, is_asked: bool
) -> None:
    opened = Opened(monkeypatch, tmp_path, saving=True)
    opened.open(target=tmp_path / name)
    assert bool(opened.given) is not is_asked and (opened.dialogs.question is not None) is is_asked
    if is_asked:
        (first, replace), (last, cancel) = opened.dialogs.question.answers
        assert (first, last) == ("Replace", "Cancel") and name in opened.dialogs.question.sentence
        cancel()
        assert not opened.given
        replace()
        assert opened.given == [tmp_path / name]
