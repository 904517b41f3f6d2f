"""The recipe for a new command in CONTRIBUTING.md, followed to the letter in a fresh tree, passes the tests."""

from __future__ import annotations

import re
import textwrap
from pathlib import Path

from source_trees import copy_tree, run_in_tree

SECTION = (Path(__file__).parents[2] / "docs" / "CONTRIBUTING.md").read_text(encoding="utf-8")
SECTION = SECTION.partition("### A command")[2].partition("\n### ")[0]


def insert(path: Path, before: str, text: str) -> None:
    whole = path.read_text(encoding="utf-8")
    assert whole.count(before) == 1, (path, before)
    path.write_text(whole.replace(before, text + before), encoding="utf-8")


def test_a_command_is_added_as_it_says(tmp_path: Path) -> None:
    tree = copy_tree(tmp_path / "tree")
    for block in re.findall(r"```python\n(.*?)```", SECTION, re.S):
        file, _, code = textwrap.dedent(f"   {block.strip()}\n").partition("\n")
        assert not (tree / file.strip("# ")).exists()
        (tree / file.strip("# ")).write_text(code, encoding="utf-8")
    insert(tree / "app/cli/program.py", '    "nodes",\n', '    "count",\n')
    mark = "<!-- count -->\n<!-- /count -->\n\n"
    insert(tree / "docs/command-line.md", "## halation nodes\n", f"## halation count\n\nCounts the nodes.\n\n{mark}")
    (line,) = re.findall(r'`("count": .*?,)`', SECTION, re.S)
    insert(tree / "tests/cli/test_root.py", '    "nodes": ("{out}', f"    {line}\n")
    assert run_in_tree(tree, "tests/generated_pages.py").returncode == 0
    assert (tree / "docs/command-line.md").read_text(encoding="utf-8").count("\n") <= 400
    tests = ("tests/cli/test_count.py", "tests/cli/test_root.py", "tests/law/test_house.py", "tests/law/test_lint.py")
    tests = (*tests, "tests/law/test_generated.py")
    chosen = "count or every_command or documented or ruff or page"
    result = run_in_tree(tree, "-m", "pytest", "-q", "-p", "no:cacheprovider", *tests, "-k", chosen)
    assert result.returncode == 0, result.stdout
