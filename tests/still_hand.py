"""The mouse over the inspector of a still editor."""

from __future__ import annotations

from drawn_shapes import Point
from imgui_bundle import imgui
from still_editor import StillEditor


class Hand:
    """The mouse over the inspector, place by place."""

    def __init__(self, still: StillEditor) -> None:
        self._still, self._io = still, imgui.get_io()

    def move(self, at: Point) -> None:
        self._still.pane.point(at)
        self._still.show("Inspector", 2)

    def press(self, button: int = 0) -> None:
        self._io.add_mouse_button_event(button, True)
        self._still.show("Inspector", 1)

    def let_go(self, button: int = 0) -> None:
        self._io.add_mouse_button_event(button, False)
        self._still.show("Inspector", 2)

    def drag(self, *places: Point) -> None:
        self.move(places[0])
        self.press()
        for place in places[1:]:
            self.move(place)
        self.let_go()
