"""Faults are put where they change what runs, the same seed draws the same ones, and the tests of a file see them."""

from __future__ import annotations

import ast
import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from import_graph import ROOT
from mutation import reach, run
from mutation.choice import FUNCTIONS, list_scripted_nodes, list_tests, select_tests
from mutation.mutants import list_mutants
from mutation.repairs import REPAIRS
from mutation.run import draw_mutants, list_files, raise_floors
from mutation.shader_users import list_users
from mutation.trials import room_of
from selection import LIST

PYTHON = '''"""Text with 1 + 1."""
__all__ = ["size"]

def size(count: int | None = 3, *, é: float = 0.5) -> int:  # 1 < 2
    if count is None and not é:
        return min(count, 2)
    print(f"{count:03d}")
    class Frozen(int, total=False): ...
    return "%d" % count if count <= 2 else place(é, count // 7) or np.multiply(é, math.hypot(é, x))
'''

GLSL = """// a + b
#define TWICE 2.0
layout(location = 0) out vec4 color;
float f(float x) { return max(x - 0.5, 0.0) * 3.0; } /* 1.0 */
"""


@pytest.fixture(autouse=True)
def nothing_recorded(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    """Tests are chosen by names and imports, whatever was recorded here."""
    monkeypatch.setattr(reach, "RECORD", tmp_path / "none.npz")
    reach.read_record.cache_clear()
    yield
    reach.read_record.cache_clear()


def change(path: str, source: str) -> list[tuple[str, str]]:
    """What the mutants of a text take away, and what they put there."""
    return [(source[mutant.start : mutant.end], mutant.text) for mutant in list_mutants(Path(path), source)]


def test_python_is_changed_where_it_runs() -> None:
    assert change("a.py", PYTHON) == [
        ("3", "4"),
        ("0.5", "1.0"),
        ("count is None and not é", "not (count is None and not é)"),
        ("is", "is not"),
        ("and", "or"),
        ("not ", ""),
        ("min", "max"),
        ("2", "3"),
        ('print(f"{count:03d}")', "None"),
        ("count <= 2", "(not (count <= 2))"),
        ("<=", "<"),
        ("2", "3"),
        ("é, count // 7", "count // 7, é"),
        ("//", "*"),
        ("7", "8"),
        ("or", "and"),
    ]


def test_glsl_is_changed_where_it_runs() -> None:
    assert change("a.glsl", GLSL) == [
        ("max", "min"),
        ("-", "+"),
        ("0.5", "1.0"),
        ("0.0", "1.0"),
        ("*", "/"),
        ("3.0", "6.0"),
    ]


def test_every_fault_of_the_tree_can_be_read() -> None:
    for path in list_files(("graph", "media"))[::7]:
        source = (ROOT / path).read_text("utf-8")
        for mutant in list_mutants(path, source):
            ast.parse(mutant.apply(source))
            assert mutant.apply(source) != source


def test_the_same_seed_draws_the_same_faults() -> None:
    rooms = ("document", "color")
    sample = draw_mutants(3, 5, rooms)
    assert sample == draw_mutants(3, 5, rooms) != draw_mutants(4, 5, rooms)
    assert [room_of(mutant.path) for mutant in sample] == ["document"] * 5 + ["color"] * 5


def test_the_nearest_tests_come_first() -> None:
    assert list_tests(Path("app/graph/walk.py"))[0] == "tests/graph/test_walk.py"
    assert list_tests(Path("app/media/comparison/contact_sheet.py"))[0] == "tests/presets/test_sheet.py"
    assert list_tests(Path("shaders/geometry/curvature.glsl"))[0] == "tests/nodes/test_curvature.py"


@pytest.mark.parametrize(
    ("path", "test"),
    [
        ("app/serving/listening.py", "tests/cli/test_serve.py"),
        ("app/cli/sweeping.py", "tests/cli/test_sweep.py"),
        ("app/cluster/campaign.py", "tests/cluster/test_frames.py"),
        ("app/editor/inspector/item_rows.py", "tests/gui/test_inspector.py"),
        ("shaders/primitive/fourier.glsl", "tests/renderer/test_convolution.py"),
        ("shaders/viewer/palette.glsl", "tests/renderer/test_display.py"),
    ],
)
def test_a_file_that_no_test_imports_has_tests_too(path: str, test: str) -> None:
    assert test in [word for words in select_tests(Path(path), 1) for word in words]


def test_a_shader_is_tried_by_the_nodes_that_call_its_function() -> None:
    text = (ROOT / "shaders/lib/color.glsl").read_text("utf-8")
    line = text.count("\n", 0, text.index("float srgb_decode(")) + 3
    assert list_users(Path("shaders/lib/color.glsl"), line)[:4] == ["color", "color_balance", "curves", "dither"]
    assert "oil" not in list_users(Path("shaders/color/levels.glsl"), 10) == ["levels"]
    chosen = select_tests(Path("shaders/lib/color.glsl"), line)[0]
    assert chosen[:2] == ["tests/nodes/test_color.py", "tests/nodes/test_curves.py"]


def test_slow_tests_come_late() -> None:
    listed = LIST.read_text("utf-8").split()
    for path in ("app/media/comparison/contact_sheet.py", "app/graph/walk.py", "shaders/lib/occlusion.glsl"):
        words = select_tests(Path(path), 20)[0]
        files = {word for word in words if word.endswith(".py")}
        assert {f"--deselect={name}" for name in listed if name.partition("::")[0] in files} <= {*words}
        assert not {*words} & {*listed}


def test_a_function_of_scripts_is_tried_by_the_nodes_that_need_it() -> None:
    path = FUNCTIONS / "slants.py"
    lines = (ROOT / path).read_text("utf-8").splitlines()
    assert list_scripted_nodes(path, 1) == []
    assert list_scripted_nodes(path, lines.index("SEARCH_LENGTHS = " + lines[11].partition(" = ")[2]) + 1) == ["smaa"]
    (words,) = select_tests(FUNCTIONS / "coverage.py", 54)
    assert "test_a_render_is_lit_as_by_the_node" in words[-1], "it makes its node by a function of its file"


def test_floors_rise_where_enough_was_tried_and_never_fall() -> None:
    floors = {"graph": 90.0, "color": 80.0, "media": 85.0}
    scores = {"graph": (40, 50), "color": (45, 50), "media": (9, 9), "cli": (49, 50)}
    assert raise_floors(floors, scores) == {"graph": 90.0, "color": 90.0, "media": 85.0, "cli": 98.0}
    kept = json.loads(run.FLOORS.read_text("utf-8"))
    assert {*kept} <= {room_of(path) for path in list_files()} and all(0.0 < floor <= 100.0 for floor in kept.values())


@pytest.mark.parametrize("repair", REPAIRS, ids=lambda repair: repair.name)
def test_repairs_can_be_undone(repair) -> None:
    """The text that a fault replaces, and the test that must notice it, are where they were."""
    source = (ROOT / repair.file).read_text("utf-8")
    ast.parse(repair.find_mutant(source).apply(source))
    file, _, name = repair.test.partition("::")
    tests = {
        item.name for item in ast.parse((ROOT / file).read_text("utf-8")).body if isinstance(item, ast.FunctionDef)
    }
    assert not name or name in tests
