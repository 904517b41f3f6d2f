"""Numbers on rulers stand where they say: equally far apart for equal differences, and where keys of a frame are."""

from __future__ import annotations

import re
from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest
from halation.graph import Port
from still_acts import make_graph, prepare
from still_editor import open_still_editor

NUMBER = re.compile(r"-?\d+(\.\d+)?")


@pytest.mark.parametrize("title", ["Animation", "Timeline"])
@pytest.mark.parametrize("mode", ["sheet", "curves"])
@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_frames_are_where_their_numbers_are(tmp_path: Path, title: str, mode: str, scale: float) -> None:
    with open_still_editor(tmp_path, make_graph(), size=(900.0, 500.0), scale=scale) as still:
        prepare(still)
        curves = still.editor.curves
        curves.mode = mode  # pyright: ignore[reportAttributeAccessIssue]
        curves.fit()
        still.pane.point((1.0, 1.0))
        still.editor.session.time.seek(40)
        still.show(title, 4)
        left, top, right, bottom = still.places["keys ruler" if title == "Animation" else "ruler"]
        texts = [
            (float(text.words), text.box[0], text.box[2])
            for text in still.pane.copy().drawn_texts
            if NUMBER.fullmatch(text.words) and top <= text.box[1] and text.box[3] <= bottom + 1.0
            and left <= text.box[0] and text.box[2] <= right and text.words != "40"
        ]  # fmt: skip
        assert len(texts) >= 3
        frames, starts = (np.array([text[at] for text in texts]) for at in (0, 1))
        middles = np.array([(text[1] + text[2]) / 2 for text in texts])
        errors = []
        for places in (starts, middles):
            slope, offset = np.polyfit(frames, places, 1)
            errors.append(abs(slope * frames + offset - places).max())
            assert slope > 0.0
        assert min(errors) < 1.5 * scale
        if title == "Animation":
            lines = [
                shape for shape in still.pane.shapes.list_kinds("line") if shape.points[0][0] == shape.points[1][0]
            ]
            grid = [shape for shape in lines if shape.points[1][1] - shape.points[0][1] > 150.0 * scale]
            ways = defaultdict[int, set[float]](set)
            for shape in grid:
                ways[shape.color].add(shape.points[0][0])
            color = max((color for color in ways if len(ways[color]) >= 3), key=lambda color: color & 0xFFFFFF)
            apart = np.median(np.diff(sorted(ways[color])))
            assert apart == pytest.approx(np.median(np.diff(np.sort(middles))), abs=1.5), (
                "the strong lines have numbers"
            )
        if title == "Animation" and mode == "sheet":
            keys = {frame: still.places[f"key {Port('bloom', 'knee')} {frame}"] for frame in (1, 12, 40)}
            places = np.array([(box[0] + box[2]) / 2 for box in keys.values()])
            key_slope, _ = np.polyfit(np.array([*keys]), places, 1)
            assert key_slope == pytest.approx(np.polyfit(frames, middles, 1)[0], rel=0.02)
