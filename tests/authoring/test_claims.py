"""Editors see which documents others have open, as long as these run; locks are those of the system."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from types import SimpleNamespace

import pytest
from halation.authoring.recovery import claims
from halation.authoring.recovery.claims import LOOK_AGAIN, DocumentClaim
from halation.authoring.recovery.file_locks import hold_lock, is_held


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """A clock that goes on when a test says so."""
    clock = SimpleNamespace(now=1000.0, monotonic=lambda: clock.now)
    monkeypatch.setattr(claims, "time", clock)
    return clock


def test_a_lock_is_held_until_it_is_given_back(tmp_path: Path) -> None:
    path = tmp_path / "a.lock"
    assert not is_held(path)
    with hold_lock(path):
        assert path.is_file() and is_held(path)
    assert not is_held(path)


def test_a_document_is_shared_while_another_editor_that_runs_has_it_open(
    tmp_path: Path, clock: SimpleNamespace
) -> None:
    first, second = (DocumentClaim(tmp_path / f"{name}.json") for name in ("first", "second"))
    graph, other = tmp_path / "graph.json", tmp_path / "other.json"
    with ExitStack() as running:
        running.enter_context(hold_lock(tmp_path / "first.lock"))
        running.enter_context(hold_lock(tmp_path / "second.lock"))
        assert not first.is_shared()
        first.set_path(graph)
        assert not first.is_shared() and (tmp_path / "first.open").read_text() == str(graph)
        second.set_path(other)
        assert not second.is_shared()
        second.set_path(tmp_path / "folder" / ".." / "graph.json")
        assert second.is_shared(), "the same file by another way"
        assert not first.is_shared(), "it has looked just before"
        clock.now += LOOK_AGAIN
        assert first.is_shared()
        second.set_path(None)
        assert not second.is_shared() and not (tmp_path / "second.open").exists()
        clock.now += LOOK_AGAIN
        assert not first.is_shared()
        second.set_path(graph)
        clock.now += LOOK_AGAIN
        assert first.is_shared()
    clock.now += LOOK_AGAIN
    assert not first.is_shared(), "the other one has ended, and left its claim"
    first.close()
    assert not (tmp_path / "first.open").exists() and (tmp_path / "second.open").is_file()


def test_a_folder_that_cannot_be_written_shares_nothing(tmp_path: Path, clock: SimpleNamespace) -> None:
    claim = DocumentClaim(tmp_path / "gone" / "a.json")
    claim.set_path(tmp_path / "graph.json")
    assert not claim.is_shared()
    claim.close()
