"""What is under the pointer in the Animation panel: of several things at one place the first of a list counts."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from halation.editor.curves import mouse
from halation.editor.curves.mouse import CurvesMouse

RULER, BAR, BODY = (0.0, 0.0, 400.0, 20.0), (0.0, 20.0, 400.0, 40.0), 100.0
GRIPS = (100.0, 200.0, 8.0)
"""The bar goes from 100 to 200, and its grips are 8 wide."""


@pytest.fixture
def find(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The part at a place. The current frame is at 300, a key at 50 and a tip of a handle at 60, for those within 9."""

    def run(x: float, y: float = BODY, *, scale: float = 1.0, grips: Any = GRIPS, lane: Any = None) -> str:
        monkeypatch.setattr(mouse, "find_grips", lambda frame: grips)

        def near(place: float, reach: float) -> str | None:
            return "it" if abs(x - place * scale) <= reach else None

        monkeypatch.setattr(mouse, "find_nearest", lambda tips, x, y, reach: near(60.0, reach))
        asked: Any = SimpleNamespace(
            pointer=(x, y), scale=scale, ruler=RULER, bar=BAR, tips=(), find_mark=lambda x, y, reach: near(50.0, reach),
            plane=SimpleNamespace(x=lambda frame: 300.0 * scale), find_lane=lambda x, y, reach: lane,
            context=SimpleNamespace(session=SimpleNamespace(time=SimpleNamespace(frame=7))),
        )  # fmt: skip
        part: Any = SimpleNamespace(part="", tip=None, mark=None, lane=None)
        CurvesMouse._find_part(part, asked)  # pyright: ignore[reportPrivateUsage]
        return part.part

    return run


@pytest.mark.parametrize(
    ("x", "part"),
    [(97.9, ""), (98.1, "left"), (107.9, "left"), (108.1, "bar"), (191.9, "bar"), (192.1, "right"), (201.9, "right"),
     (202.1, "")],
)  # fmt: skip
def test_the_bar_has_grips_at_its_ends(find: Any, x: float, part: str) -> None:
    assert find(x, 30.0) == part and find(x, 30.0, grips=None) == ""


def test_the_ruler_lies_over_everything(find: Any) -> None:
    assert find(300.0, 10.0) == find(50.0, 10.0) == "ruler"


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_tips_come_before_keys_and_keys_before_the_current_frame(find: Any, scale: float) -> None:
    reach, near = mouse.REACH * scale, mouse._FRAME_REACH * scale  # pyright: ignore[reportPrivateUsage]
    assert find(60.0 * scale, scale=scale) == find(60.0 * scale - reach, scale=scale) == "tip"
    assert find(50.0 * scale - 1.0, scale=scale) in ("key", "tip") and find(50.0 * scale - reach, scale=scale) == "key"
    for sign in (1.0, -1.0):
        assert find(300.0 * scale + sign * near, scale=scale) == "now"
        assert find(300.0 * scale + sign * (near + 0.1), scale=scale) == "open"
    assert find(150.0 * scale, scale=scale, lane="gain") == "curve"
