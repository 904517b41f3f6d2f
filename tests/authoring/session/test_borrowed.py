"""What cannot be edited where the user is, because it belongs to another file."""

from __future__ import annotations

import pytest
from halation.authoring.edits import folding
from halation.authoring.session import Session
from halation.errors import GraphError
from halation.resources.sandbox import UNRESTRICTED


def test_the_innermost_group_and_its_file_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    session = Session(sandbox=UNRESTRICTED)
    session.check_editable()
    monkeypatch.setattr(folding, "find_borrowed_group", lambda root, place: (("outer", "inner"), "look.json"))
    assert session.borrowed == "look.json"
    with pytest.raises(GraphError, match=r"^group 'inner' comes from the file 'look\.json': make it local first"):
        session.check_editable()
