"""While values are looked for that make a picture like another, the document has the best so far, as one step."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest
from halation import document
from halation.authoring.background.graph_fit import FitStep
from halation.authoring.session import Session
from halation.editor.matching import search as searching
from halation.editor.matching.search import MatchSearch
from halation.graph import Port
from halation.resources.sandbox import UNRESTRICTED
from still_acts import make_graph


def test_the_best_values_so_far_are_in_the_document(monkeypatch: pytest.MonkeyPatch) -> None:
    fit = SimpleNamespace(outcome=None, step=None, stop=bool, wait=bool)
    monkeypatch.setattr(searching, "GraphFit", lambda *_: fit)
    session = Session(sandbox=UNRESTRICTED)
    session.files.open_text(document.dumps(make_graph()))
    search, steps = MatchSearch(session), len(session.history.steps)
    search.start(cast("Any", None))
    search.follow()
    assert len(session.history.steps) == steps
    for intensity in (0.25, 0.5):
        fit.step = FitStep({"bloom.intensity": intensity}, 0.1, 3, 0.5)
        search.follow()
        assert session.graph.value(Port("bloom", "intensity")) == intensity
        assert len(session.history.steps) == steps + 1
    before = make_graph().value(Port("bloom", "intensity"))
    session.undo()
    search.follow()
    assert session.graph.value(Port("bloom", "intensity")) == before, "what was shown once is not shown again"
    search.end()
