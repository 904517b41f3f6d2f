"""Code that never ends, and code that is watched and does."""

from __future__ import annotations

import contextlib
import importlib.util
import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from commands import Cli
from halation.cli import helpers, program
from halation.errors import HalationError
from halation.renderer.jobs.render_job import RenderJob
from unseen_code import write_slow_code, write_sum

needs_slang = pytest.mark.skipif(importlib.util.find_spec("slangpy") is None, reason="slangpy is not installed")

HALATION = [sys.executable, "-m", "halation.cli"]
ENDLESS = """vec4 spin(vec4 image) {
    float x = image.r;
    while (true) {
        while (true) { x = fract(x * 1.7 + 0.1); if (x > 5.0) break; }
        x += 0.01; if (x > 7.0) break;
    }
    return vec4(x);
}"""


def graph(folder: Path, code: str) -> Path:
    tree = {
        "halation": 1,
        "settings": {"size": [640, 480]},
        "outputs": {"image": {"type": "Image"}},
        "nodes": {"ramp": {"type": "ramp"}, "user": {"type": "glsl", "code": code.split("\n")}},
        "links": {"user.image": "ramp.out", "outputs.image": "user.out"},
    }
    path = folder / "graph.json"
    path.write_text(json.dumps(tree))
    return path


def render(*words: object, text: str | None = None) -> subprocess.CompletedProcess[str]:
    command = [*HALATION, "render", *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=100, input=text)


def watch(work: str, **environment: str) -> str:
    """What a process says of a copy that it watches."""
    words = "import os\nfrom halation.cli.watchdog import run_session\nfrom halation.errors import HalationError\n"
    words += f"try: print(run_session(lambda: {work}, 20.0, False))\n"
    words += "except HalationError as fault: print(type(fault).__name__, fault)"
    command = [sys.executable, "-P", "-c", words]
    ended = subprocess.run(
        command, capture_output=True, text=True, timeout=60, check=True, env={**os.environ, **environment}
    )
    return ended.stdout.strip()


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux keeps to it")
@pytest.mark.parametrize("code", [0, 1, 5, 127])
def test_a_watched_copy_keeps_its_code_unless_a_library_has_ended_it(code: int) -> None:
    """The loader of libraries ends a process with 127, OpenBLAS with 1: as a command that fails does."""
    assert watch(str(code)) == str(code)
    assert watch(f"os._exit({code})") == f"RenderError the render was ended by a library (code {code})"
    beat = f"(open(os.environ['HALATION_HEARTBEAT'], 'w').write('1 user'), os._exit({code}))"
    assert watch(beat) == (
        f"DeviceError node 'user': its code has ended the process (code {code}) while it compiled or ran: make the "
        "code simpler"
    )


def test_code_that_never_ends_is_stopped(tmp_path: Path) -> None:
    out = tmp_path / "out.exr"
    ended = render(graph(tmp_path, ENDLESS), "-o", out, "--timeout", 1, "--json")
    assert ended.returncode == 5 and not out.exists()
    said = json.loads(ended.stdout)["error"]
    assert said["kind"] == "DeviceError"
    assert said["message"].startswith("node 'user': its code has not ended after 1 seconds")


def test_code_whose_type_is_spelled_with_an_escape_is_stopped_too(tmp_path: Path) -> None:
    """What a render begins early looks for the plain word."""
    path = graph(tmp_path, ENDLESS)
    path.write_text(path.read_text().replace('"glsl"', '"gl\\u0073l"'))
    ended = render(path, "-o", tmp_path / "out.exr", "--timeout", 1)
    assert ended.returncode == 5 and "its code has not ended after 1 seconds" in ended.stderr


@pytest.mark.parametrize("piped", [False, True])
def test_code_that_ends_is_only_watched(tmp_path: Path, piped: bool) -> None:
    """What the other process says and how it ends is what this one says, also where the graph comes through a pipe."""
    code = "vec4 f(vec4 image, float k /* = 1 */) {\n for (int i = 0; i < 2; ++i) image *= k;\n return image;\n}"
    path, out = graph(tmp_path, code), tmp_path / "o.exr"
    text = path.read_text() if piped else None
    ended = render("-" if piped else path, "-o", out, "--set", "user.k=0.5", "--json", text=text)
    assert ended.returncode == 0 and json.loads(ended.stdout)["written"] == [str(out)] and out.exists()
    wrong = render("-" if piped else path, "-o", tmp_path / "o.nothing", text=text)
    assert wrong.returncode == 2 and "o.nothing" in wrong.stderr and wrong.stderr.count("halation:") == 1


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
def test_an_interrupt_reaches_the_code(tmp_path: Path) -> None:
    """As from a terminal: both processes hear it, and both are gone when the command is."""
    command = [*HALATION, "render", str(graph(tmp_path, ENDLESS)), "-o", str(tmp_path / "out.exr")]
    started = subprocess.Popen(
        [*command, "--timeout", "3"],
        start_new_session=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    time.sleep(2.0)
    os.killpg(started.pid, signal.SIGINT)
    _, said = started.communicate(timeout=60)
    # Where the device hears nothing before its pass is over, the watchdog is the one that ends it.
    assert started.returncode in (130, 5) and "halation: " in said


@pytest.mark.parametrize("timeout", [0.0, 7.0])
@pytest.mark.parametrize("processes", [1, 2])
def test_the_timeout_reaches_what_watches_helpers(
    tmp_path: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch, timeout: float, processes: int
) -> None:
    """Helpers themselves get no limit: they are watched from here."""
    calls: list[tuple[list[RenderJob], float]] = []

    def run_helpers(jobs: list[RenderJob], watched: bool, limit: float, *_: object) -> dict[str, object]:
        assert watched
        calls.append((jobs, limit))
        raise HalationError("that is enough")

    monkeypatch.setattr(helpers, "run_helpers", run_helpers)
    words = ("-o", tmp_path / "o.##.exr", "--frames", "1-3", "-j", processes, "--timeout", timeout)
    cli("render", graph(tmp_path, ENDLESS), *words)
    for jobs, limit in calls:
        assert limit == timeout and {job.timeout for job in jobs} == {0.0} and len(jobs) == processes
        assert sorted(frame for job in jobs for frame in job.frames) == [1, 2, 3]
    assert len(calls) == 1


def test_code_that_never_ends_stops_all_helpers(tmp_path: Path) -> None:
    ended = render(graph(tmp_path, ENDLESS), "-o", tmp_path / "o.##.exr", "--frames", "1-2", "-j", 2, "--timeout", 1)
    assert ended.returncode == 5 and "its code has not ended after 1 seconds" in ended.stderr


@pytest.mark.usefixtures("compiles_as_for_users")  # without the optimizer a fast machine needs no second
def test_the_timeout_holds_while_code_compiles(tmp_path: Path) -> None:
    ended = render(graph(tmp_path, write_slow_code()), "-o", tmp_path / "out.exr", "--timeout", 1, "--json")
    assert ended.returncode == 5
    message = json.loads(ended.stdout)["error"]["message"]
    assert message.startswith("node 'user': its code has not ended after 1 seconds")


@pytest.mark.usefixtures("compiles_as_for_users")  # it is the optimizer that takes memory
def test_the_memory_limit_holds_while_code_compiles(tmp_path: Path) -> None:
    ended = render(graph(tmp_path, write_slow_code()), "-o", tmp_path / "out.exr", "--memory", "1M", "--json")
    assert ended.returncode == 5
    assert json.loads(ended.stdout)["error"]["message"].startswith("node 'user': its code takes more than 0.3 GiB")


def write_translated_graph(folder: Path) -> Path:
    """A graph whose code keeps the translator to WGSL busy for seconds, and no driver."""
    path = graph(folder, write_sum(3500))
    tree = json.loads(path.read_text()) | {"inputs": {"image": {"type": "Image", "default": 0.5}}}
    path.write_text(json.dumps(tree | {"links": tree["links"] | {"user.image": "inputs.image"}}))
    return path


@needs_slang
def test_the_timeout_holds_while_wgsl_is_made(tmp_path: Path) -> None:
    """The same code in GLSL, which is written and not compiled, shows that it is the translator that is stopped."""
    path = write_translated_graph(tmp_path)
    for kind, code in (("glsl", 0), ("wgsl", 5)):
        words = [*HALATION, "export", str(path), "--to", kind, "-o", str(tmp_path / kind), "--timeout", "0.5", "--json"]
        ended = subprocess.run(words, capture_output=True, text=True, timeout=100)
        assert ended.returncode == code, ended.stderr
    message = json.loads(ended.stdout)["error"]["message"]
    assert message.startswith("node 'user': its code has not ended after 0.5 seconds")
    assert not (tmp_path / "wgsl").exists()


@needs_slang
def test_the_memory_limit_holds_while_wgsl_is_made(tmp_path: Path) -> None:
    """Half of the memory of a machine, which has 16 MiB here, and none for the driver itself."""
    program = (
        "import sys; from halation.resources import heartbeat; from halation.cli.program import run_process; "
        "heartbeat.OWN_MEMORY = 0; heartbeat.machine_memory = lambda: 16 << 20; sys.exit(run_process(sys.argv[1:]))"
    )
    words = ("export", write_translated_graph(tmp_path), "--to", "wgsl", "-o", tmp_path / "wgsl", "--json")
    ended = subprocess.run(
        [sys.executable, "-c", program, *map(str, words)], capture_output=True, text=True, timeout=100
    )
    assert ended.returncode == 5, ended.stderr
    message = json.loads(ended.stdout)["error"]["message"]
    assert message.startswith("node 'user': its code takes more than 0.0 GiB") and message.endswith("code smaller")
    assert not (tmp_path / "wgsl").exists()


@pytest.mark.skipif(sys.platform != "linux", reason="it lists the processes of another one")
@pytest.mark.parametrize("jobs", ["", "-j 1", "-j 2"])
def test_code_that_ends_its_process(tmp_path: Path, jobs: str) -> None:
    """A driver that dies takes one process with it; the other one says whose code it was, when it has no time left."""
    words = ("-o", tmp_path / "o.##.exr", "--frames", "1-2", *jobs.split(), "--timeout", 8)
    command = [*HALATION, "render", *map(str, (graph(tmp_path, ENDLESS), *words)), "--json"]
    started = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "TMPDIR": str(tmp_path)},
    )
    beats: tuple[Path, ...] = ()
    while not any(path.read_text() for path in beats):
        time.sleep(0.1)
        beats = (*tmp_path.glob("halation-*/heartbeat*"), *_heartbeats_in_memory(started.pid))
    children = Path(f"/proc/{started.pid}/task/{started.pid}/children").read_text().split()
    busy = str(next(path for path in beats if path.read_text()))
    os.kill(next(int(child) for child in children if jobs != "-j 2" or _heartbeat_of(child) == busy), signal.SIGSEGV)
    printed, _ = started.communicate(timeout=60)
    assert started.returncode == 5
    assert json.loads(printed)["error"]["message"].startswith("node 'user': its code has ended the process (SIGSEGV)")


def _heartbeats_in_memory(process: int) -> Iterator[Path]:
    """The files that a process has opened in memory for heartbeats."""
    for file in Path(f"/proc/{process}/fd").iterdir():
        with contextlib.suppress(FileNotFoundError):  # it is closed meanwhile
            if "heartbeat" in str(file.readlink()):
                yield file


def _heartbeat_of(process: str) -> str:
    """The file that a helper writes its heartbeat to."""
    entries = Path(f"/proc/{process}/environ").read_bytes().split(b"\0")
    return next(
        (entry.partition(b"=")[2].decode() for entry in entries if entry.startswith(b"HALATION_HEARTBEAT=")), ""
    )


@pytest.mark.parametrize("command", ["test", "test -j 2", "watch"])
def test_commands_that_render_many_times_are_watched_too(tmp_path: Path, command: str) -> None:
    """They had no limit, and never ended: what is tried on a few pixels is quick there."""
    path = graph(tmp_path, ENDLESS)
    suite = tmp_path / "s.suite.toml"
    suite.write_text("".join(f'[cases.{name}]\ngraph = "graph.json"\ngolden = ""\n' for name in ("one", "two")))
    words = (path, "-o", tmp_path / "out.exr") if command == "watch" else (suite,)
    ended = subprocess.run(
        [*HALATION, *command.split(), *map(str, words), "--timeout", "1"], capture_output=True, text=True, timeout=100
    )
    assert ended.returncode == 5, ended.stderr
    sentence = ended.stderr.splitlines()[-1]
    assert sentence.startswith("halation: node 'user': its code has not ended after 1 seconds")


def test_every_command_that_renders_graphs_has_a_time_limit() -> None:
    """`demo` and `gallery` render what Halation ships, `thumbnail` has a fixed limit.

    What starts `execute` and `worker` has the limit.
    """
    renders = re.compile(r"\b(open_device|open_batch|render_and_compare|execute)\(")
    commands = {
        path.stem: text
        for path in Path(program.__file__).parent.glob("*.py")
        if re.search(rf"^def {path.stem}\(.*?^\) -> int:", text := path.read_text(), re.M | re.S)
        and renders.search(text)
        and path.stem not in ("execute", "worker")
    }
    limited = {name for name, text in commands.items() if "timeout: Timeout" in text}
    assert commands.keys() - limited == {"demo", "gallery", "thumbnail"} and {"render", "export", "diff"} <= limited


@pytest.mark.parametrize("command", ["export --lut-size 129 -o out.cube", "explain --html page.html", "diff --render"])
def test_commands_that_render_once_are_watched_too(tmp_path: Path, command: str) -> None:
    path = graph(tmp_path, ENDLESS)
    tree = json.loads(path.read_text())
    tree |= {"inputs": {"image": {"type": "Image", "default": 0.5}}}
    path.write_text(json.dumps(tree | {"links": tree["links"] | {"user.image": "inputs.image"}}))
    name, *options = command.split()
    graphs = (path, path) if name == "diff" else (path,)
    words = [*HALATION, name, *map(str, graphs), *options, "--timeout", "1"]
    ended = subprocess.run(words, capture_output=True, text=True, timeout=100, cwd=tmp_path)
    assert ended.returncode == 5, ended.stderr
    sentence = ended.stderr.splitlines()[-1]
    assert sentence.startswith("halation: node 'user': its code has not ended after 1 seconds")
    assert {file.name for file in tmp_path.iterdir()} == {"graph.json"}


@pytest.mark.skipif(sys.platform != "linux", reason="fork and SIGKILL")
def test_the_limited_copy_of_a_command_ends_with_it(tmp_path: Path) -> None:
    """Whoever kills the command at once, with a signal that it cannot hear, leaves nothing behind."""
    code = (
        "import os, time; from halation.cli.watchdog import run_limited\n"
        "run_limited(lambda: print(os.getppid(), os.getpid(), flush=True) or time.sleep(120) or 0)"
    )
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        parent, copy = map(int, process.stdout.readline().split())
        assert parent == process.pid != copy
        process.kill()
    end = time.monotonic() + 60.0
    while (state := Path(f"/proc/{copy}/stat")).exists() and state.read_text().rpartition(")")[2].split()[0] != "Z":
        assert time.monotonic() < end, "the copy goes on"
        time.sleep(0.02)
