"""Slots of the display for frames that are played."""

from __future__ import annotations

from typing import Any

from halation.editor.viewer.played_pictures import SHARE, PlayedPictures


class _Slots:
    """A display that only notes what is given back."""

    def __init__(self) -> None:
        self.released: list[str] = []

    def release_slot(self, slot: str) -> None:
        self.released.append(slot)


def test_the_slots_of_a_loop_stay_within_the_budget_and_are_used_again() -> None:
    display: Any = _Slots()
    played, size = PlayedPictures(display), (100, 50)
    budget = int(3 * 4 * size[0] * size[1] / SHARE)
    slots = [played.choose_slot(frame, size, budget) for frame in range(3)]
    assert len(set(slots)) == 3
    assert [played.choose_slot(frame, size, budget) for frame in range(3)] == slots
    assert played.choose_slot(3, size, budget) == slots[0], "the one that was shown longest ago"
    assert played.choose_slot(0, size, budget) == slots[1]
    assert display.released == []


def test_a_larger_panel_has_fewer_slots_and_all_are_given_back() -> None:
    display: Any = _Slots()
    played = PlayedPictures(display)
    budget = int(6 * 4 * 100 * 50 / SHARE)
    slots = {played.choose_slot(frame, (100, 50), budget) for frame in range(6)}
    larger = {played.choose_slot((frame, "larger"), (200, 100), budget) for frame in range(6)}
    assert len(larger) == 1
    played.clear()
    assert set(display.released) == slots | larger
    assert played.choose_slot("next", (200, 100), 0) not in display.released, "even without any budget there is one"
