"""The repository's folders laid out as the package `halation`, by links, for tools that read source files.

setuptools maps `app` to `halation` and `nodes` to `halation.nodes` when it installs. A type checker or an IDE does not
run that map: it wants a folder `halation` on its path. `.venv/types/halation` is that folder; `extraPaths` in
pyproject.toml names it.
"""

from __future__ import annotations

import shutil
from pathlib import Path

ROOT = Path(__file__).parents[1]
TYPES = ROOT / ".venv" / "types"


def link_package(folder: Path = TYPES) -> None:
    """Make `folder/halation`, a folder of links. Raises OSError where the system allows no symbolic links."""
    package = folder / "halation"
    targets = {path.name: path for path in (ROOT / "app").iterdir() if path.name != "__pycache__"}
    targets |= {top: ROOT / top for top in ("nodes", "shaders", "presets")}
    if package.is_dir() and {path.name: path.resolve() for path in package.iterdir()} == targets:
        return
    shutil.rmtree(package, ignore_errors=True)
    package.mkdir(parents=True)
    for name, target in targets.items():
        (package / name).symlink_to(target, target.is_dir())


if __name__ == "__main__":
    link_package()
