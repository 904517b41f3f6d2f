"""What the plugins of the suite promise, with small suites of their own."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from changes import covers, is_case_of, list_changes, name_changed_nodes, tries_all_nodes
from selection import LIST, name_function

ROOT = Path(__file__).parents[1]

Suite = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def suite(tmp_path: Path) -> Suite:
    """`suite(code, *words)` runs the tests in `code` with the plugins of this suite."""
    names = ("selection", "children", "costs", "failures", "recycling", "skips", "time_limits")
    words = " ".join(f"-p {name}" for name in names)
    (tmp_path / "pytest.ini").write_text(f"[pytest]\naddopts = {words}\ntimeout_grace = 1\nchild_memory = 1\n")

    def run_tests(code: str, *words: str) -> subprocess.CompletedProcess[str]:
        (tmp_path / "test_it.py").write_text(code)
        environment = {**os.environ, "PYTHONPATH": str(ROOT / "tests")}
        return subprocess.run(
            [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *words],
            cwd=tmp_path,
            env={name: text for name, text in environment.items() if not name.startswith("PYTEST_")},
            capture_output=True,
            text=True,
        )

    return run_tests


LIMITED = """
import ctypes, signal, time, pytest
from hypothesis import given, strategies

def test_before():
    assert True

@pytest.mark.timeout(0.5)
def test_python():
    while True:
        pass

@pytest.mark.timeout(0.5)
@given(strategies.integers())
def test_examples(number):
    while True:
        pass

@pytest.mark.timeout(0.5)
def test_wait():
    time.sleep(1000.0)

@pytest.mark.timeout(0.5)
@pytest.mark.parametrize("library", [ctypes.CDLL, ctypes.PyDLL])
def test_stuck(library):
    lock = ctypes.create_string_buffer(64)
    library(None).pthread_mutex_lock(lock)
    library(None).pthread_mutex_lock(lock)

def test_after():
    assert True
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGALRM")
def test_a_test_that_never_ends_is_named_and_the_rest_go_on(suite: Suite) -> None:
    """In Python, in Hypothesis, in a wait of the system, and in C with and without the lock of Python."""
    ended = suite(LIMITED, "-n", "1")
    assert ended.returncode == 1 and "5 failed, 2 passed" in ended.stdout, ended.stdout
    for name in ("test_python", "test_examples", "test_wait"):
        assert f"FAILED test_it.py::{name} - " in ended.stdout
        assert f"Overrun: test_it.py::{name} has not ended after 0.5 seconds" in ended.stdout
    for library in ("CDLL", "PyDLL"):
        assert f"crashed while running 'test_it.py::test_stuck[{library}]'" in ended.stdout
    assert "in test_stuck" in ended.stderr, "the stacks are printed"


SHARING = """
import os, pytest
from pathlib import Path

@pytest.fixture(scope="session")
def lamp():
    yield os.getpid()
    Path("off").open("a").write(f"{os.getpid()} ")

@pytest.mark.parametrize("number", range(3))
def test_lit(lamp, number):
    Path("on").open("a").write(f"{os.getpid()} ")
    assert lamp == os.getpid()
"""


@pytest.mark.skipif(sys.platform != "linux", reason="this system has no processes that are copies")
def test_files_run_in_children_that_end_when_they_are_large(suite: Suite, tmp_path: Path) -> None:
    """What tests share is made in each child and put away there; what crashes takes nothing else along."""
    (tmp_path / "test_next.py").write_text(SHARING)
    crash = "import os\ndef test_crash():\n    os._exit(7)\n"
    ended = suite(SHARING + crash, "-n", "1", "-W", "ignore")
    assert "1 failed, 6 passed" in ended.stdout, ended.stdout
    assert "crashed while running 'test_it.py::test_crash' (exit code 7)" in ended.stdout
    lit, off = (Path(tmp_path / name).read_text().split() for name in ("on", "off"))
    assert lit[:3] == lit[:1] * 3 and lit[3:] == lit[3:4] * 3 and lit[0] != lit[3]
    assert off == [lit[3]]  # the first child had no time for it


@pytest.mark.skipif(sys.platform != "linux", reason="this system has no processes that are copies")
def test_a_large_test_begins_in_a_child_of_its_own(suite: Suite, tmp_path: Path) -> None:
    large = "@pytest.mark.large\ndef test_large(lamp):\n    assert Path('on').open('a').write(f'{os.getpid()} ')\n"
    ended = suite(SHARING + large + "def test_after(lamp):\n    test_large(lamp)\n", "-n", "1", "-W", "ignore")
    assert "5 passed" in ended.stdout, ended.stdout
    lit, off = ((tmp_path / name).read_text().split() for name in ("on", "off"))
    assert lit == [lit[0]] * 3 + [lit[3]] * 2 and off == [lit[0], lit[3]]


def test_every_test_here_has_a_limit(request: pytest.FixtureRequest) -> None:
    assert float(request.config.getini("timeout")) == 300.0
    assert request.config.pluginmanager.hasplugin("timeout") and request.config.pluginmanager.hasplugin("time_limits")


def test_a_failure_is_shown_before_the_next_test_begins(suite: Suite) -> None:
    code = """
def test_wrong():
    assert 1 == 2
def test_next(capsys):
    with capsys.disabled():
        print("the next test")
    assert True
"""
    said = suite(code).stdout
    assert said.index("FAILED test_it.py::test_wrong - assert 1 == 2") < said.index("the next test")


LEAVING = """
import os, signal, subprocess, sys, time, pytest
from pathlib import Path
SLEEP = [sys.executable, "-c", "import time; time.sleep(1000)"]
def test_child():
    with pytest.warns(ResourceWarning):
        subprocess.Popen(SLEEP)
        __import__("gc").collect()
def test_orphan():
    assert subprocess.run(["sh", "-c", '"$@" >&- 2>&- & echo $! >number', "sh", *SLEEP]).returncode == 0
    command = Path("/proc", Path("number").read_text().strip(), "cmdline")
    while not command.read_bytes().startswith(sys.executable.encode()):  # for a moment it is still the shell
        time.sleep(0.01)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="it lists the processes of another one")
def test_processes_end_with_their_test_or_module(suite: Suite) -> None:
    ended = suite(LEAVING, "-n", "1", "-W", "ignore::pytest.PytestUnraisableExceptionWarning")
    assert "2 passed, 2 errors" in ended.stdout, ended.stdout
    for name in ("test_child", "test_orphan"):
        assert (
            f"test_it.py::{name} has left processes, which were ended: {sys.executable} -c import time" in ended.stdout
        )


@pytest.mark.skipif(sys.platform != "linux", reason="it lists the processes of another one")
def test_processes_end_with_a_worker_that_is_stuck(suite: Suite, tmp_path: Path) -> None:
    code = """
import ctypes, os, pytest
from pathlib import Path
@pytest.mark.timeout(0.5)
def test_stuck():
    os.system("sleep 1000 >&- 2>&- & echo $! >number")
    lock = ctypes.create_string_buffer(64)
    ctypes.CDLL(None).pthread_mutex_lock(lock)
    assert ctypes.CDLL(None).pthread_mutex_lock(lock)
"""
    assert "1 failed" in suite(code, "-n", "1").stdout
    command = Path("/proc", (tmp_path / "number").read_text().strip(), "cmdline")
    assert not command.exists() or not command.read_bytes(), "it has ended, or waits for its parent to notice that"


@pytest.mark.parametrize("workers", [0, 1])
@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
def test_children_hear_interrupts_though_a_shell_ignores_them(suite: Suite, workers: int) -> None:
    code = """
import signal, subprocess, sys
def test_interrupt():
    with subprocess.Popen([sys.executable, "-c", "print(1, flush=True); import time; time.sleep(1000)"],
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:
        process.stdout.readline()
        process.send_signal(signal.SIGINT)
    assert process.returncode == -signal.SIGINT
"""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        ended = suite(code, "-n", str(workers), "--timeout", "30")
    finally:
        signal.signal(signal.SIGINT, before)
    assert "1 passed" in ended.stdout, ended.stdout


@pytest.mark.parametrize(("ci", "ended"), [("", "1 skipped, 1 error"), ("true", "1 failed, 1 error")])
def test_skips_have_listed_reasons(suite: Suite, monkeypatch: pytest.MonkeyPatch, ci: str, ended: str) -> None:
    code = """
import pytest
def test_tool():
    pytest.skip("git is not installed")
@pytest.mark.skipif(True, reason="nobody likes it")
def test_unlisted():
    assert False
"""
    monkeypatch.setenv("CI", ci)
    said = suite(code).stdout
    assert ended in said and "is skipped (nobody likes it): list the reason in tests/skips.py" in said, said


def test_fast_tests_are_those_of_other_rooms_that_are_not_listed(tmp_path: Path) -> None:
    words = [sys.executable, "-m", "pytest", "--collect-only", "-q", "--fast", "tests/graph", "tests/law"]
    collected = subprocess.run(words, cwd=ROOT, capture_output=True, text=True).stdout.splitlines()
    names = {name_function(line) for line in collected if "::" in line}
    slow = set(LIST.read_text().split("\n"))
    assert any(name.startswith("tests/graph") for name in names) and not any("tests/law" in name for name in names)
    assert not names & slow and any(name.startswith("tests/graph") for name in slow)


@pytest.mark.parametrize(
    ("changed", "test", "covered"),
    [
        ("shaders/geometry/curvature.glsl", "tests/nodes/test_curvature.py", True),
        ("shaders/lib/geometry.glsl", "tests/nodes/test_curvature.py", True),
        ("shaders/lib/occlusion.glsl", "tests/nodes/test_contact_shadows.py", True),
        ("shaders/geometry/curvature.glsl", "tests/document/test_merging.py", False),
        ("nodes/geometry/curvature.py", "tests/nodes/test_curvature.py", True),
        ("app/graph/walk.py", "tests/graph/test_walk.py", True),
        ("app/graph/walk.py", "tests/color/test_views.py", False),
        ("app/cli/merge.py", "tests/cli/test_merge.py", True),
        ("tests/geometry.py", "tests/nodes/test_curvature.py", True),
        ("tests/conftest.py", "tests/nodes/test_curvature.py", True),
        ("tests/cli/conftest.py", "tests/nodes/test_curvature.py", False),
        ("tests/nodes/test_curvature.py", "tests/nodes/test_curvature.py", True),
        ("app/editor/code/panel.py", "tests/nodes/test_curvature.py", False),
    ],
)
def test_changed_files_are_covered_by_what_imports_them(changed: str, test: str, covered: bool) -> None:
    assert covers(ROOT / test, {ROOT / changed}) is covered


def test_a_changed_node_is_tried_by_the_tests_of_all_nodes(tmp_path: Path) -> None:
    (tmp_path / "nodes" / "color").mkdir(parents=True)
    (tmp_path / "nodes" / "color" / "fade.py").write_text("")
    changes = {tmp_path / name for name in ("nodes/color/fade.py", "shaders/lib/alpha.glsl", "app/fade.py")}
    assert name_changed_nodes(changes, tmp_path) == {"fade"}
    assert name_changed_nodes({tmp_path / "shaders/color/fade.glsl"}, tmp_path) == {"fade"}
    assert is_case_of("test_its_pixels_are_sound[bad pixels-fade]", {"fade"})
    assert not is_case_of("test_its_pixels_are_sound[bad pixels-fader]", {"fade"})
    assert tries_all_nodes(ROOT / "tests/renderer/test_regions.py")
    assert not tries_all_nodes(ROOT / "tests/nodes/test_curvature.py")


def test_every_module_of_the_lower_floors_is_covered() -> None:
    tests = [*(ROOT / "tests").rglob("test_*.py")]
    for folder in ("graph", "document", "compiler", "color", "renderer"):
        for module in (ROOT / "app" / folder).rglob("*.py"):
            assert any(covers(test, {module}) for test in tests), module


def test_changes_are_those_that_git_tells(tmp_path: Path) -> None:
    def git(*words: str) -> None:
        subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b", *words], cwd=tmp_path, check=True)

    with pytest.raises(pytest.UsageError, match="which does not know"):
        list_changes(tmp_path / "none")
    git("init", "-q")
    for name in ("a.py", "b.py", "c.py"):
        (tmp_path / name).write_text("")
    git("add", "a.py", "b.py")
    git("commit", "-qm", "first")
    (tmp_path / "b.py").write_text("1")
    assert list_changes(tmp_path) == {tmp_path / "b.py", tmp_path / "c.py"}


def test_the_list_of_slow_tests_names_tests_that_are_there() -> None:
    for name in filter(None, LIST.read_text().split("\n")):
        path, *_, function = name.split("::")  # of a class, too
        assert f"def {function}(" in (ROOT / path).read_text("utf-8"), (
            f"{name}: HALATION_RENEW=1 ./dev test --costs FILE"
        )


def test_costs_are_written(suite: Suite, tmp_path: Path) -> None:
    code = """
import subprocess, sys
def test_busy():
    spent = bytearray(100 << 20)
    assert sum(range(10_000_000))
def test_child():
    subprocess.run([sys.executable, "-c", "sum(range(10_000_000))"], check=True)
    assert True
def test_idle():
    assert True
"""
    ended = suite(code, "--costs", "costs.json")
    assert ended.returncode == 0 and "tests that take most processor time" in ended.stdout
    costs = json.loads((tmp_path / "costs.json").read_text())
    seconds = {name.partition("::")[2]: spent for name, spent in costs["seconds"].items()}
    assert seconds["test_idle"] < min(seconds["test_busy"], seconds["test_child"])
    assert 100 << 20 < costs["peak_bytes"]["this process"] < 1 << 30
