"""Little memory (`ulimit -v`): one sentence and a documented exit code, whatever the libraries do then."""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from halation.cli.outcome import describe_fault
from oiio_pictures import write_picture
from selection import list_cases

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux keeps to it")


def limit(mebibytes: int) -> Callable[[], None]:
    return lambda: resource.setrlimit(resource.RLIMIT_AS, (mebibytes << 20, mebibytes << 20))


HALATION = (sys.executable, "-P", "-m", "halation.cli")
SUITE = """[cases.one]
graph = "g.json"
size = "24x16"
golden = "one.exr"
"""
EVERY_COMMAND = [
    ("render", "g.json", "-o", "b.####.exr", "--frames", "1-4", "-j", "2"),
    ("sweep", "g.json", "--set", "n.sigma=1,5", "-o", "sheet.png"),
    ("test", "--update"),
    ("bench", "g.json"),
    ("reproduce", "earlier.exr"),
    ("gallery", "-o", "gallery.png"),
    ("demo", "-o", "demo"),
]
"""Those that render, beside the plain `render`."""


def write_files(folder: Path) -> None:
    """A graph that reads a picture and blurs it, and a suite with it."""
    write_picture(folder / "a.exr", np.full((8, 8, 4), 0.5, np.float32))
    nodes = {"r": {"type": "read_image", "values": {"path": "a.exr"}}, "n": {"type": "gaussian_blur"}}
    graph = {"halation": 1, "outputs": {"image": {"type": "Image"}}, "nodes": nodes}
    graph["links"] = {"outputs.image": "n.out", "n.image": "r.out"}
    (folder / "g.json").write_text(json.dumps(graph))
    (folder / "looks.suite.toml").write_text(SUITE)


def check_end(folder: Path, words: tuple[str, ...], mebibytes: int, **variables: str) -> None:
    """Run a command within a limit: it works, or says in one sentence why not."""
    ended = subprocess.run(
        [*HALATION, *words],
        cwd=folder,
        capture_output=True,
        text=True,
        errors="replace",
        timeout=60,
        preexec_fn=limit(mebibytes),
        env={**os.environ, "LP_NUM_THREADS": "1", **variables},
    )
    assert ended.returncode in (0, 1, 5), (ended.returncode, ended.stderr)
    assert "Traceback" not in ended.stderr and "bug in Halation" not in ended.stderr
    if ended.returncode and " failed in " not in ended.stderr:  # as tests report it
        assert sum(line.startswith("halation: ") for line in ended.stderr.splitlines()) == 1, ended.stderr
    assert not [path for path in folder.iterdir() if ".halation-" in path.name]


@pytest.mark.parametrize("mebibytes", list_cases((100, 250, 600, 1000, 1400), (170, 400, 800, 1150, 1700)))
@pytest.mark.parametrize(
    "words", [("render", "g.json", "-o", "b.exr"), ("info", "a.exr"), ("check", "g.json")], ids=" ".join
)
def test_every_limit(tmp_path: Path, words, mebibytes):
    write_files(tmp_path)
    check_end(tmp_path, words, mebibytes, OPENIMAGEIO_THREADS="1")


@pytest.mark.parametrize("mebibytes", list_cases((304, 600), (500, 700, 800)))
@pytest.mark.parametrize("words", EVERY_COMMAND, ids=lambda words: words[0])
def test_every_command(tmp_path: Path, words, mebibytes):
    """Between 500 and 800 MiB Mesa opens, and ends the process later; near 300 OpenEXR waited for a thread for ever."""
    write_files(tmp_path)
    if words[0] == "reproduce":
        subprocess.run([*HALATION, "render", "g.json", "-o", "earlier.exr"], cwd=tmp_path, check=True)
    check_end(tmp_path, words, mebibytes)


@pytest.mark.parametrize("code", [127, 1, 0])
def test_a_library_that_ends_the_process_leaves_a_sentence(code: int):
    """Without memory the loader of libraries prints ABORT and ends the process with 127; OpenBLAS ends it with 1."""
    words = f"import os; from halation.cli import program; program.run = lambda words: os._exit({code})"
    ended = subprocess.run(
        [sys.executable, "-P", "-c", f"{words}; print(program.run_process([]))"],
        capture_output=True, text=True, timeout=60, preexec_fn=limit(4000),
    )  # fmt: skip
    assert ended.stdout == "1\n"
    assert ended.stderr.startswith(
        f"halation: the driver ended the process (code {code}), as drivers do without enough"
    )


@pytest.mark.parametrize("code", [0, 1, 5, 127])
def test_a_limited_command_keeps_its_code(code: int):
    words = f"from halation.cli import program; program.run = lambda words: {code}; print(program.run_process([]))"
    ended = subprocess.run(
        [sys.executable, "-P", "-c", words], capture_output=True, text=True, timeout=60, preexec_fn=limit(4000)
    )
    assert (ended.stdout, ended.stderr) == (f"{code}\n", "")


def test_a_limited_command_can_be_interrupted(tmp_path: Path):
    """The signal reaches the process that works, although another one was sent it."""
    write_files(tmp_path)
    command = [*HALATION, "watch", "g.json", "-o", "b.exr"]
    with subprocess.Popen(
        command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, preexec_fn=limit(4000)
    ) as process:
        assert process.stdout
        while "1 pass" not in (line := process.stdout.readline()) and "passes" not in line:
            assert line, "it ended before the first picture"
        process.send_signal(signal.SIGTERM)
        assert "interrupted" in process.stdout.read()
    assert process.returncode == 130


@pytest.mark.parametrize(
    "fault",
    [
        RuntimeError("can't start new thread"),
        ImportError("liba.so: failed to map segment from shared object"),
        RuntimeError("std::bad_alloc"),
        OSError("Cannot allocate memory"),
        RuntimeError("exr_start_read (EXR_ERR_OUT_OF_MEMORY) Unable to allocate memory"),
        MemoryError(),
    ],
    ids=str,
)
def test_what_libraries_say_without_memory(fault: BaseException):
    """Each says it in its own words, which is no bug of ours."""
    facts = describe_fault(fault)
    assert (facts["kind"], facts["exit_code"]) == ("MemoryError", 1) and "memory" in facts["message"]
