"""What this machine is said to have, against what the system itself says."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from halation.resources import machine

GIB = 2**30


@pytest.mark.skipif(sys.platform == "win32", reason="signals and limits are those of POSIX")
@pytest.mark.parametrize(("soft", "hard"), [(6, 8), (8, 8), (None, None)])
def test_the_limit_that_holds_is_the_soft_one(soft: int | None, hard: int | None) -> None:
    code = "from halation.resources.machine import has_memory_limit, is_memory_scarce, memory_limit\n"
    code += "print(memory_limit(), has_memory_limit(), is_memory_scarce())"
    limit = f"ulimit -Hv {hard * GIB // 1024}; ulimit -Sv {soft * GIB // 1024}; " if soft and hard else ""
    words = ["sh", "-c", f'{limit}exec "$0" -c "$1"', sys.executable, code]
    ended = subprocess.run(words, capture_output=True, text=True, check=True)
    assert ended.stdout.split() == [str(soft * GIB) if soft else "inf", str(bool(soft)), "False"]


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux keeps to it")
def test_memory_is_scarce_once_much_of_the_limit_was_asked_for() -> None:
    code = """
import mmap, sys
from halation.resources.machine import is_memory_scarce
held = []
for step in range(10):
    held.append(mmap.mmap(-1, 128 << 20))
    print(int(is_memory_scarce()), int(next(line for line in open("/proc/self/status") if "VmPeak" in line).split()[1]))
"""
    words = ["sh", "-c", 'ulimit -Sv 1572864; exec "$0" -c "$1"', sys.executable, code]
    ended = subprocess.run(words, capture_output=True, text=True, check=True)
    rows = [tuple(map(int, line.split())) for line in ended.stdout.splitlines()]
    assert [bool(scarce) for scarce, _ in rows] == [peak > 0.75 * 1572864 for _, peak in rows]
    assert not rows[0][0] and rows[-1][0]


@pytest.mark.parametrize(
    ("quota", "cores"),
    [("max 100000", 8), ("150000 100000", 2), ("50000 100000", 1), ("400000 50000", 8), ("1600000 100000", 8),
     ("300000 0", 8), ("", 8)],
)  # fmt: skip
def test_a_container_has_the_processors_whose_time_it_may_take(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, quota: str, cores: int
) -> None:
    """`cpu.max` is a time and the period that it is of: begun processors count (Linux, "Control Group v2")."""
    (tmp_path / "cpu.max").write_text(f"{quota}\n")
    monkeypatch.setattr(machine, "_CONTROL_GROUP", tmp_path)
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: range(8), raising=False)
    assert machine.available_cores() == cores
