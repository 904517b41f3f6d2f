"""The status line says what is computed, and how much memory it takes."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from halation.editor.shared.window_commands import PanelTitle
from halation.editor.window import hints, status

MEMORY = (300 * 2**20, 512 * 2**20 + 2**19)
"""300 and 512.5 MiB."""


def tell(nodes: int = 3, **changes: Any) -> list[str]:
    """The parts of the line."""
    facts: dict[str, Any] = {"memory": MEMORY, "progress": (4, 9), "paused": False, "busy": False, "lead": None}
    picture = changes.pop("picture", None)
    preview = SimpleNamespace(**(facts | changes), find_visible_image=lambda side: picture if side == "A" else None)
    graph = SimpleNamespace(nodes=dict.fromkeys(range(nodes)))
    editor: Any = SimpleNamespace(preview=preview, session=SimpleNamespace(graph=graph))
    return status._figures(editor).split("   ")  # pyright: ignore[reportPrivateUsage]


PART = SimpleNamespace(partial=True, texture=SimpleNamespace(size=(64, 36)))
WHOLE = SimpleNamespace(partial=False, texture=PART.texture)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, []), ({"busy": True}, ["pass 4 of 9"]), ({"lead": ("plan", 2, 5), "busy": True}, ["planning 2 of 5"]),
        ({"lead": ("pre-roll", 2, 5)}, ["pre-roll 2 of 5"]), ({"picture": PART, "busy": True}, ["region 64\u00d736"]),
        ({"picture": WHOLE, "busy": True}, ["pass 4 of 9"]), ({"picture": WHOLE}, []),
        ({"picture": PART, "lead": ("plan", 2, 5)}, ["planning 2 of 5"]),
    ],
)  # fmt: skip
def test_what_is_computed_comes_first(changes: dict[str, Any], words: list[str]) -> None:
    assert tell(**changes) == [*words, "3 nodes", "300 of 512 MiB"]


def test_a_pause_is_said_before_all_else() -> None:
    first, *rest = tell(paused=True, busy=True, lead=("plan", 2, 5), picture=PART)
    assert first.endswith(" paused") and rest == ["3 nodes", "300 of 512 MiB"]
    assert tell(1)[0] == "1 node" and tell(0)[0] == "0 nodes"


@pytest.fixture
def offered(monkeypatch: pytest.MonkeyPatch) -> Any:
    """An editor whose actions have shortcuts, but for the wipe, and nothing to pick or to add."""
    monkeypatch.setattr(hints, "picks", lambda context: None)
    monkeypatch.setattr(hints, "can_add", lambda context: False)
    keys = {"viewer.wipe": ""}
    return SimpleNamespace(
        viewer=SimpleNamespace(picking="", drawing_region=False, orbits=False), canvas=SimpleNamespace(tool=""),
        actions=SimpleNamespace(shortcut=lambda id: keys.get(id, "Ctrl+X")),
    )  # fmt: skip


def list_words(editor: Any, panel: str) -> list[str]:
    context: Any = None
    return [does for _, does in hints.list_hints(editor, context, panel)]


def test_hints_are_those_of_the_panel_and_its_tool(monkeypatch: pytest.MonkeyPatch, offered: Any) -> None:
    viewer = list_words(offered, PanelTitle.VIEWER)
    assert viewer[0] == "zoom" and "fit" in viewer and "wipe" not in viewer, "what has no keys is left out"
    monkeypatch.setattr(hints, "can_add", lambda context: True)
    assert list_words(offered, PanelTitle.VIEWER)[0] == "move a light"
    monkeypatch.setattr(hints, "picks", lambda context: object())
    assert list_words(offered, PanelTitle.VIEWER)[0] == "select or deselect an object"
    offered.viewer.orbits = True
    assert list_words(offered, PanelTitle.VIEWER)[0] == "orbit"
    offered.viewer.drawing_region = True
    assert list_words(offered, PanelTitle.VIEWER) == ["draw the region"]
    offered.viewer.picking = "grade.gain"
    assert list_words(offered, PanelTitle.VIEWER) == ["pick from the picture", "cancel"]
    assert list_words(offered, PanelTitle.GRAPH)[0] == "add a node", "the viewer's tool is none of the graph's"
    offered.canvas.tool = "cut"
    assert list_words(offered, PanelTitle.GRAPH) == ["across links", "cancel"]
    assert list_words(offered, PanelTitle.HISTORY) == ["go to a step"]
    assert list_words(offered, "") == ["find any command", "manual page", "all shortcuts"]
    assert hints.key_text(offered, "Wheel") == "Wheel" and hints.key_text(offered, "viewer.fit") != "viewer.fit"
