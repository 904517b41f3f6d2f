"""What a terminal shows of a job on a cluster."""

from __future__ import annotations

import os
import re
import subprocess

import pytest
from farms import PYTHON, SLOW, customize

pytest.importorskip("distributed", reason="Dask is not installed")
pytestmark = pytest.mark.skipif(os.name == "nt", reason="POSIX")

CONTROLS = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
"""Sequences that move the cursor and color the text (ECMA-48, 8.3)."""


def run_on_terminal(*words: str, cwd, **variables: str) -> tuple[int, str]:
    """Run a command of Halation whose standard error is a terminal of 200 columns: its exit code and what it showed."""
    import fcntl
    import struct
    import termios

    near, far = os.openpty()
    fcntl.ioctl(far, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 200, 0, 0))
    environment = {**os.environ, "TERM": "xterm", "LP_NUM_THREADS": "1", **variables}
    command = [PYTHON, "-m", "halation.cli", *words]
    with subprocess.Popen(command, cwd=cwd, env=environment, stdout=subprocess.DEVNULL, stderr=far) as process:
        os.close(far)
        shown = b""
        while part := read_part(near):
            shown += part
    os.close(near)
    return process.returncode, CONTROLS.sub("", shown.decode())


def read_part(terminal: int) -> bytes:
    """What a terminal shows next; nothing after the last program has closed it."""
    try:
        return os.read(terminal, 1 << 16)
    except OSError:
        return b""


def test_the_bar_shows_frames_workers_the_time_left_and_the_slowest_frames(shot, tmp_path):
    slow = customize(tmp_path / "slow", SLOW)
    code, shown = run_on_terminal("render", "shot.json", "-o", "f.####.exr", "--cluster", "local:2", cwd=shot, **slow)
    assert code == 0 and len(list(shot.glob("f.*.exr"))) == 8, shown
    line = (
        r"(\d)/8 frames (?:\d+:\d\d:\d\d|-:--:--) left 2 workers, slowest \d \(\d+\.\d s\)(?:, \d \(\d+\.\d s\)){0,2}\s"
    )
    counts = [int(count) for count in re.findall(line, shown)]
    assert counts and counts == sorted(counts) and counts[0] < 8, shown
    assert re.search(r"8 of 8 frames, \d+\.\d\d s, 2 workers\s+slowest: frame \d \d+\.\d\d s", shown), shown
