"""Numbers of packages between the samples that their curves go through: tables of lights, and curves with a pole."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from exr_files import read
from halation.compiler.knobs import Knob, Point
from halation.export.package.curves import read_slot, write_slot
from halation.export.package.parts import VariantSamples
from halation.export.package.sampling import KnobSampler, Sample, Slot, is_irregular
from halation.export.python.functions.coverage import known_normals, surfaces_of_pixels
from halation.presets import paths

SIZE = "120x68"


@pytest.mark.parametrize("is_table", [True, False])
def test_what_is_far_from_a_pole_counts(is_table: bool) -> None:
    """1 / reach^2 is a thousand times larger at the low end of a slider than in its middle, and 0 for no reach at all.

    `exp` comes from no pole: it grows by a factor of 20,000.
    """

    def take(point: Point) -> Sample:
        reach = point["reach"]
        numbers = np.array([1.0 / reach**2 if reach > 0.0 else 0.0]), np.array([np.exp(reach)])
        whole = np.concatenate(numbers)
        slots = (whole,) if is_table else numbers
        made = tuple(Slot(each, is_whole=False, is_table=is_table) for each in slots)
        return Sample(None, 0, made)  # pyright: ignore[reportArgumentType]

    samples = KnobSampler(take, {}, Knob("reach", 3.6, 0.0, 10.0)).sample_range()
    assert len(samples) <= 200
    by_knob = VariantSamples(take({"reach": 3.6}), {"reach": samples}, [], lambda a, b: ([], [], []))
    places = range(1 if is_table else 2)
    records = [write_slot(at, by_knob.rest, by_knob.by_knob, [], by_knob.find_jumps([*places])) for at in places]
    for reach in np.linspace(1.0, 10.0, 997):
        found = np.concatenate([read_slot(record, {"reach": reach}) for record in records])
        np.testing.assert_allclose(found, [1.0 / reach**2, np.exp(reach)], rtol=5e-3)


def hash_of(x: float) -> float:
    """A number between 0 and 1 that has nothing to do with those of its neighbors."""
    return float(np.random.default_rng(round(x * 1e6)).random())


@pytest.mark.parametrize(
    ("first_jump", "last_jump", "most", "is_control"),
    [
        (0.0, 1.0, 60, False),  # everywhere: a sixteenth of the range says so
        (0.8, 1.0, 129, False),
        (0.3, 0.32, 129, True),  # so few of 256 steps of a slider are wrong
        (2.0, 2.0, 40, True),
    ],
)
def test_a_knob_that_moves_sorted_tables_is_soon_given_up(first_jump, last_jump, most, is_control) -> None:
    """Where a table jumps with every value there is no curve: to look on would plan the graph hundreds of times."""
    taken: list[float] = []

    def take(point: Point) -> Sample:
        taken.append(x := point["size"])
        jumping = hash_of(x) if first_jump <= x <= last_jump else 0.5
        return Sample(None, 0, (Slot(np.array([1.0 + x, jumping]), is_whole=False, is_table=True),))  # pyright: ignore[reportArgumentType]

    samples = KnobSampler(take, {}, Knob("size", 0.5, 0.0, 1.0)).sample_range()
    assert is_irregular(samples) is not is_control and len(taken) <= most
    if is_control:
        assert (min(samples), max(samples)) == (0.0, 1.0)


def test_a_frame_is_planned_once() -> None:
    """Passes change with every frame of a burned-in timecode; beside a whole number there is no other value."""
    taken: list[float] = []

    def take(point: Point) -> Sample:
        taken.append(x := point["frame"])
        return Sample(None, round(x), (Slot(np.zeros(1), is_whole=False),))  # pyright: ignore[reportArgumentType]

    KnobSampler(take, {}, Knob("frame", 1, 1, 120, is_whole=True)).sample_range()
    assert sorted(taken) == list(range(1, 121))


@pytest.mark.parametrize("reach", [0.02, 3.0, 8.5])
def test_a_page_moves_the_reach_of_many_lights(cli, tmp_path: Path, reach: float) -> None:
    """The preset whose swarm of lights reached too far at all values but its own."""
    (preset,) = (path for path in paths() if path.stem == "night_relight")
    graph = json.loads(preset.read_text())
    graph["controls"] = {"reach": graph["controls"]["reach"]}
    for each in graph["inputs"].values():
        each["file"] = str(preset.parent / each["file"])
    graph["nodes"]["camera"]["values"]["path"] = graph["inputs"]["beauty"]["file"]
    look, folder, ours, theirs = (tmp_path / name for name in ("look.json", "look", "ours.exr", "theirs.npy"))
    look.write_text(json.dumps(graph))
    assert cli("export", look, "--to", "glsl", "-o", folder, "--size", SIZE).code == 0
    words = ("--precision", "float", "--set", f"reach={reach}", "--size", SIZE)
    assert cli("render", look, "-o", ours, *words).code == 0
    reader = [sys.executable, folder / "read_package.py", folder, theirs, f"reach={reach}"]
    subprocess.run(reader, check=True, timeout=100)
    picture = read(ours)
    assert np.abs(np.load(theirs) - picture).max() <= 2e-3 * np.abs(picture).max()


def test_pixels_that_stand_for_a_mixed_one_are_at_most_two_away() -> None:
    """Normals of mixed pixels are shorter than 1; in the middle of a wide band all that are near are mixed."""
    normal, near = np.zeros((9, 12, 3)), np.full((9, 12, 1), 0.5)
    normal[:, :6] = (0.0, 0.0, 1.0)
    normal[:, 6:] = (0.8, 0.0, 0.6)
    for middle, columns in ((5.5, 2), (5.5, 4), (5.5, 6)):
        mixed = normal.copy()
        wide = [at for at in range(12) if abs(at - middle) < columns / 2]
        mixed[:, wide] = 0.5 * (np.array((0.0, 0.0, 1.0)) + np.array((0.8, 0.0, 0.6)))
        for turned in (False, True):
            share, front, back = surfaces_of_pixels(
                mixed.swapaxes(0, 1) if turned else mixed, near.swapaxes(0, 1) if turned else near
            )
            y, x = np.mgrid[: share.shape[0], : share.shape[1]]
            here = np.stack([x, y], axis=-1)
            assert max(np.abs(front - here).max(), np.abs(back - here).max()) <= 2
            if columns == 2:
                inside = (slice(5, 7), slice(3, 6)) if turned else (slice(3, 6), slice(5, 7))
                np.testing.assert_allclose(share[inside], 0.5, atol=1e-6)


def test_what_a_pixel_says_of_others_is_less_sure_with_the_square_of_the_way() -> None:
    """Normals of one direction whose mean has the square 0.5 vary by 12 times what is missing to 1: by 6."""
    normal, near = np.zeros((7, 7, 3)), np.ones((7, 7, 1))
    normal[..., 2] = np.sqrt(0.5)
    y, x = np.mgrid[:7, :7]
    for way, square in (((-1, -1), 2.0), ((1, 0), 1.0), ((2, -1), 5.0), ((0, 0), 0.0)):
        known, unsure = known_normals(normal, near, np.stack([x, y], axis=-1) + way)
        np.testing.assert_allclose(known[3, 3], (0.0, 0.0, 1.0), atol=1e-12)
        np.testing.assert_allclose(unsure[3, 3], 1e-4 + 6.0 * square, rtol=1e-12)
