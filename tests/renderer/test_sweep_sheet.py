"""Sheets of a sweep: how many columns they have, what is shrunk for a cell, and the light that data is shown with."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from halation.graph import Graph, Output, Port
from halation.nodes import Kind
from halation.renderer.jobs import sweep


@pytest.mark.parametrize(
    ("wide", "cell", "step"), [(64, 0, 1), (400, 100, 1), (799, 100, 1), (800, 100, 2), (1200, 100, 3), (40, 100, 1)]
)
def test_a_picture_keeps_four_pixels_for_each_of_its_cell(wide: int, cell: int, step: int) -> None:
    array = np.arange(6 * wide * 3, dtype=np.float32).reshape(6, wide, 3)
    shrunk = sweep._shrink(array, cell)  # pyright: ignore[reportPrivateUsage]
    rows, columns = np.arange(0, 6, step), np.arange(0, wide, step)
    assert np.array_equal(shrunk, array[rows[:, None], columns])


@pytest.mark.parametrize(
    ("count", "size", "columns"),
    [(1, (9, 16), 1), (4, (9, 16), 4), (5, (9, 16), 3), (9, (9, 16), 3), (16, (9, 16), 4), (10, (100, 10), 10)],
)
def test_many_cells_form_about_the_shape_of_a_screen(count: int, size: tuple[int, int], columns: int) -> None:
    found = sweep._choose_columns(count, np.zeros((*size, 3)))  # pyright: ignore[reportPrivateUsage]
    assert found == columns


@pytest.mark.parametrize(
    ("numbers", "low", "high"),
    [([(0.5, 2.0), (1.0, np.inf)], 0.0, 2.0), ([(-1.0, 3.0), (np.nan, 4.0)], -1.0, 4.0), ([(0.0, 0.0)], 0.0, 1.0)],
)
def test_data_is_shown_between_the_ends_of_all_pictures(
    monkeypatch: pytest.MonkeyPatch, numbers: list[tuple[float, float]], low: float, high: float
) -> None:
    seen = list[tuple[float, float]]()
    monkeypatch.setattr(sweep, "show_data", lambda array, *ends: seen.append(ends) or array)
    graph = Graph().add_output("depth", Output(Kind.FIELD, 1))
    settings: Any = SimpleNamespace(
        request=SimpleNamespace(targets={"depth": Port("outputs", "depth")}), output="depth"
    )
    pictures = [np.array(pair, np.float32).reshape(1, 2, 1) for pair in numbers]
    shown = sweep._show_cells(graph, pictures, settings)  # pyright: ignore[reportPrivateUsage]
    assert seen == [(low, high)] * len(pictures) and [array.shape for array in shown] == [(1, 2, 1)] * len(pictures)


def test_one_number_is_a_picture_of_it() -> None:
    wide = sweep._widen(np.full((1, 1, 3), 0.25))  # pyright: ignore[reportPrivateUsage]
    assert wide.shape[0] == wide.shape[1] > 8 and (wide == 0.25).all()
    assert sweep._widen(picture := np.zeros((1, 2, 3))) is picture  # pyright: ignore[reportPrivateUsage]


def test_a_step_is_a_part_of_a_file_name() -> None:
    assert sweep._format_step("7", True) == "0007"  # pyright: ignore[reportPrivateUsage]
    assert sweep._format_step("a b/c:-1.5+x_y", False) == "a_b_c_-1.5+x_y"  # pyright: ignore[reportPrivateUsage]


def test_labels_are_whole_names_where_two_would_be_equal() -> None:
    assert sweep.choose_labels(["a.x", "b.x"], {"a.x": "x", "b.x": "y"}) == {"a.x": "x", "b.x": "y"}
    assert sweep.choose_labels(["a.x", "b.x"], {"a.x": "x", "b.x": "x"}) == {"a.x": "a.x", "b.x": "b.x"}
