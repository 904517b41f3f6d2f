"""What the README shows is true."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import get_args

import pytest
from halation import document
from halation.cli.outcome import EXIT_CODES
from halation.graph import Interpolation, problems
from halation.graph.expressions.functions import FUNCTIONS
from halation.nodes import Pointwise, Temporal, Trait, catalogue
from halation.resources.sandbox import UNRESTRICTED

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
PAGES = (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))


def block(language: str, start: str = "") -> str:
    """The first fenced block of a language whose text begins with `start`."""
    return next(text for text in re.findall(rf"```{language}\n(.*?)```", README, re.S) if text.startswith(start))


def test_the_graph_loads_and_has_no_problems() -> None:
    graph = document.loads(block("json"), sandbox=UNRESTRICTED)
    assert problems(graph) == ()
    assert set(json.loads(document.dumps(graph))) == set(json.loads(block("json")))


def test_the_node_is_declared_as_its_shader_says() -> None:
    module = ModuleType("halation.nodes.color.solarize")
    module.__package__ = "halation.nodes.color"
    sys.modules[module.__name__] = module
    try:
        exec(compile(block("python", "# nodes/"), "README.md", "exec"), vars(module))
    finally:
        del sys.modules[module.__name__]
    node = module.Solarize
    assert issubclass(node, Pointwise) and (node.id, node.category) == ("solarize", "color")
    shader = block("glsl")
    declared = ", ".join(f"{(node.inputs.get(name) or node.values[name]).glsl} {name}" for name in node.order)
    assert f"vec4 solarize({declared})" in shader
    assert [name for name in node.order if name in node.values] == ["threshold"]


def test_the_floor_plan_lists_every_room() -> None:
    rooms = re.findall(r"^  (\w+(?:/|\.py)) ", block("text", "dev "), re.M)
    modules = {path.name for path in (ROOT / "app").glob("*.py")} - {"__init__.py"}
    folders = {f"{path.parent.name}/" for path in (ROOT / "app").glob("*/__init__.py")}
    assert sorted(rooms) == sorted(modules | folders)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_files_and_folders_that_a_page_names_exist(page: Path) -> None:
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
    paths = set(re.findall(r"(?<![\w./-])(?:docs|presets|tests|nodes|shaders|app)/[\w/-]+(?:\.\w+)?(?![\w<])", text))
    assert not {path for path in paths if not (ROOT / path).exists()}
    links = set(re.findall(r"\]\((?!https?:|#)([^)#]+)", re.sub(r"`[^`]*`", "", text)))
    assert not {link for link in links if not (page.parent / link).exists()}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_each_row_of_a_table_has_a_cell_for_each_column(page: Path) -> None:
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
    for table in re.findall(r"(?:^\|.*\n)+", text, re.M):
        columns = [len(re.findall(r"(?<!\\)\|", row)) - 1 if row.endswith("|") else row for row in table.splitlines()]
        assert columns == [columns[0]] * len(columns), table


def test_traits_are_explained_on_one_page() -> None:
    assert [page.name for page in PAGES if f"| `{Trait.NEEDS_COLOR.name}` |" in page.read_text(encoding="utf-8")] == [
        "writing-nodes.md"
    ]


def test_its_commands_and_exit_codes_exist() -> None:
    for command in sorted(set(re.findall(r"^halation ([\w-]+)", README, re.M))):
        result = subprocess.run(
            [sys.executable, "-c", "from halation.cli import main; main()", command, "--help"],
            capture_output=True,
            text=True,
        )
        assert result.returncode == 0 and result.stdout, (command, result.stderr)
    rows = re.findall(r"^\| (\d+) \|", README, re.M)
    assert rows == re.findall(r"^(\d+) ", EXIT_CODES, re.M)


def test_its_python_names_exist() -> None:
    import halation
    import halation.cli
    import halation.renderer

    # The parts of app are attributes of it as soon as they are loaded, and must not shadow a function of its face.
    for name in re.findall(r"\bhal\.(\w+)\(", README):
        assert callable(getattr(halation, name)), name


def test_the_page_on_time_knows_everything_there_is() -> None:
    page = (ROOT / "docs" / "time.md").read_text(encoding="utf-8")
    graph = document.loads(next(re.finditer(r"```json\n(.*?)```", page, re.S))[1], sandbox=UNRESTRICTED)
    assert problems(graph) == () and len(graph.animation) == 2
    assert re.findall(r"^\| `(.*?)` \| (.*) \|$", page.partition("## Expressions")[2].partition("\n## ")[0], re.M) == [
        (function.signature, function.doc) for function in FUNCTIONS.values()
    ]
    named = set(re.findall(r"`(\w+)`", page.partition("Time can be bent")[2].partition("## Keys")[0]))
    named |= set(re.findall(r"`(\w+)`", page.partition("## Nodes with a memory")[2].partition("With `")[0]))
    assert named <= catalogue().keys()
    remembering = {node.id for node in catalogue().values() if issubclass(node, Temporal)}
    assert remembering <= named
    ways = re.findall(r"^\| `(\w+)` \|", page.partition("## Keys")[2].partition("## Expressions")[0], re.M)
    assert set(ways) == set(get_args(Interpolation))
