"""Whether other drivers make the pictures that llvmpipe makes: all nodes and presets, small, one driver after another.

    .venv/bin/python tests/bench/newer_mesa.py                       # on Debian: a newer Mesa, beside the system's
    .venv/bin/python tests/bench/drivers.py                          # every driver that this machine has
    .venv/bin/python tests/bench/drivers.py softpipe "OpenGL 4.1" --pictures preset.soft_bloom,node.fxaa
    .venv/bin/python tests/bench/drivers.py softpipe --inside turntable        # which of its nodes differs first
    .venv/bin/python tests/bench/drivers.py --keep out/drivers/pictures        # go on there if it was cut short

Processes of each driver draw the pictures of `gallery` at a small size, in float. Prints a table; a driver that is not
there, or draws with another name, is left out by its reason. Differences are those of scene light, of the larger of 1
and the light itself, so that 1 % of a sun counts as 1 % of white. docs/performance.md has the table.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1]))

import numpy as np
from bench.driver_list import DRIVERS, Driver, MissingDriverError, describe_environment
from bench.driver_pictures import ANGLES, CORNERS, Array, Pictures, draw_in_processes, list_pictures, list_ports

VISIBLE = 1.0 / 255.0
"""A difference that a screen of 8 bits may show."""


@dataclass(frozen=True)
class Comparison:
    """What a driver made of all pictures: how many differ, by how much, and which does most."""

    driver: str
    device: str
    nodes: int
    presets: int
    failures: tuple[str, ...]
    differing: Mapping[str, float]
    largest: float
    where: str


def measure_difference(found: Array, expected: Array) -> float:
    """The largest difference of two pictures, of the larger of 1 and the light itself; infinite where one is not."""
    if found.shape != expected.shape:
        return float("inf")
    finite = np.isfinite(expected)
    if not np.array_equal(found[~finite], expected[~finite], equal_nan=True):
        return float("inf")
    difference = np.abs(found[finite] - expected[finite]) / np.maximum(np.abs(expected[finite]), 1.0)
    return float(difference.max(initial=0.0)) if np.isfinite(difference).all() else float("inf")


def compare(driver: str, found: Pictures, expected: Pictures) -> Comparison:
    """A row of the table."""
    differences, failures = dict[str, float](), list[str]()
    for name, reference in expected.items():
        picture = found.get(name, "not drawn")
        if isinstance(picture, str) and name != "device":
            failures.append(f"{name}: {picture}")
        elif isinstance(picture, np.ndarray) and isinstance(reference, np.ndarray):
            differences[name] = measure_difference(picture, reference)
    where = max(differences, key=lambda name: differences[name], default="")
    nodes = sum(name.startswith("node.") for name in differences)
    differing = {name: difference for name, difference in differences.items() if difference > VISIBLE}
    largest = differences.get(where, 0.0)
    device = str(found.get("device", ""))
    return Comparison(driver, device, nodes, len(differences) - nodes, tuple(failures), differing, largest, where)


def draw_reference(driver: Driver, names: Sequence[str], folder: Path) -> Pictures:
    """What llvmpipe draws, with corners of triangles where this driver places them."""
    return draw_driver(replace(DRIVERS[0], corners=driver.corners), names, folder)


def draw_driver(driver: Driver, names: Sequence[str], folder: Path) -> Pictures:
    """What a driver draws, kept in a folder of its own. Raises MissingDriverError where this machine has none such."""
    place = folder / f"{driver.name.replace(', ', '-').replace(' ', '-')}-{driver.corners}"
    place.mkdir(parents=True, exist_ok=True)
    variables = {"HALATION_TEST_FORM": driver.form, CORNERS: str(driver.corners)}
    variables |= describe_environment(driver, place) | ({ANGLES: "1"} if driver.exact_angles else {})
    found = draw_in_processes(names, place, variables)
    if driver.word not in str(found.get("device", "")):
        raise MissingDriverError(f"there is no driver named {driver.name}: {found.get('failure') or found['device']}")
    return {"device": found["device"], **{name: found[name] for name in names}}


def format_rows(rows: Sequence[Comparison]) -> str:
    """The table in Markdown."""
    lines = ["| driver | nodes | presets | differ by more than 1/255 | largest difference |", "|---|---|---|---|---|"]
    lines += [
        f"| {row.driver}: {row.device} | {row.nodes} | {row.presets} | {len(row.differing)}"
        f" | {row.largest:.2g} {row.where} |"
        for row in rows
    ]
    return "\n".join(lines)


def describe_row(row: Comparison) -> list[str]:
    """What a row counts, by name."""
    return [*row.failures, *(f"{name}: {difference:.3g}" for name, difference in row.differing.items())]


def read_options() -> argparse.Namespace:
    """The command line."""
    reader = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    reader.add_argument("drivers", nargs="*", help=f"by default all of {', '.join(driver.name for driver in DRIVERS)}")
    reader.add_argument("--pictures", help="names such as node.bloom or preset.clay_city, with commas; by default all")
    reader.add_argument("--inside", metavar="PRESET", help="draw the outputs of all its nodes instead")
    reader.add_argument("--keep", type=Path, metavar="FOLDER", help="keep pictures there, and draw no kept one again")
    return reader.parse_args()


def main() -> int:
    """Draw, compare, print; 1 if a picture is missing or differs."""
    options = read_options()
    names = list_pictures() if options.pictures is None else options.pictures.split(",")
    names = list_ports(options.inside) if options.inside else names
    chosen = [driver for driver in DRIVERS[1:] if not options.drivers or driver.name in options.drivers]
    rows: list[Comparison] = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = (options.keep or Path(temporary)).absolute()
        for driver in (DRIVERS[0], *chosen):
            try:
                found = draw_driver(driver, names, folder)
            except MissingDriverError as error:
                print(f"{driver.name}: left out ({error})", flush=True)
                continue
            expected = draw_reference(driver, names, folder)
            rows.append(row := compare(driver.name, found, expected))
            print(f"{row.driver}: {row.device}", *describe_row(row), sep="\n  ", flush=True)
    print(format_rows(rows))
    return int(any(row.failures or row.differing for row in rows))


if __name__ == "__main__":
    sys.exit(main())
