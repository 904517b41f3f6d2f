"""Signals that ask a command to end, and parents that are gone: no process stays, and no unfinished file."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from uuid import uuid4

import pytest
from children import MARK, end_process, list_marked
from halation.cli import signals

HALATION = [sys.executable, "-m", "halation.cli"]
CODE = "vec4 f(vec4 image) {\n    for (int i = 0; i < 3; ++i) image *= 0.9;\n    return image;\n}"

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="it lists the processes of another one")


def write_graph(folder: Path, *, has_code: bool) -> Path:
    """A graph with two thousand frames of a moment each."""
    user = {"type": "glsl", "code": CODE.split("\n")} if has_code else {"type": "exposure", "values": {"stops": 1.0}}
    tree = {
        "halation": 1,
        "settings": {"size": [64, 48], "frames": [1, 2000]},
        "outputs": {"image": {"type": "Image"}},
        "nodes": {"ramp": {"type": "ramp"}, "user": user},
        "links": {"user.image": "ramp.out", "outputs.image": "user.out"},
    }
    path = folder / "graph.json"
    path.write_text(json.dumps(tree))
    return path


@contextmanager
def started(*words: object, ignored: bool = False) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """A process of the command line, and the mark of all that it starts; none is left afterwards."""
    mark = uuid4().hex
    before = ["sh", "-c", 'trap "" INT; exec "$@"', "sh"] if ignored else []
    with subprocess.Popen(
        [*before, *HALATION, *map(str, words)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, MARK: mark},
    ) as process:
        try:
            yield process, mark
        finally:
            process.kill()
            for number in list_marked(mark):
                end_process(number)


def wait_for_frames(process: subprocess.Popen[str], count: int = 3) -> None:
    assert process.stderr
    lines: list[str] = []
    for line in process.stderr:
        lines.append(line)
        if f'"done": {count}' in line:
            return
    raise AssertionError(f"it ended before, with {process.wait()}: {''.join(lines)}")


def wait_for_end(mark: str) -> None:
    """Wait until nothing that was started is there; the time limit of the test names what waits for ever."""
    while list_marked(mark):
        time.sleep(0.05)


@pytest.mark.parametrize("words", [(), ("-j", 2)], ids=["one process", "two helpers"])
@pytest.mark.parametrize("has_code", [False, True], ids=["nodes", "code"])
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_render_that_is_asked_to_end(
    tmp_path: Path, number: signal.Signals, has_code: bool, words: tuple[object, ...]
) -> None:
    """The signal reaches one process only, unlike the key of a terminal; a shell has it ignore interrupts."""
    out = tmp_path / "out"
    out.mkdir()
    path = write_graph(tmp_path, has_code=has_code)
    command = ("render", path, "-o", out / "o.####.exr", "--progress=json", *words)
    with started(*command, ignored=True) as (process, mark):
        wait_for_frames(process)
        process.send_signal(number)
        _, said = process.communicate()
        assert process.returncode == 130 and "interrupted; no unfinished file is left" in said, said
        wait_for_end(mark)
    assert not [(file, file.stat().st_size) for file in out.glob(".*")], said
    assert len(list(out.glob("o.*.exr"))) >= 3


@pytest.mark.parametrize("words", [(), ("-j", 2)], ids=["one process", "two helpers"])
@pytest.mark.parametrize("has_code", [False, True], ids=["nodes", "code"])
def test_a_render_that_is_killed_leaves_no_process(tmp_path: Path, has_code: bool, words: tuple[object, ...]) -> None:
    path = write_graph(tmp_path, has_code=has_code)
    with started("render", path, "-o", tmp_path / "o.####.exr", "--progress=json", *words) as (process, mark):
        wait_for_frames(process)
        process.kill()
        wait_for_end(mark)
    assert process.returncode == -signal.SIGKILL


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGKILL, signal.SIGINT])
def test_what_watches_a_bench_ends_with_it(tmp_path: Path, number: signal.Signals) -> None:
    """`bench` starts the same command again; a terminal interrupts both."""
    path = write_graph(tmp_path, has_code=True)
    with started("bench", path, "-n", 10_000) as (process, mark):
        while len(list_marked(mark)) < 2:
            assert process.poll() is None
            time.sleep(0.05)
        time.sleep(0.5)
        for each in list_marked(mark) if number == signal.SIGINT else [process.pid]:
            os.kill(each, number)
        process.communicate()
        wait_for_end(mark)
    assert process.returncode == (-number if number == signal.SIGKILL else 130)


def test_cases_that_are_killed_leave_no_process(tmp_path: Path) -> None:
    write_graph(tmp_path, has_code=False)
    cases = [f'[cases.c{number}]\ngraph = "graph.json"\ngolden = "c{number}.exr"\n' for number in range(400)]
    (tmp_path / "all.suite.toml").write_text("".join(cases))
    with started("test", tmp_path / "all.suite.toml", "-j", 2, "--update") as (process, mark):
        while not list(tmp_path.glob("c*.exr")):
            assert process.poll() is None
            time.sleep(0.05)
        process.kill()
        wait_for_end(mark)
    assert process.returncode == -signal.SIGKILL


@pytest.mark.parametrize(
    ("at_request", "expected"),
    [(signals._interrupt, [(signal.SIGINT, signal.SIG_IGN)]), (signal.SIG_IGN, []), (signal.SIG_DFL, [])],
)
def test_a_copy_leaves_interrupts_to_its_parent_if_that_can_ask_it_to_end(monkeypatch, at_request, expected) -> None:
    """A copy that does not hear requests to end would hear nothing at all without interrupts."""
    changed = []
    monkeypatch.setattr(signal, "getsignal", {signal.SIGTERM: at_request}.__getitem__)
    monkeypatch.setattr(signal, "signal", lambda *words: changed.append(words))
    signals.ignore_interrupts()
    assert changed == expected


def test_who_ignores_hangups_goes_on(tmp_path: Path) -> None:
    """As with `nohup`."""
    with subprocess.Popen(
        ["sh", "-c", 'trap "" HUP; exec "$@"', "sh", *HALATION, "nodes", "--json"], stdout=subprocess.PIPE
    ) as process:
        time.sleep(0.1)
        process.send_signal(signal.SIGHUP)
        listing, _ = process.communicate()
    assert process.returncode == 0 and json.loads(listing)


LOADING = """
import signal, sys, time
from importlib.machinery import ExtensionFileLoader
from halation.cli.signals import raise_on_requests

raise_on_requests()
modules = []

def interrupt(frame, event, _):
    while event == "call" and frame is not None:
        loader = frame.f_locals.get("self") if frame.f_code.co_name in ("create_module", "exec_module") else None
        if isinstance(loader, ExtensionFileLoader):
            modules.append(loader.name)
            if len(modules) == {call}:
                sys.setprofile(None)
                signal.raise_signal(signal.{name})
            return
        frame = frame.f_back

try:
    sys.setprofile(interrupt)
    import {module}
    time.sleep(5 if len(modules) >= {call} else 0)
except KeyboardInterrupt:
    sys.exit(130)
"""


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
@pytest.mark.parametrize(
    "module,call", [("OpenImageIO", 1), ("OpenImageIO", 50), ("OpenImageIO", 200), ("PyOpenColorIO", 3)]
)
def test_an_interrupt_while_a_library_is_loaded(module: str, call: int, name: str) -> None:
    """It calls Python hundreds of times meanwhile; at some of the calls its C++ drops an exception or aborts."""
    code = LOADING.format(module=module, call=call, name=name)
    process = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert process.returncode == 130, process.stderr


EARLY = """
import os, signal
from halation import cli

def interrupt():
    os.kill(os.getpid(), signal.SIGINT)
    return False

cli.{name} = interrupt
cli.main()
"""


@pytest.mark.parametrize("name", ["has_memory_limit", "_replace_closed_streams"])
def test_an_interrupt_before_the_command_is_known_is_no_traceback(name: str) -> None:
    process = subprocess.run([sys.executable, "-c", EARLY.format(name=name)], capture_output=True, text=True)
    assert (process.returncode, process.stderr) == (130, "")
