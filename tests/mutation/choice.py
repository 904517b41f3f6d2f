"""Which tests a fault is shown to: those that reach its file, the nearest first.

Where `reach.py` has recorded which tests run a line, those come first, and other tests of recorded files are left out.
A test file reaches what `--changed` finds by its imports (`changes.py`), what these modules import in turn, and the
command that it runs by its name. Of the tests that drive the real editor, which takes minutes, it sees those named
after the folder or the file. A function of exported scripts is text that no module imports: it is tried by the cases
of all nodes whose scripts need it.
"""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Collection, Iterator
from functools import cache
from itertools import accumulate
from pathlib import Path

from changes import TESTS, covers, list_helpers
from import_graph import MODULES, ROOT, links, name_of, targets
from mutation.reach import is_outside_functions, list_runners, read_record
from mutation.shader_users import list_users
from selection import LIST

FILES = 12
"""The most test files that see a fault, the nearest ones: what is basic is imported by all."""

RUNNING_SECONDS = 60.0
"""Seconds of a processor for tests that were seen to run a line; one quick test alone takes up to thirty."""

SLOW_FILES = 6
"""The test files whose slow tests see a fault too: those of twelve files take two minutes."""

USING_FILES = 8
"""The most test files of nodes whose shaders call the function of a fault."""

NEAREST = 2
"""The files of tests that see a fault before all others: most faults are noticed there, and few files are read soon."""

DRIVING_FILES = 3
"""The most test files that drive the real editor: each takes half a minute."""

SKIPPED_ROOMS = ("bench", "gui", "hostile", "law", "mutation")
"""Rooms of tests that no fault is shown to, the editor's excepted: each takes minutes, or reads the tree itself."""

PAGES = "tests/law/test_generated.py"
"""Defaults of values and options are in the pages that are made of the code; they are compared in a second."""

GUIDES = tuple(f"tests/editor/panels/test_{name}_guide.py" for name in ("layout", "style"))
"""What every panel draws, and where: few changes of the editor's drawing escape them, wherever they are."""

RULES = tuple(f"tests/editor/panels/test_{name}.py" for name in ("clicked_acts", "moved_panels", "menu_items"))
"""What holds for every panel: what clicks and entries of menus do, and how all of it grows with the interface."""

DRAWING_ROOMS = ("color", "custom_nodes", "nodes", "renderer")
"""Rooms of tests that look at what shaders draw."""

EDITOR = "app", "editor"
"""Where the path of a file of the editor begins."""

FUNCTIONS = Path("app/export/python/functions")
"""The text of exported scripts."""

SCRIPT_TESTS = tuple(f"tests/cli/test_export_{name}.py" for name in ("numbers", "python", "python_time",
                     "python_cameras", "python_lamps"))  # fmt: skip
"""The tests with a case for each node that a script can have."""

_COMMAND = re.compile(r'\bcli\(\s*"([\w-]+)"')


def select_tests(path: Path, line: int) -> list[list[str]]:
    """The arguments of each run of pytest that a fault in this line is shown to, the quickest tests first."""
    if path.parent == FUNCTIONS:
        if not (names := {*list_scripted_nodes(path, line)}):
            return [[*SCRIPT_TESTS]]
        names |= {path.stem, *(name for file in SCRIPT_TESTS for name in _list_naming_tests(file, names))}
        return [[*SCRIPT_TESTS, "-k", " or ".join(sorted(names))]]
    tests = list_tests(path, line)
    listed = LIST.read_text("utf-8").split()
    slow = [name for name in listed if file_of(name) in tests[:SLOW_FILES]]
    nearest = dict.fromkeys(tests[:NEAREST])
    driving = list_driving_tests(path)
    if runners := choose_runners(path, line, tests):
        recorded = {file_of(name) for name in read_record()[1]}
        runners += list_fresh_tests([test for test in tests if test in recorded])
        tests, driving = ([test for test in some if test not in recorded] for some in (tests, driving))
    near = [*dict.fromkeys(file_of(name) for name in runners)][:SLOW_FILES]  # their slow tests are not in the record
    slow += [name for name in listed if file_of(name) in near and name not in slow]
    is_outside = path.suffix == ".py" and is_outside_functions(path, line)  # what a constant changes, was not recorded
    first = [test for test in (nearest if is_outside else tests) if test in nearest]
    seen = dict.fromkeys(name for name in (*runners, *slow) if file_of(name) in nearest)
    late = [name for name in seen if name in listed]
    first += [name for name in seen if name not in listed and file_of(name) not in first]
    first += [f"--deselect={name}" for name in listed if file_of(name) in first]
    tests = [test for test in tests if test not in nearest]
    runners, slow = ([name for name in some if file_of(name) not in nearest] for some in (runners, slow))
    kin, far = ([name for name in runners if (file_of(name) in near) is wanted] for wanted in (True, False))
    quick = [*tests, *(f"--deselect={name}" for name in listed if file_of(name) in tests)] if tests else []
    pages = [PAGES] if path.suffix == ".py" else []
    guides, rules = ([*GUIDES], [*RULES]) if path.parts[:2] == EDITOR else ([], [])
    return [words for words in (first, guides, kin, pages, rules, late, far, quick, slow, driving) if words]


def file_of(name: str) -> str:
    """The file of a test."""
    return name.partition("::")[0]


def choose_runners(path: Path, line: int, near: list[str]) -> list[str]:
    """The tests that were seen to run a line: those of near files first, then those that run little else."""
    if path.suffix != ".py" or not (counts := list_runners(path, line)):
        return []
    places, seconds = {test: place for place, test in enumerate(near)}, read_record()[1]
    names = sorted(counts, key=lambda name: (places.get(file_of(name), FILES), counts[name]))
    ends = accumulate(seconds[name] for name in names)
    return [name for name, end in zip(names, ends, strict=True) if end - seconds[name] <= RUNNING_SECONDS]


def list_fresh_tests(files: list[str]) -> list[str]:
    """The tests of files that the record does not know, because they were written after it."""
    return [name for file in files for name in _list_names(file) if name not in read_record()[1]]


def list_tests(path: Path, line: int = 0) -> list[str]:
    """The test files that reach a file, the nearest first: of its own name, of its room, then all others.

    Those that `--changed` runs come first, then those whose names are like that of the file or its folder; where both
    are few, those from which imports lead to the file. For a line of a shader the tests of the nodes come before all,
    whose shaders call its function.
    """
    kin = list_kin(path)
    distances = _measure_distances([name_of(ROOT / file) for file in kin if file.suffix == ".py"])

    def measure_distance(test: Path) -> tuple[object, ...]:
        name, folder = test.stem.removeprefix("test_"), test.parent.name
        is_twin = name.rstrip("s") == path.stem.rstrip("s")
        is_named = path.stem in test.read_text("utf-8")
        taken = _count_imports(test, path.stem) if path.suffix == ".py" else 0  # more of a module: a closer look at it
        return not is_twin, -taken, not is_named, folder not in path.parts, folder == "nodes", distances.get(test, 0)

    tests = [test for test in _list_test_files() if _room_of(test) not in SKIPPED_ROOMS]
    chosen = list_tests_of_shaders(list_users(path, line)) if path.suffix != ".py" and line else []
    chosen += sorted((test for test in tests if covers(test, {ROOT / path})), key=measure_distance)
    others = [test for test in tests if path.suffix == ".py" or _room_of(test) in DRAWING_ROOMS]
    alike = {test: likeness for test in others if (likeness := _count_words(kin, test))}
    chosen += sorted(alike, key=lambda test: (-alike[test], distances.get(test, 99), measure_distance(test)))
    if path.suffix != ".py":  # a shader that many draw with: tests that speak of it
        chosen += [test for test in others if path.stem in test.read_text("utf-8")]
    far = sorted((test for test in tests if test in distances), key=lambda test: (distances[test], str(test)))
    chosen += far if len(set(chosen)) < SLOW_FILES else []
    return [str(test.relative_to(ROOT)) for test in dict.fromkeys(chosen)][:FILES]


def list_tests_of_shaders(stems: list[str]) -> list[Path]:
    """The tests that are named after shaders; they leave room for others."""
    named = {test.stem.removeprefix("test_"): test for test in _list_test_files() if _room_of(test) == "nodes"}
    return [named[stem] for stem in stems if stem in named][:USING_FILES]


def list_kin(path: Path) -> set[Path]:
    """A file itself, the shaders that include it, and the modules that name one of these."""
    if path.suffix == ".py":
        return {path}
    names, new = set[str](), {str(path.relative_to("shaders").with_suffix(""))}
    while new:
        names |= new
        new = {name for name, text in _read_shaders().items() if any(f'"{old}.glsl"' in text for old in names)} - names
    texts = {file: file.read_text("utf-8") for file in MODULES.values()}
    start = f'"{path.parent.name}/{{'  # the rest of the name is put together
    modules = {file for file, text in texts.items() if any(name in text for name in names) or start in text}
    return {*(Path("shaders", f"{name}.glsl") for name in names), *(file.relative_to(ROOT) for file in modules)}


def list_driving_tests(path: Path) -> list[str]:
    """The tests of the real editor that are named after a file of it or after its folder, the file's first."""
    if path.parts[:2] != EDITOR:
        return []
    words = {path.stem.rstrip("s"), *(part.rstrip("s") for part in path.parts[2:-1])}
    found = [test for test in _list_test_files() if _room_of(test) == "gui"]
    found = [test for test in found if any(word in test.stem for word in words)]
    found.sort(key=lambda test: (path.stem.rstrip("s") not in test.stem, len(test.stem), test.stem))
    return [str(test.relative_to(ROOT)) for test in found[:DRIVING_FILES]]


def list_scripted_nodes(path: Path, line: int) -> list[str]:
    """The nodes whose scripts need the function or constant in this line of a file of functions."""
    from halation.export.python.library import load_library
    from halation.nodes import catalogue

    library, source = load_library(), (ROOT / path).read_text("utf-8")
    here = {
        name
        for name, definition in library.definitions.items()
        if (start := source.find(definition.text)) >= 0
        and 0 <= line - 1 - source.count("\n", 0, start) <= definition.text.count("\n")
    }
    needed = {id: {each.name for each in library.collect([id])} for id in catalogue() if library.find_function(id)}
    return [id for id, names in needed.items() if names & here]


@cache
def _list_test_files() -> tuple[Path, ...]:
    return tuple(sorted(TESTS.rglob("test_*.py")))


@cache
def _read_shaders() -> dict[str, str]:
    folder = ROOT / "shaders"
    return {str(file.relative_to(folder).with_suffix("")): file.read_text("utf-8") for file in folder.rglob("*.glsl")}


@cache
def _list_names(file: str) -> tuple[str, ...]:
    """The tests of a file, those of its classes too."""
    body = ast.parse((ROOT / file).read_text("utf-8")).body
    groups = [(f"{file}::", body)] + [
        (f"{file}::{each.name}::", each.body) for each in body if isinstance(each, ast.ClassDef)
    ]
    found = [(head, each) for head, part in groups for each in part if isinstance(each, ast.FunctionDef)]
    return tuple(f"{head}{each.name}" for head, each in found if each.name.startswith("test_"))


def _list_naming_tests(file: str, nodes: Collection[str]) -> Iterator[str]:
    """The tests of a file whose text names one of these nodes, or a function of the file that does."""
    source = (ROOT / file).read_text("utf-8")
    functions = [each for each in ast.walk(ast.parse(source)) if isinstance(each, ast.FunctionDef)]
    texts = {each.name: ast.get_source_segment(source, each) or "" for each in functions}
    words = [f'"{node}"' for node in nodes]
    words += [f"{name}(" for name, text in texts.items() if any(word in text for word in words)]
    yield from (name for name, text in texts.items() if name.startswith("test_") and any(map(text.__contains__, words)))


def _room_of(test: Path) -> str:
    return test.relative_to(TESTS).parts[0]


def _count_words(files: Collection[Path], test: Path) -> int:
    """How many words the names of files and of a test share, as `serving` and `serve` do."""
    parts = {part for file in files for part in file.with_suffix("").parts[1:]}
    words = {word[:4] for part in parts for word in part.split("_") if len(word) > 2}
    names = (_room_of(test).replace("cli", ""), test.stem.removeprefix("test_"))  # each command has its own file
    return len(words & {word[:4] for name in names for word in name.split("_")})


@cache
def _count_imports(test: Path, module: str) -> int:
    """How many names a test file imports from modules of a name."""
    imports = [each for each in ast.walk(ast.parse(test.read_text("utf-8"))) if isinstance(each, ast.ImportFrom)]
    return sum(len(each.names) for each in imports if (each.module or "").endswith(f".{module}"))


@cache
def _list_entries(test: Path) -> frozenset[str]:
    """The modules that a test file and its helpers import, and those of the commands that it runs."""
    names = {name for path in list_helpers(test) if path.name != "conftest.py" for name in _read_entries(path)}
    return frozenset(names & {*MODULES})


@cache
def _read_entries(path: Path) -> frozenset[str]:
    text = path.read_text("utf-8")
    commands = (f"halation.cli.{name.replace('-', '_')}" for name in _COMMAND.findall(text))
    return frozenset({*targets(ast.parse(text), ""), *commands})


@cache
def _list_importers() -> dict[str, set[str]]:
    importers = defaultdict[str, set[str]](set)
    for name, target in links():
        importers[target].add(name)
    return importers


def _measure_distances(modules: Collection[str]) -> dict[Path, int]:
    """How many imports lie between the test files and the modules that they reach."""
    distances, new = dict.fromkeys(modules, 0), {*modules}
    while new:
        new = {name for at in new for name in _list_importers().get(at, ())} - {*distances}
        distances |= dict.fromkeys(new, max(distances.values(), default=0) + 1)
    return {
        test: min(distances[name] for name in entries)
        for test in _list_test_files()
        if (entries := _list_entries(test) & {*distances})
    }
