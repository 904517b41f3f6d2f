"""The README's promise: two files, copied word for word into a fresh tree, add a node that passes all tests."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from source_trees import copy_tree, run_in_tree

ROOT = Path(__file__).parents[2]
CONTRIBUTING = (ROOT / "docs" / "CONTRIBUTING.md").read_text(encoding="utf-8")
README = (ROOT / "README.md").read_text(encoding="utf-8")

EVERY_NODE = ("tests/nodes/test_catalogue.py", "tests/nodes/test_promises.py", "tests/nodes/test_pointwise_values.py")
"""Tests with a case for every node."""

ALL_NODES = (
    "tests/cli/test_manual.py",
    "tests/lint/test_live.py",
    "tests/lint/test_page.py",
    "tests/lint/test_rules.py",
    "tests/law/test_house.py",
    "tests/law/test_floors.py",
    "-k=not files_are_short and not comments_are_few and not importing_stays_light and not commands_without_windows",
)
"""Tests that look at all nodes together. What is left out concerns the other files only."""


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the source tree with the node of the README in it, and the generated pages renewed as it says."""
    tree = copy_tree(tmp_path_factory.mktemp("readme") / "tree")
    section = README.partition("## Add a node in two files")[2].partition("\n## ")[0]
    blocks = re.findall(r"```(?:python|glsl)\n(.*?)```", section, re.S)
    files = {re.findall(r"(?:nodes|shaders)/\w+/\w+\.\w+", text)[0]: text for text in blocks}
    assert sorted(name.partition("/")[0] for name in files) == ["nodes", "shaders"]
    for name, text in files.items():
        assert not (tree / name).exists()
        (tree / name).write_text(text, encoding="utf-8")
    assert "`./dev renew`" in section
    renewal = run_in_tree(tree, "tests/generated_pages.py")
    assert renewal.returncode == 0 and "docs/nodes.md is renewed" in renewal.stdout, renewal.stderr
    return tree


def test_the_new_node_passes_the_tests_of_every_node(tree: Path) -> None:
    result = run_in_tree(tree, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-k", "solarize", *EVERY_NODE)
    assert result.returncode == 0, result.stdout
    assert int(re.findall(r"(\d+) passed", result.stdout)[0]) > 10


def test_its_numbers_are_tested_as_contributing_says(tree: Path) -> None:
    section = CONTRIBUTING.partition("### A node")[2].partition("\n### ")[0]
    (text,) = re.findall(r"```python\n(.*?)```", section, re.S)
    (tree / "tests/nodes/test_solarize.py").write_text(text, encoding="utf-8")
    result = run_in_tree(tree, "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests/nodes/test_solarize.py")
    assert result.returncode == 0 and "1 passed" in result.stdout, result.stdout
    style = run_in_tree(tree, "-m", "ruff", "check", "tests/nodes/test_solarize.py", "nodes/color/solarize.py")
    assert style.returncode == 0, style.stdout


def test_commands_of_the_table_select_tests(tree: Path, pytestconfig: pytest.Config) -> None:
    """Every row names folders or files of tests and known options; the one that selects by a word is tried."""
    rows = [row.split() for row in re.findall(r"^\| `\./dev test(.*?)` \|", CONTRIBUTING, re.M)]
    assert len(rows) >= 4
    for row in rows:
        selection, *word = " ".join(row).split("-k ")
        for name in selection.replace("-n 2", "").split():
            if name.startswith("--"):
                assert pytestconfig.getoption(name.removeprefix("--")) is not None
            else:
                path = tree / name
                assert (path.match("test_*.py") and path.is_file()) or any(path.rglob("test_*.py")), name
        if word:  # in the largest room, which has a case for every node: to read all tests takes long
            words = ("--collect-only", "-qq", "-p", "no:cacheprovider", *row, "tests/nodes")
            result = run_in_tree(tree, "-m", "pytest", *words)
            counts = [int(count) for count in re.findall(r": (\d+)$", result.stdout, re.M)]
            assert result.returncode == 0 and sum(counts) > 10, (row, result.stdout)
    assert any("-k" in row for row in rows)


@pytest.mark.nightly  # by day they run in the tree itself, and test_the_new_node_passes_the_tests_of_every_node here
def test_nothing_else_notices_it(tree: Path) -> None:
    result = run_in_tree(tree, "-m", "pytest", "-q", "-p", "no:cacheprovider", *ALL_NODES)
    assert result.returncode == 0, result.stdout
