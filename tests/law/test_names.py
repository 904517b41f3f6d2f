"""Names that a reader looks up: a class is one noun, and the whole project has it once."""

from __future__ import annotations

import ast
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_every_class_has_a_name_of_its_own() -> None:
    """Private ones too: whoever searches for a word finds one class. Nodes are named after their files."""
    homes: dict[str, list[str]] = defaultdict(list)
    for top in ("app", "nodes", "shaders", "presets"):
        for path in sorted((ROOT / top).rglob("*.py")):
            for item in ast.walk(ast.parse(path.read_text("utf-8"))):
                if isinstance(item, ast.ClassDef):
                    homes[item.name].append(f"{path.relative_to(ROOT).as_posix()}:{item.lineno}")
    assert len(homes) > 500
    assert not {name: places for name, places in homes.items() if len(places) > 1}
