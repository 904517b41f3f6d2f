"""Arrow keys move points by whole pixels of the picture: as far as the table of actions says, whatever the zoom."""

from __future__ import annotations

from pathlib import Path

import pytest
from halation.graph import Port
from still_editor import StillEditor, open_still_editor
from still_pictures import make_graph

WAYS = {"left": (-1, 0), "right": (1, 0), "up": (0, -1), "down": (0, 1)}

ROW = 7
"""The numbers of a point: its place, its two handles and its feather."""


def list_points(still: StillEditor) -> list[tuple[float, float]]:
    """The places of the points of the first shape, in pixels."""
    numbers = still.editor.session.graph.value(Port("node", "shapes.shape_1.points"))
    image = still.editor.preview.find_whole_image("A")
    assert isinstance(numbers, tuple) and image is not None
    width, height = image.full_size
    places = zip(numbers[::ROW], numbers[1::ROW], strict=True)
    return [(x * width, y * height) for x, y in places]  # pyright: ignore[reportOperatorIssue]


@pytest.mark.parametrize("far", ["", "_far"])
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("zoom", [0.3, 2.0])
def test_points_go_by_pixels(tmp_path: Path, way: str, far: str, zoom: float) -> None:
    with open_still_editor(tmp_path, make_graph("roto"), size=(900.0, 700.0)) as still:
        still.select("node")
        still.editor.session.views.show(Port("node", "out"))
        still.show("Viewer", 2)
        still.compute()
        still.show("Viewer", 2)
        still.editor.viewer.zoom = zoom
        still.editor.actions.run("viewer.all_points")
        before = list_points(still)
        for _ in range(3):
            still.editor.actions.run(f"viewer.nudge_{way}{far}")
        after, by = list_points(still), 30.0 if far else 3.0
        assert len(after) == len(before) > 2
        for old, new in zip(before, after, strict=True):
            assert new == pytest.approx((old[0] + by * WAYS[way][0], old[1] + by * WAYS[way][1]), abs=0.02)
        still.editor.session.undo()
        assert list_points(still) == before, "presses in a row are one step"
