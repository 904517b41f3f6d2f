"""`render -j`: helper processes that die, or that do not answer."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from halation.cli.execute_batch import _split_entries
from halation.renderer.jobs.render_entry import RenderEntry
from halation.renderer.jobs.render_job import RenderJob
from halation.resources.sandbox import UNRESTRICTED

GRAPH = {
    "halation": 1,
    "settings": {"size": [640, 360], "frames": [1, 400]},
    "outputs": {"image": {"type": "Image"}},
    "nodes": {"noise": {"type": "noise"}, "blur": {"type": "gaussian_blur"}},
    "links": {"blur.image": "noise.out", "outputs.image": "blur.out"},
    "animation": {"blur.sigma": {"keys": [{"frame": 1, "value": 5.0}, {"frame": 400, "value": 20.0}]}},
}


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
@pytest.mark.parametrize("ends_by", ["a helper that dies", "an interrupt"])
def test_a_helper_that_does_not_answer_is_killed_with_the_others(tmp_path: Path, ends_by: str) -> None:
    """One helper stands still, as in a long pass of a driver; the command ends all the same, and leaves no part."""
    (tmp_path / "shot.json").write_text(json.dumps(GRAPH))
    words = ("render", "shot.json", "-o", "f.####.exr", "-j", "2", "--progress=json")
    command = [sys.executable, "-m", "halation.cli", *words]
    with subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        first, second = json.loads(process.stderr.readline())["processes"]
        while '"done"' not in process.stderr.readline():
            assert process.poll() is None
        os.kill(second, signal.SIGSTOP)
        (tmp_path / f".halation-{second}-part").write_text("begun")
        if ends_by == "an interrupt":
            process.send_signal(signal.SIGINT)
        else:
            os.kill(first, signal.SIGKILL)
        _, said = process.communicate(timeout=60)
    assert process.returncode == (130 if ends_by == "an interrupt" else 1), said
    assert "interrupted" in said if ends_by == "an interrupt" else "ended from outside (SIGKILL)" in said, said
    assert not Path(f"/proc/{second}").exists() and not list(tmp_path.glob(".halation-*"))


@pytest.mark.parametrize(
    ("processes", "is_watched", "expected"),
    [(1, False, []), (0, False, []), (1, True, ["abcde"]), (0, True, ["abcde"]), (2, False, ["ace", "bd"]),
     (9, True, ["a", "b", "c", "d", "e"])],
)  # fmt: skip
def test_files_are_dealt_to_helpers_that_have_none_themselves(processes, is_watched, expected) -> None:
    """The command watches them: a helper has no limit of time. 0 is `-j auto`."""
    entries = tuple(RenderEntry(name) for name in "abcde")
    job = RenderJob(sandbox=UNRESTRICTED, entries=entries, processes=processes, timeout=9.0)
    parts = _split_entries(job, is_watched)
    assert ["".join(entry.file for entry in part.entries) for part in parts] == expected
    assert all((part.processes, part.timeout) == (1, 0.0) for part in parts)
