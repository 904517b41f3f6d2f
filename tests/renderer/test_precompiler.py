"""Programs are compiled side by side before they run: Mesa's own cache says what was compiled, and by whom."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import pytest
from halation.renderer import Renderer
from halation.renderer.device import ProgramVariant
from halation.renderer.opengl.shader_cache import DISABLING, MAX_RECORD_BYTES, ProgramRecord
from halation.renderer.opengl.thread_context import ThreadContext, find_display
from halation.resources.machine import available_cores, count_busy_threads

SCRIPT = """
import hashlib, json, sys, time
from pathlib import Path
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import catalogue
from halation.renderer import Renderer
from halation.renderer.opengl.device import OpenGLDevice
from halation.resources.sandbox import UNRESTRICTED

def list_programs():
    time.sleep(0.3)  # Mesa writes on another thread
    return sorted(str(path) for path in Path(sys.argv[1]).rglob("*") if path.is_file() and "halation" not in path.name)

counts, begin = [], OpenGLDevice.precompile
def precompile(self, variants):
    futures = begin(self, variants)
    counts.append(len(futures))
    for future in futures.values():
        future.result()
    return futures
OpenGLDevice.precompile = precompile

kinds, names = catalogue(), ("noise", "gaussian_blur", "edge_detect", "bloom")
graph = Graph(settings=Settings((48, 64))).add_output("out", Output(width=4))
for name in names:
    graph = graph.add(name, kinds[name]())
for before, after in zip(names, names[1:]):
    graph = graph.connect(Port(before, "out"), Port(after, "image"))
graph = graph.connect(Port("bloom", "out"), Port("outputs", "out"))
renderer = Renderer(sandbox=UNRESTRICTED)
plan = renderer.compile(graph)
lease = renderer.runner.create_lease()
with renderer.runner.start_run(plan, lease) as run:
    before = list_programs()
    for _ in run:
        pass
    after = list_programs()
pixels = renderer.runner.download(plan)["out"].tobytes()
lease.close()
renderer.close()
print(json.dumps({"count": counts[0], "before": before, "after": after, "pixels": hashlib.sha256(pixels).hexdigest()}))
"""
"""Renders a small graph, and says how many programs threads compiled, what Mesa's cache held before the first pass and
after the last, and the hash of the pixels."""


def render(folder: Path, **environment: str) -> dict[str, Any]:
    """What a process compiles and renders with a cache in this folder."""
    folder.mkdir(exist_ok=True)
    variables = {name: text for name, text in os.environ.items() if name not in DISABLING}
    variables |= {"MESA_SHADER_CACHE_DIR": str(folder), **environment}
    command = [sys.executable, "-c", SCRIPT, str(folder)]
    process = subprocess.run(command, env=variables, capture_output=True, text=True, check=True)
    return json.loads(process.stdout.splitlines()[-1])


def test_threads_compile_all_that_the_passes_run(tmp_path: Path) -> None:
    """Nothing is added to Mesa's cache by the passes, so they compiled nothing again; and the next process nothing."""
    empty = render(tmp_path / "cache")
    if available_cores() == 1:  # nothing is compiled side by side
        assert empty["count"] == 0
        return
    assert empty["count"] > 3 and len(empty["before"]) > empty["count"]
    assert empty["after"] == empty["before"]
    full = render(tmp_path / "cache")
    assert full["count"] == 0 and full["after"] == empty["after"] and full["pixels"] == empty["pixels"]


def test_without_a_cache_nothing_is_compiled_twice(tmp_path: Path) -> None:
    disabled = render(tmp_path / "cache", MESA_SHADER_CACHE_DISABLE="true")
    assert disabled["count"] == 0 and not disabled["after"]
    assert disabled["pixels"] == render(tmp_path / "cache")["pixels"]


def test_a_renderer_that_closes_early_waits_for_its_threads(tmp_path: Path) -> None:
    """A driver that still compiles when its process ends would crash."""
    script = SCRIPT.split("with renderer.runner")[0].replace("future.result()", "pass")
    variables = {name: text for name, text in os.environ.items() if name not in DISABLING}
    variables["MESA_SHADER_CACHE_DIR"] = str(tmp_path)
    for ending in ("renderer.close()", "", "raise SystemExit(3)"):
        command = [sys.executable, "-c", f"{script}renderer.runner.start_run(plan, lease)\n{ending}", str(tmp_path)]
        process = subprocess.run(command, env=variables, capture_output=True, text=True)
        assert process.returncode == (3 if "3" in ending else 0), process.stderr
        for folder in tmp_path.iterdir():
            shutil.rmtree(folder)


def test_a_program_that_the_driver_refuses(renderer: Renderer) -> None:
    """The renderer says what is wrong with it, so a thread only says that it is not there."""
    with renderer.device.make_current():
        display = find_display()
    assert display is not None
    compiled: list[bool] = []

    def compile_both() -> None:
        context = ThreadContext(display)
        for text in ("#version 430 core\nbroken", "#version 430 core\nlayout(local_size_x = 1) in; void main() {}"):
            compiled.append(context.compile(ProgramVariant(text, (), ())))
        context.close()

    thread = threading.Thread(target=compile_both)
    thread.start()
    thread.join()
    assert compiled == [False, True]


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache of Mesa."""
    for name in DISABLING:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("MESA_SHADER_CACHE_DIR", str(tmp_path))
    folder = tmp_path / "mesa_shader_cache"
    folder.mkdir()
    return folder


def test_a_record_belongs_to_one_driver_and_to_its_cache(cache: Path) -> None:
    record = ProgramRecord.load("driver 1")
    record.add(["a", "b"])
    assert "a" in record and "c" not in record
    assert "b" in ProgramRecord.load("driver 1") and "b" not in ProgramRecord.load("driver 2")
    shutil.rmtree(cache)
    record.add(["c"])
    cache.mkdir()
    assert "a" not in ProgramRecord.load("driver 1")


def test_two_processes_add_to_a_record(cache: Path) -> None:
    one, other = ProgramRecord.load("driver"), ProgramRecord.load("driver")
    one.add(["a"])
    other.add(["b"])
    both = ProgramRecord.load("driver")
    assert "a" in both and "b" in both


def test_a_record_that_is_too_large_begins_anew(cache: Path) -> None:
    record = ProgramRecord.load("driver")
    record.add(["a"])
    assert record.path is not None
    with record.path.open("ab") as file:
        file.write(bytes(MAX_RECORD_BYTES))
    assert "a" not in ProgramRecord.load("driver") and not record.path.exists()


def test_there_is_no_record_without_a_cache(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MESA_SHADER_CACHE_DISABLE", "true")
    assert ProgramRecord.load("driver").path is None
    monkeypatch.delenv("MESA_SHADER_CACHE_DISABLE")
    assert ProgramRecord.load("driver").path is not None
    cache.rmdir()
    assert ProgramRecord.load("driver").path is None


def test_a_machine_with_a_carried_cache_compiles_nothing(tmp_path: Path) -> None:
    first = render(tmp_path / "first")
    for folder, option in (("first", "--export"), ("second", "--import")):
        (tmp_path / folder).mkdir(exist_ok=True)
        command = [sys.executable, "-m", "halation.cli", "cache", option, str(tmp_path / "cache.zip")]
        variables = {name: text for name, text in os.environ.items() if name not in DISABLING}
        subprocess.run(command, env={**variables, "MESA_SHADER_CACHE_DIR": str(tmp_path / folder)}, check=True)
    second = render(tmp_path / "second")
    assert second["count"] == 0 and second["pixels"] == first["pixels"]
    assert {Path(name).name for name in second["after"]} == {Path(name).name for name in first["after"]}


def test_threads_that_work_are_counted() -> None:
    assert count_busy_threads("no thread has this name") == 0
    own = Path(f"/proc/self/task/{threading.get_native_id()}/comm")
    assert not own.exists() or count_busy_threads(own.read_text().strip()) >= 1  # this one
