"""A farm and a shot that all tests of clusters use."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from exr_files import write_exr
from farms import CRASH, FRAMES, Ending, Farm, Halation, find_port, make_graph, start_halation, start_scheduler


@pytest.fixture
def make_farm(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[[], Farm]]:
    """`make_farm()` starts a scheduler without workers."""
    farms: list[Farm] = []

    def make() -> Farm:
        folder, port = tmp_path_factory.mktemp("farm"), find_port()
        farms.append(Farm(folder, f"tcp://127.0.0.1:{port}", start_scheduler(folder, port)))
        return farms[-1]

    yield make
    for farm in farms:
        farm.stop()


@pytest.fixture(scope="module")
def farm(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Farm]:
    """A scheduler and two workers, for all tests of a file that harm none of them."""
    folder, port = tmp_path_factory.mktemp("farm"), find_port()
    farm = Farm(folder, f"tcp://127.0.0.1:{port}", start_scheduler(folder, port))
    (folder / "sitecustomize.py").write_text(CRASH)
    for _ in range(2):
        farm.start_worker(PYTHONPATH=str(folder), CRASH_AT="666,777")
    yield farm
    farm.stop()


@pytest.fixture
def halation(shot: Path) -> Halation:
    """`halation("render", ...)` runs a command in the folder of the shot."""

    def run(*words: object) -> Ending:
        process = start_halation(*words, cwd=shot)
        out, err = process.communicate(timeout=120)
        return Ending(process.returncode, out, err)

    return run


@pytest.fixture
def shot(tmp_path: Path) -> Path:
    """A folder with a sequence and a graph `shot.json` that reads it, with an animated value, a LUT and a group."""
    folder = tmp_path / "show" / "shot"
    (folder / "plates").mkdir(parents=True)
    for frame in FRAMES:
        picture = np.full((12, 16, 4), frame / 8.0, np.float32)
        write_exr(folder / "plates" / f"p.{frame:04d}.exr", {"Combined": picture}, {"Combined": "half"})
    lines = [f"{r} {g} {b}" for b in (0.1, 0.9) for g in (0, 1) for r in (0, 0.8)]
    (folder / "look.cube").write_text("\n".join(["LUT_3D_SIZE 2", *lines]) + "\n")
    light = {"type": "exposure", "values": {"stops": 0.5}}
    group = {
        "halation": 1,
        "inputs": {"image": {"type": "Image"}},
        "outputs": {"image": {"type": "Image"}},
        "nodes": {"light": light},
        "links": {"light.image": "inputs.image", "outputs.image": "light.out"},
    }
    (folder / "group.json").write_text(json.dumps(group))
    (folder / "shot.json").write_text(json.dumps(make_graph()))
    return folder
