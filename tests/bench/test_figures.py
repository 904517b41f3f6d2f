"""What the benchmark makes of its numbers."""

from __future__ import annotations

import pytest
from bench.conditions import compute_condition_rows, list_presets, measure_presets
from bench.figures import compute_rows, format_table
from bench.report import format_results
from bench.results import Results, Run, median_ratio


def measured(**walls):
    """T5 in whole processes, by program; ours also as accurate as is wanted."""
    found = Results({"processors": 2})
    found.runs = [Run("hd", "T5", name, wall, wall, [100.0] * len(wall)) for name, wall in walls.items()]
    found.run("hd", "T5", "halation").rms = 2e-4
    return found


def row(results, beginning):
    return next(one for one in compute_rows(results) if one.what.startswith(beginning))


def test_ratios_are_of_the_same_round():
    """A slow moment falls on both programs of a round: the median of ratios is not the ratio of medians."""
    assert median_ratio([1.0, 10.0, 2.0], [2.0, 20.0, 4.0]) == 0.5
    assert median_ratio([3.0, 1.0, 2.0], [8.0]) == 0.25
    assert median_ratio([], [1.0]) is None


def test_the_best_of_others_counts():
    found = measured(halation=[1.0, 1.0], blender=[4.0, 4.0], blender5=[2.5, 2.5])
    figure = next(one for one in row(found, "whole process against the best Blender").figures if one.label == "T5")
    assert figure.number == 0.4 and figure.is_reached


@pytest.mark.parametrize(("ours", "verdict"), [(0.5, "yes"), (0.51, "no")])
def test_a_row_is_reached_up_to_its_limit(ours, verdict):
    found = measured(halation=[ours], blender=[1.0])
    assert row(found, "whole process against the best Blender").verdict == verdict


def test_what_was_not_measured_is_said():
    found = measured(halation=[1.0])
    assert row(found, "cold cache").verdict == "\N{EN DASH}"
    assert "| cold cache of shaders against warm, T5 | 2 | not measured |" in format_table(compute_rows(found))


def test_results_are_kept_as_they_are(tmp_path):
    found = measured(halation=[1.0, 2.0], raw=[0.5, 1.0])
    found.extras = {"sigma": {"20": [1.0], "200": [1.2]}}
    found.save(tmp_path / "kept.json")
    assert Results.load(tmp_path / "kept.json") == found
    (tmp_path / "other.json").write_text("{}")
    with pytest.raises(SystemExit, match=r"other\.json: no results of this benchmark"):
        Results.load(tmp_path / "other.json")


def test_the_listing_tells_what_changed():
    before, now = measured(halation=[2.0, 2.0]), measured(halation=[1.0, 1.0])
    line = next(one for one in format_results(now, before).splitlines() if "halation" in one)
    assert "| 1.00 | 1.00 |" in line and "0.50, \N{EN DASH}" in line


def test_presets_and_threads_are_compared_within_rounds():
    """The middle round of three is slow: ratios do not see it, and the slowest preset is named."""
    presets = {
        "calm": {"cold": [1.0, 9.0, 1.2], "warm": [1.0, 9.0, 1.0]},
        "heavy": {"cold": [3.0, 30.0, 3.0], "warm": [1.0, 10.0, 1.0]},
    }
    threads = {"T5": {"1": [4.0, 8.0], "2": [2.0, 4.0]}}
    first, second = compute_condition_rows({"presets": presets, "threads": threads})
    assert [(figure.label, figure.number) for figure in first.figures] == [
        ("median", 2.0),
        ("heavy", 3.0),
        ("heavy", 3.0),
    ]
    assert first.verdict == "no" and [figure.number for figure in second.figures] == [1.0, 2.0]
    assert not list(compute_condition_rows({}))


def test_a_preset_without_a_cache_compiles_its_programs():
    """Both are the same command, and only the folder of the cache differs: the first run in it fills it."""
    assert "soft_bloom" in list_presets()
    said = list[str]()
    measured_presets = measure_presets(("soft_bloom",), 1, said.append)
    assert said == ["preset soft_bloom"]
    assert {what: len(seconds) for what, seconds in measured_presets["soft_bloom"].items()} == {"cold": 1, "warm": 1}
