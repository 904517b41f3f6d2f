"""While values are looked for that make a picture like another, the document has the best so far, as one step."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest
from halation import document
from halation.authoring.background.graph_fit import FitOutcome, FitStep, FittedNumberReport
from halation.authoring.session import Session
from halation.editor.matching import search as searching
from halation.editor.matching.search import MatchSearch
from halation.graph import Port
from halation.resources.sandbox import UNRESTRICTED
from imgui_bundle import imgui
from still_acts import make_graph
from still_editor import open_still_editor


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


def test_numbers_that_the_reference_says_little_about_are_dim_and_say_so(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    values = FittedNumberReport("bloom.intensity", 0.25, 0.5, True), FittedNumberReport("bloom.tint", 1.0, 2.0, False)
    fit = SimpleNamespace(outcome=FitOutcome(values=values, renders=3), step=None, stop=bool, wait=bool)
    monkeypatch.setattr(searching, "GraphFit", lambda *_: fit)
    colors, tips = dict[str, tuple[float, ...]](), list[str]()
    monkeypatch.setattr(imgui, "set_item_tooltip", tips.append)
    write = imgui.text_colored

    def write_down(color: tuple[float, ...], text: str) -> None:
        colors[text] = color
        write(color, text)

    monkeypatch.setattr(imgui, "text_colored", write_down)
    with open_still_editor(tmp_path, make_graph()) as still:
        still.editor.dialogs.matches = True
        still.show("Match", 2)
        window: Any = still.find("Match")
        window._search.start(cast("Any", None))
        tips.clear()
        still.show("Match", 1)
        window._search.end()
        palette = still.editor.interface.palette
    assert {colors[text] for text in ("bloom.intensity", "0.25", "0.5")} == {(*palette.text, 1.0)}
    assert {colors[text] for text in ("bloom.tint", "1", "2")} == {(*palette.dim, 1.0)}
    assert tips == ["The reference says little about this number."]
