"""What a render begins before its command is imported: the driver on another thread, or a copy that is watched."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from halation.presets import paths

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux keeps to it")

PROBE = """
import os, sys
from halation.cli.head_start import begin_early
first = os.getpid()
code = begin_early(sys.argv[1:])
if code is not None:
    print("watched", code, flush=True)
elif os.getpid() != first:
    print("copy", "typer" in sys.modules, os.getppid() == first, flush=True)
    os._exit(7)
else:
    print("alone", "halation.renderer.opengl.warming" in sys.modules, flush=True)
os._exit(0)
"""
"""Prints who goes on, and whether the driver is being loaded. It ends at once, as the command line does: an ordinary
end takes libraries apart, and LLVM, if it is being loaded on a thread meanwhile, may never come back."""


NO_PROCESSES = """
def refuse():
    raise BlockingIOError("Resource temporarily unavailable")
os.fork = refuse
"""
NO_THREADS = """
import threading
def refuse(thread):
    raise RuntimeError("can't start new thread")
threading.Thread.start = refuse
"""
THREADS = """
import threading, time
threading.Thread(target=time.sleep, args=(1.0,), daemon=True).start()
"""


def begin(folder: Path, *words: str, kind: str = "ramp", before: str = "") -> list[str]:
    path = folder / "graph.json"
    path.write_text(json.dumps({"halation": 1, "nodes": {"a": {"type": kind}}}))
    probe = PROBE.replace("first =", f"{before}\nfirst =")
    command = [sys.executable, "-c", probe, *(str(path) if word == "GRAPH" else word for word in words)]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


def test_a_graph_without_code_loads_the_driver_at_once(tmp_path: Path) -> None:
    assert begin(tmp_path, "render", "GRAPH", "-o", "out.exr") == ["alone True"]
    assert begin(tmp_path, "render", "-o", "out.exr", "GRAPH") == ["alone True"]


@pytest.mark.parametrize("kind", ["glsl", "isf"])
def test_a_graph_with_code_goes_on_in_a_copy_before_anything_is_imported(tmp_path: Path, kind: str) -> None:
    assert begin(tmp_path, "render", "GRAPH", "-o", "out.exr", kind=kind) == ["copy False True", "watched 7"]


@pytest.mark.parametrize(
    "words",
    [
        "check GRAPH",
        "render --help",
        "render GRAPH -o out.exr -j 2",
        "render GRAPH -o out.##.exr -j2",
        "render GRAPH -o out.##.exr --jobs=auto",
        "render GRAPH -o out.exr --cluster here:1",
        "render GRAPH -o out.exr --deterministic",
        "render - -o out.exr",
        "render missing.json -o out.exr",
        "",
    ],
)
@pytest.mark.parametrize("kind", ["ramp", "glsl"])
def test_what_another_process_renders_begins_nothing(tmp_path: Path, words: str, kind: str) -> None:
    """A driver with settings of its own, helpers, a cluster; and what is no render."""
    assert begin(tmp_path, *words.split(), kind=kind) == ["alone False"]


def test_a_copy_that_a_signal_ends_is_explained(tmp_path: Path) -> None:
    """Before it has said how long its code may run."""
    (tmp_path / "graph.json").write_text('{"type": "glsl"}')
    probe = (
        "import os, sys\n"
        "from halation.cli.head_start import begin_early\n"
        "code = begin_early(sys.argv[1:])\n"
        "os.abort() if code is None else sys.exit(code)"
    )
    command = [sys.executable, "-c", probe, "render", str(tmp_path / "graph.json"), "-o", "out.exr"]
    ended = subprocess.run(command, capture_output=True, text=True)
    assert ended.returncode == 1 and ended.stderr == "halation: the render was ended from outside (SIGABRT)\n"


def test_a_graph_that_is_no_file_is_left_to_the_command(tmp_path: Path) -> None:
    """Reading a FIFO would wait for ever, or take what the command is to read."""
    os.mkfifo(tmp_path / "fifo.json")
    assert begin(tmp_path, "render", str(tmp_path / "fifo.json"), "-o", "out.exr") == ["alone False"]
    assert begin(tmp_path, "render", str(tmp_path), "-o", "out.json") == ["alone False"]


@pytest.mark.parametrize(("kind", "before"), [("glsl", NO_PROCESSES), ("glsl", THREADS), ("ramp", NO_THREADS)])
def test_where_the_system_refuses_it_the_command_goes_on(tmp_path: Path, kind: str, before: str) -> None:
    """It says itself what it lacks, if it does. A debugger may have threads, which a copy would lack."""
    assert begin(tmp_path, "render", "GRAPH", "-o", "out.exr", kind=kind, before=before) == ["alone True"]


BEFORE_NUMPY = """
import sys
from importlib import import_module
from importlib.machinery import ExtensionFileLoader

def list_libraries():
    specs = {name: getattr(module, "__spec__", None) for name, module in sys.modules.items()}
    return {name for name, spec in specs.items() if isinstance(getattr(spec, "loader", None), ExtensionFileLoader)}

from halation.cli.head_start import _LIBRARIES
import halation.renderer.opengl.warming
for name in _LIBRARIES:
    import_module(name)
before = list_libraries()
import halation.cli.program, halation.cli.render, halation.cli.execute, halation.document, halation.nodes
from halation.document import load
from halation.resources.sandbox import UNRESTRICTED
load(sys.argv[1], sandbox=UNRESTRICTED)
print("numpy" in sys.modules, sorted(list_libraries() - before))
"""


@pytest.mark.parametrize("name", ["soft_bloom", "turntable"])
def test_nothing_that_waits_for_the_driver_is_imported_before_numpy(name: str) -> None:
    path = next(path for path in paths() if path.stem == name)
    process = subprocess.run(
        [sys.executable, "-c", BEFORE_NUMPY, str(path)], capture_output=True, text=True, check=True
    )
    assert process.stdout.strip() == "False []"
