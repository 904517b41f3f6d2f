"""The graphs of the benchmark compute what the tasks say, so that what is timed is the same work."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from bench import references, tasks
from bench.inputs import make_pictures
from halation import document
from halation.renderer import RenderRequest
from halation.resources.sandbox import UNRESTRICTED

ROOT = Path(__file__).parents[1]
WIDTH, HEIGHT = tasks.SIZES["tiny"]
ALIKE = 3e-4
"""RMS of the difference, as a part of the reference's: writing half floats alone costs 2.1e-4."""


@cache
def given():
    return {name: pixels.reshape(HEIGHT, WIDTH, -1) for name, pixels in make_pictures(WIDTH, HEIGHT).items()}


def rendered(renderer, task):
    graph = document.load(task.path, sandbox=UNRESTRICTED)
    for name, value in task.values(WIDTH).items():
        graph = graph.override(name, value)
    wanted = RenderRequest({name: given()[name] for name in task.inputs}, precision="float")
    return renderer.render(graph, wanted)["out"].astype(np.float16)


@pytest.mark.parametrize("task", tasks.TASKS.values(), ids=list(tasks.TASKS))
def test_a_graph_computes_its_task(renderer, task):
    found = references.compare_pictures(rendered(renderer, task), references.render_reference(task.name, given()))
    assert found["rms"] <= ALIKE


def test_references_see_what_is_different():
    """An edge of the picture, a lost channel, a wrong sigma: each is seen."""
    right = references.render_reference("T1s3", given())
    wide = references.blur(given()["a"].astype(float), 3.02)
    for wrong in (np.roll(right, 1, 1), right * (1.0, 1.0, 1.0, 0.0), wide):
        assert references.compare_pictures(wrong, right)["rms"] > ALIKE


def test_pictures_are_what_the_tasks_ask_for():
    found = given()
    color, alpha = found["a"][..., :3].astype(np.float32), found["a"][..., 3]
    assert color.min() >= 0.0 and 50.0 < color.max() <= 502.0
    assert 0.0 == alpha.min() < 0.5 < alpha.mean() < alpha.max() == 1.0
    assert not color[alpha == 0.0].any()
    assert found["depth"].min() > 0.0 and np.abs(found["noise"]).max() <= 1.0
    np.testing.assert_allclose(np.linalg.norm(found["normal"], axis=2), 1.0, atol=1e-4)
    assert all(np.isfinite(one.astype(np.float32)).all() for one in found.values())


def test_a_seed_changes_numbers_of_tasks_and_graphs_alike():
    """In a process of its own: the numbers are taken when the module is imported."""
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-p",
        "no:cacheprovider",
        f"{__file__}::test_a_graph_computes_its_task",
    ]
    run = subprocess.run(command, env={**os.environ, tasks.SEED: "5"}, capture_output=True, text=True)
    assert run.returncode == 0 and f"{len(tasks.TASKS)} passed" in run.stdout, run.stdout
    code = "from bench.tasks import *; print(*SIGMAS.values(), PUSH, TASKS['T10'].values(96)['blur.sigma'])"
    printed = [
        subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "PYTHONPATH": str(ROOT), tasks.SEED: seed},
            capture_output=True,
            text=True,
        ).stdout.split()
        for seed in ("5", "5", "6")
    ]
    assert printed[0] == printed[1] and len(printed[0]) == 5
    assert all(first != second for first, second in zip(printed[0], printed[2], strict=True))
