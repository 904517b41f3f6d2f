"""Where the card of a tutorial lies, and the frame around the widget that it speaks of."""

from __future__ import annotations

import pytest
from halation.editor.shared.window_commands import PanelTitle
from halation.editor.tutorials.coach import fit_frame, place_card

Rect = tuple[float, float, float, float]

AREA, SIZE, WIDGET = (0.0, 0.0, 1000.0, 800.0), (320.0, 120.0), (400.0, 300.0, 500.0, 340.0)
"""The card is 14 away from its widget and at least 10 from the border."""

PLACES = (
    ((400.0, 354.0), (690.0, 460.0)),
    ((400.0, 166.0), (690.0, 170.0)),
    ((180.0, 354.0), (190.0, 460.0)),
    ((180.0, 166.0), (190.0, 170.0)),
    ((514.0, 300.0), (820.0, 310.0)),
    ((66.0, 300.0), (70.0, 310.0)),
)
"""Below and above, from where the widget begins and up to where it ends, then right and left: the order in which places
are tried, with a corner of each that no other one of them covers."""


def make_note(at: tuple[float, float]) -> Rect:
    return (at[0], at[1], at[0] + 10.0, at[1] + 10.0)


@pytest.mark.parametrize("taken", range(len(PLACES)))
def test_the_first_place_that_hides_no_note_is_taken(taken: int) -> None:
    notes = [make_note(corner) for _, corner in PLACES[:taken]]
    assert place_card(WIDGET, SIZE, AREA, 1.0, notes) == PLACES[taken][0]
    assert place_card(WIDGET, SIZE, AREA, 1.0, (), notes) == PLACES[taken][0]


def test_notes_count_more_than_nodes_and_larger_parts_more_than_smaller_ones() -> None:
    below, above = (700.0, 354.0, 900.0, 374.0), (690.0, 170.0, 800.0, 200.0)
    everything = [(0.0, 0.0, 1000.0, 800.0)]
    assert place_card(WIDGET, SIZE, AREA, 1.0, everything, [below]) == (400.0, 166.0)
    assert place_card(WIDGET, SIZE, AREA, 1.0, [below], [above]) == (180.0, 354.0), "neither is hidden"
    several = [make_note(corner) for _, corner in PLACES[1:]] + [(690.0, 460.0, 695.0, 465.0)]
    several += [make_note(at) for at in ((830.0 - 5.0, 460.0), (825.0, 170.0), (70.0, 460.0), (70.0, 170.0))]
    assert place_card(WIDGET, SIZE, AREA, 1.0, several) == (400.0, 354.0), "it hides a quarter of what others hide"


def test_a_card_without_a_widget_lies_in_the_corner() -> None:
    assert place_card(None, SIZE, AREA, 1.0) == (670.0, 670.0)
    assert place_card(None, SIZE, (100.0, 50.0, 1000.0, 800.0), 2.0) == (660.0, 660.0)


def test_at_the_border_it_stays_inside() -> None:
    assert place_card((900.0, 10.0, 990.0, 30.0), SIZE, AREA, 1.0) == (670.0, 44.0)
    assert place_card((10.0, 770.0, 60.0, 790.0), SIZE, AREA, 1.0) == (10.0, 636.0)
    assert place_card((0.0, 0.0, 60.0, 30.0), SIZE, AREA, 2.0) == (20.0, 58.0)


def test_in_a_widget_as_large_as_the_window_it_lies_inside_at_its_right() -> None:
    assert place_card(AREA, SIZE, AREA, 1.0) == (670.0, 20.0)
    assert place_card((0.0, 0.0, 400.0, 800.0), SIZE, (0.0, 0.0, 400.0, 800.0), 1.0) == (70.0, 20.0)


def test_a_frame_stays_in_the_panel_of_its_widget() -> None:
    graph, viewer = (0.0, 0.0, 500.0, 400.0), (500.0, 0.0, 1000.0, 400.0)
    panels = {PanelTitle.GRAPH: graph, PanelTitle.VIEWER: viewer, "node a": (1.0, 1.0, 2.0, 2.0)}
    assert fit_frame((100.0, 100.0, 150.0, 120.0), panels, 4.0) == (96.0, 96.0, 154.0, 124.0)
    assert fit_frame((2.0, 3.0, 498.0, 398.0), panels, 4.0) == graph
    assert fit_frame((502.0, 100.0, 600.0, 120.0), panels, 4.0) == (500.0, 96.0, 604.0, 124.0)
    assert fit_frame((100.0, 390.0, 150.0, 450.0), panels, 4.0) is None, "its middle is scrolled away"
    assert fit_frame((100.0, 500.0, 150.0, 520.0), panels, 4.0) == (96.0, 496.0, 154.0, 524.0), "it is in no panel"
    assert fit_frame((100.0, 500.0, 150.0, 520.0), {}, 4.0) == (96.0, 496.0, 154.0, 524.0)
