"""Clicks in panels and dialogs do the same wherever they are and on an interface of twice the size.

What an act does is read off the document, the preferences and what is shown afterwards, and compared between two
windows: nothing here knows what it should be.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from still_acts import describe, list_clicked, open_prepared
from still_editor import is_alike


def act_on_all(folder: Path, title: str, dialog: str, scale: float, at: tuple[float, float]) -> dict[str, object]:
    """Click all that is shown, each in the same state."""
    for still in open_prepared(folder, title, dialog, scale, at):
        places = list_clicked(still, title)
    answers: dict[str, object] = {"": places}
    for place in places[:40]:
        for still in open_prepared(folder, title, dialog, scale, at):
            still.click(title, place, part=(0.3, 0.4))
            answers[place] = describe(still)
    return answers


@pytest.mark.parametrize(
    ("title", "dialog"),
    [("Viewer", ""), ("Log", ""), ("History", ""), ("Renders", ""), ("Animation", ""), ("Preferences", "preferences"),
     ("Export", "export"), ("Command palette", "palette"), ("Node", "node"),
     ("Timeline", ""), ("Shortcuts", "shortcuts"), ("About", "about"), ("Problems", "")],
)  # fmt: skip
def test_clicks_do_the_same_on_a_larger_interface(tmp_path: Path, title: str, dialog: str) -> None:
    small = act_on_all(tmp_path, title, dialog, 1.0, (20.0, 30.0))
    large = act_on_all(tmp_path, title, dialog, 2.0, (40.0, 60.0))
    assert small[""] == large[""] and len(small) > 1
    wrong = {}
    for place, one in small.items():
        other = large[place]
        if isinstance(one, dict) and isinstance(other, dict):
            wrong |= {
                f"{place}: {key}": (one[key], other.get(key)) for key in one if not is_alike(one[key], other.get(key))
            }
    assert not wrong, str(wrong)[:1500]
