"""The script `dev` sets everything up, and says in plain words where it cannot."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="dev is a shell script")


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A folder with nothing but the script and what it reads, at a path with a space."""
    folder = tmp_path / "a checkout"
    folder.mkdir()
    for name in ("dev", "pyproject.toml"):
        shutil.copy(ROOT / name, folder / name)
    return folder


def dev(checkout: Path, *words: str, commands: dict[str, str]) -> subprocess.CompletedProcess[str]:
    """Run the script where only a few system tools and `commands` (name -> shell code) exist."""
    tools = checkout.parent / "tools"
    tools.mkdir()
    for name in ("cat", "cksum", "dirname", "grep", "id", "rm", "sh", "tail", "tee", "uname"):
        (tools / name).symlink_to(shutil.which(name) or name)
    for name, code in commands.items():
        (tools / name).write_text(f"#!/bin/sh\n{code}\n")
        (tools / name).chmod(0o755)
    return subprocess.run(
        [checkout / "dev", *words],
        env={**os.environ, "PATH": str(tools)},
        cwd="/",
        capture_output=True,
        text=True,
        stdin=subprocess.DEVNULL,
    )


@pytest.mark.parametrize("word", ["", "help", "--help", "-h"])
def test_help(checkout: Path, word: str) -> None:
    result = dev(checkout, *filter(None, [word]), commands={})
    assert result.returncode == 0
    assert all(f"./dev {task}" in result.stdout for task in ("demo", "edit", "test", "renew", "release", "site"))


def test_an_unknown_word_is_a_usage_error(checkout: Path) -> None:
    result = dev(checkout, "tests", commands={})
    assert (result.returncode, result.stdout) == (2, "")
    assert "./dev test" in result.stderr


@pytest.mark.parametrize(
    ("commands", "sentence"),
    [
        ({}, "none was found"),
        ({"python3": '[ "$1" = --version ] && echo Python 3.9.2 && exit; exit 1'}, "Python 3.9.2 was found"),
    ],
)
def test_python_is_missing_or_too_old(checkout: Path, commands: dict[str, str], sentence: str) -> None:
    result = dev(checkout, "demo", commands=commands)
    assert result.returncode == 1
    assert "Python 3.11 or newer" in result.stderr and sentence in result.stderr
    assert "apt-get install python3 python3-venv" in result.stderr
    assert not (checkout / ".venv").exists()


def test_venv_is_missing(checkout: Path) -> None:
    result = dev(checkout, "test", commands={"python3": "case $2 in *ensurepip*) exit 1 ;; esac"})
    assert result.returncode == 1
    assert result.stderr.rstrip().endswith("apt-get install python3-venv")


FAKE = """
case $1 in
    -c) case $2 in *version_info\\[*) echo 3 99 ;; *_base_exec*) echo "$0" ;; *CDLL*) exit {gl} ;; esac ;;
    -m) case $2 in
        venv) echo venv >>log; d=.venv/bin; {make} -p $d && {copy} "$0" $d/python && {copy} "$0" $d/halation ;;
        pip) echo pip "$@" >>log; echo Collecting a; echo ERROR: no network; exit {pip} ;;
        pytest | mkdocs) echo run "$@" >>log; exit 7 ;;
    esac ;;
    demo | edit | tests/*.py) echo run "$@" >>log; exit 7 ;;
esac
"""


def fake(gl: int = 0, pip: int = 0) -> dict[str, str]:
    """A Python that only writes down what it is asked to do; running Halation or the tests exits with 7."""
    return {"python3": FAKE.format(gl=gl, pip=pip, make=shutil.which("mkdir"), copy=shutil.which("cp"))}


def test_set_up_happens_once_and_again_when_something_changed(checkout: Path) -> None:
    log = checkout / "log"
    result = dev(checkout, "demo", "--json", commands=fake())
    assert result.returncode == 7, result.stderr
    venv, pip, run = log.read_text().splitlines()
    assert (venv, pip.split()[-2:], run.split()[-4:]) == ("venv", ["-e", "."], ["demo", "-o", "out", "--json"])

    def steps(*words: str) -> list[str]:
        log.unlink()
        shutil.rmtree(checkout.parent / "tools")
        assert dev(checkout, *words, commands=fake()).returncode == 7
        return [line.split()[0] for line in log.read_text().splitlines()]

    assert steps("demo") == ["run"]
    assert steps("edit", "look.json") == ["run"]
    assert steps("test") == ["pip", "run"]
    assert steps("demo") == ["run"]
    (checkout / "pyproject.toml").write_text("changed")
    assert steps("demo") == ["pip", "run"]
    assert steps("test") == ["run"]
    (checkout / ".venv/ready").unlink()
    assert steps("test") == ["venv", "pip", "run"]
    (checkout / ".venv/bin/python").unlink()
    assert steps("test") == ["venv", "pip", "run"]


TASKS = {
    "renew": (".[test]", "tests/generated_pages.py"),
    "release": (".[release]", "tests/release.py"),
    "site": (".[docs]", "-m mkdocs build -f tests/site/mkdocs.yml"),
}


@pytest.mark.parametrize("task", TASKS)
def test_a_task_installs_what_it_needs(checkout: Path, task: str) -> None:
    result = dev(checkout, task, commands=fake())
    assert result.returncode == 7, result.stderr
    venv, pip, run = (checkout / "log").read_text().splitlines()
    extra, script = TASKS[task]
    assert (venv, pip.split()[-2:], run.split()) == ("venv", ["-e", extra], ["run", *script.split()])


def test_a_task_keeps_what_another_one_installed(checkout: Path) -> None:
    extras = []
    for task in ("demo", "test", "release", "demo", "test", "release"):
        assert dev(checkout, task, commands=fake()).returncode == 7
        shutil.rmtree(checkout.parent / "tools")
        extras += [line.split()[-1] for line in (checkout / "log").read_text().splitlines() if "pip" in line]
        (checkout / "log").unlink()
    assert extras == [".", ".[test]", ".[test,release]"]


def test_a_moved_checkout_gets_a_new_venv(checkout: Path) -> None:
    dev(checkout, "test", commands=fake())
    shutil.rmtree(checkout.parent / "tools")
    moved = checkout.rename(checkout.with_name("moved"))
    (moved / "log").unlink()
    dev(moved, "test", "-k", "word", commands=fake())
    venv, pip, run = (moved / "log").read_text().splitlines()
    assert (venv, pip.split()[-2:], run.split()[-2:]) == ("venv", ["-e", ".[test]"], ["-k", "word"])


def test_a_failed_pip_is_shown_and_tried_again(checkout: Path) -> None:
    result = dev(checkout, "test", commands=fake(pip=1))
    assert result.returncode == 1
    assert "ERROR: no network" in result.stderr and "pip failed" in result.stderr
    assert not (checkout / ".venv/ready").exists()


@pytest.mark.skipif(sys.platform != "linux", reason="other systems bring OpenGL")
def test_opengl_is_missing_and_nobody_may_install_it(checkout: Path) -> None:
    commands = {**fake(gl=1), "id": "echo 1000", "apt-get": "exit 9", "sudo": "exit 1"}
    result = dev(checkout, "demo", commands=commands)
    assert result.returncode == 1
    assert result.stderr.rstrip().endswith("sudo apt-get install -y --no-install-recommends libegl1 libgl1")
    assert not (checkout / ".venv").exists()


@pytest.mark.skipif(sys.platform != "linux", reason="other systems bring OpenGL")
def test_opengl_is_installed_where_it_may(checkout: Path) -> None:
    commands = {**fake(gl=1), "id": "echo 0", "apt-get": 'echo apt-get "$@" >>log'}
    result = dev(checkout, "demo", commands=commands)
    assert "apt-get install -y --no-install-recommends libegl1 libgl1 -q" in (checkout / "log").read_text()
    assert result.returncode == 1 and "failed" in result.stderr
