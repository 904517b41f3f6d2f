"""Copies of the source tree that Python imports in place of the installed one."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]

PACKAGES = {"app": "halation", "nodes": "halation.nodes", "shaders": "halation.shaders", "presets": "halation.presets"}
"""Top-level folder -> the package that it is."""

_FINDER = """
import sys
from importlib.util import spec_from_file_location
from pathlib import Path

class CopiedTree:
    def find_spec(name, path=None, target=None):
        if name in {folders!r}:
            folder = Path({root!r}, {folders!r}[name])
            return spec_from_file_location(name, folder / "__init__.py", submodule_search_locations=[str(folder)])

sys.meta_path.insert(0, CopiedTree)
"""
"""Python runs a `sitecustomize` that it finds on its path before anything else."""


def copy_tree(target: Path) -> Path:
    """Copy all that the tests need of the source tree; returns the copy.

    What Python compiled comes along: it holds as long as the times of the files stay, and saves seconds at each start.
    """
    for name in (*PACKAGES, ".ci", "docs", "tests"):
        shutil.copytree(ROOT / name, target / name)
    for name in (".gitignore", "dev", "pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, target / name)
    return target


def import_from(tree: Path) -> dict[str, str]:
    """The environment in which Python imports the packages of the copy; the third-party libraries stay the same."""
    hook = tree.parent / f"{tree.name}-path"
    hook.mkdir(exist_ok=True)
    folders = {package: folder for folder, package in PACKAGES.items()}
    (hook / "sitecustomize.py").write_text(_FINDER.format(folders=folders, root=str(tree)), encoding="utf-8")
    return {**os.environ, "PYTHONPATH": str(hook)}


def run_in_tree(tree: Path, *words: str, timeout: float = 600.0) -> subprocess.CompletedProcess[str]:
    """Run this Python in the copy."""
    return subprocess.run(
        [sys.executable, *words], cwd=tree, env=import_from(tree), capture_output=True, text=True, timeout=timeout
    )
