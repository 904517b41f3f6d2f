"""The program as the system sees it: signals, pipes, imports, time."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from halation.cli.program import Commands
from halation.nodes import catalogue

HALATION = [sys.executable, "-m", "halation.cli"]
POSIX = pytest.mark.skipif(os.name == "nt", reason="POSIX signals, pipes and terminals")

TEN = {
    "bloom": ("bloom", {"intensity": 0.3}, {"image": "inputs.beauty"}),
    "grade": ("grade", {"gamma": [1.1, 1.0, 0.9, 1.0]}, {"image": "bloom.out"}),
    "color": ("saturation", {"saturation": 1.2}, {"image": "grade.out"}),
    "blur": ("gaussian_blur", {"sigma": 6.0}, {"image": "color.out"}),
    "edges": ("edge_detect", {}, {"image": "color.out"}),
    "merge": ("merge", {"mode": "plus", "amount": 0.2}, {"a": "edges.out", "b": "blur.out"}),
    "noise": ("noise", {"size": 40.0}, {}),
    "warp": ("displace", {"amount": [4.0, 4.0]}, {"image": "merge.out", "vector": "noise.vector"}),
    "frame": ("vignette", {}, {"image": "warp.out"}),
    "tone": ("tone_map", {}, {"image": "frame.out"}),
}


@pytest.fixture
def ten(tmp_path):
    """The ten-node graph on the 480x270 frame that comes with the project."""
    links = {f"{id}.{socket}": source for id, (_, _, wires) in TEN.items() for socket, source in wires.items()}
    sample = Path(__file__).parents[2] / "presets" / "samples" / "neon.exr"
    tree = {
        "halation": 1,
        "inputs": {"beauty": {"type": "Image", "file": str(sample), "layer": "Combined"}},
        "outputs": {"image": {"type": "Image"}},
        "links": {**links, "outputs.image": "tone.out"},
        "nodes": {
            id: {"type": type, "version": catalogue()[type].version, "values": values}
            for id, (type, values, _) in TEN.items()
        },
    }
    path = tmp_path / "ten.json"
    path.write_text(json.dumps(tree))
    return path


def halation(*words, **options):
    return subprocess.run([*HALATION, *map(str, words)], capture_output=True, text=True, timeout=100, **options)


def modules(*words):
    """The modules that a command leaves loaded."""
    code = (
        "import sys; from halation.cli.program import run; code = run(sys.argv[1:]); "
        "print('loaded', code, *sys.modules)"
    )
    result = subprocess.run([sys.executable, "-c", code, *map(str, words)], capture_output=True, text=True, timeout=100)
    status, code, *names = result.stdout.splitlines()[-1].split()
    assert (status, code) == ("loaded", "0"), result.stderr
    return set(names)


def loaded(*words):
    """The top-level modules that a command leaves loaded."""
    return {name.split(".")[0] for name in modules(*words)}


WINDOWS = {"glfw", "imgui_bundle"}
PIXELS = {"numpy", "OpenImageIO", "PyOpenColorIO", "moderngl", "glcontext", "rich"}


def test_the_help_runs_no_command_and_says_what_all_of_them_say():
    names = modules("--help")
    rows = halation("--help").stdout.partition("Commands:\n")[2].partition("\n\n")[0]
    listed = dict(re.split(r"  +", row.strip(), maxsplit=1) for row in rows.splitlines())
    assert len(listed) > 15 and not names & {f"halation.cli.{name.replace('-', '_')}" for name in listed}
    assert all(Commands()[name].get_short_help_str(len(text)) == text for name, text in listed.items())


def test_a_check_reads_headers_without_arrays_and_asks_for_plug_ins_only_where_one_may_be(ten, tmp_path):
    names = modules("check", ten)
    assert "OpenImageIO" in names and not names & {"numpy", "importlib.metadata"}
    notes = tmp_path / "site" / "acme-1.0.dist-info"
    notes.mkdir(parents=True)
    (notes / "METADATA").write_text("Metadata-Version: 2.1\nName: acme\nVersion: 1.0\n")
    (notes / "entry_points.txt").write_text("[halation.nodes]\nacme = acme\n")
    asked = halation("check", ten, env={**os.environ, "PYTHONPATH": str(notes.parent), "HALATION_PLUGINS": "acme"})
    assert "the plug-in acme 1.0 cannot be loaded" in asked.stderr


def test_what_needs_no_pixels_loads_no_library_for_them(tmp_path):
    path = tmp_path / "graph.json"
    path.write_text(
        json.dumps(
            {
                "halation": 1,
                "outputs": {"image": {"type": "Image"}},
                "nodes": {"fill": {"type": "constant"}},
                "links": {"outputs.image": "fill.out"},
            }
        )
    )
    for words in (
        ("--help",),
        ("--version",),
        ("render", "--help"),
        ("nodes",),
        ("check", path),
        ("explain", path),
        ("fmt", path),
    ):
        assert not loaded(*words) & (WINDOWS | PIXELS), words


SELDOM = {
    "importlib.metadata",
    "importlib.resources",
    "PyOpenColorIO",
    "av",
    "rich",
    "trimesh",
    "asyncio",
    "multiprocessing",
    "unittest",
    "unicodedata",
    "zipfile",
    *(
        f"halation.{name}"
        for name in (
            "editor",
            "lint",
            "regression",
            "cli.edit",
            "cli.nodes",
            "cli.batch",
            "document.diff_merge",
            "document.schema",
            "graph.expressions.parser",
            "glsl.loops",
            "custom_nodes.glsl",
            "custom_nodes.isf",
            "compiler.isf",
            "render_layers.analysis",
            "media.video",
            "media.comparison",
            "media.meshes",
            "renderer.viewing.display",
            "renderer.viewing.probe",
            "renderer.jobs.sweep",
            "renderer.provenance",
        )
    ),
}
"""What most renderings do without."""


def test_what_most_do_without_has_a_name():
    assert all(find_spec(name) for name in SELDOM if name.startswith("halation."))


def test_a_rendering_loads_what_it_needs(ten, tmp_path):
    assert sorted(modules("render", ten, "-o", tmp_path / "out.exr") & SELDOM) == []


def test_checking_loads_the_nodes_of_the_graph_alone(ten):
    """Rules know the others by name."""
    found = (re.fullmatch(r"halation\.nodes\.[a-z]\w*\.([a-z]\w*)", name) for name in modules("check", ten))
    assert {match[1] for match in found if match} == {type for type, _, _ in TEN.values()}


def test_a_command_loads_no_other_one(ten):
    commands = {f"halation.cli.{path.stem}" for path in (Path(__file__).parents[2] / "app" / "cli").glob("*.py")}
    shared = {
        f"halation.cli.{name}" for name in ("program", "options", "outcome", "parsing", "plugins", "signals", "check")
    }
    assert modules("check", ten) & commands == shared


def test_render_loads_no_window_library(ten, tmp_path):
    names = modules("render", ten, "-o", tmp_path / "out.png")
    assert "moderngl" in names and not names & {*WINDOWS, "scipy", "cv2"}
    assert not [name for name in names if name.startswith(("halation.editor", "halation.authoring"))]


def test_watching_loads_no_window_library() -> None:
    code = "import sys, halation.cli.watch, halation.watch.rerendering, halation.watch.reloading; print(*sys.modules)"
    names = set(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60).stdout.split())
    assert "halation.watch.watching" in names and not names & WINDOWS
    assert not [name for name in names if name.startswith(("halation.editor", "halation.authoring"))]


def test_without_display_home_or_a_place_for_caches(ten, tmp_path):
    """The bare environment of a build machine."""
    out = tmp_path / "out.png"
    bare = {"PATH": os.environ["PATH"], "HOME": "/nonexistent/home", "TMPDIR": str(tmp_path)}
    result = halation("render", ten, "-o", out, env=bare)
    assert result.returncode == 0 and out.stat().st_size > 1000, result.stderr
    assert len(result.stderr.splitlines()) == 2, result.stderr


@pytest.fixture
def long(ten):
    """A graph that keeps any machine busy for seconds: hundreds of wide blurs of a large picture."""
    tree = json.loads(ten.read_text())
    for number in range(300):
        tree["nodes"][f"n{number}"] = {"type": "gaussian_blur", "values": {"sigma": 30.0 + number}}
        tree["links"][f"n{number}.image"] = f"n{number - 1}.out" if number else "tone.out"
    tree["links"]["outputs.image"] = "n299.out"
    ten.write_text(json.dumps(tree))
    return ten


@POSIX
@pytest.mark.parametrize("passes", [0, 1, 20])
def test_interrupting_stops_at_once_and_leaves_nothing(long, tmp_path, passes):
    """After so many passes of hundreds; a few more may end before it hears the signal."""
    out = tmp_path / "result" / "out.exr"
    out.parent.mkdir()
    out.write_bytes(b"precious")
    with subprocess.Popen(
        [*HALATION, "render", long, "-o", out, "--size", "1920x1080", "--progress=json"],
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1"},
    ) as running:
        assert running.stderr is not None
        assert "OpenGL" in running.stderr.readline()
        for number in range(1, passes + 1):
            assert json.loads(running.stderr.readline())["pass"] == number
        running.send_signal(signal.SIGINT)
        *others, said = running.stderr.readlines()
        code = running.wait()
    assert (code, said) == (130, "halation: interrupted; no unfinished file is left\n")
    assert not others or json.loads(others[-1])["pass"] < json.loads(others[-1])["passes"] / 10
    assert list(out.parent.iterdir()) == [out] and out.read_bytes() == b"precious"


@POSIX
def test_nobody_reads_our_output():
    """As in `halation nodes --json | head -1`: no complaint, and the status that shells know."""
    with subprocess.Popen([*HALATION, "nodes", "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as running:
        assert running.stdout is not None and running.stderr is not None
        running.stdout.close()
        assert running.stderr.read() == b""
        assert running.wait() == 141


@POSIX
def test_closed_streams(ten, tmp_path):
    """`>&- 2>&-` closes them: what is said goes nowhere, and never into a picture that took their place.

    The picture is written all the same; an object for `--json` that nobody can read is an error.
    """
    out = tmp_path / "out.exr"
    for closed, code in (("2>&-", 0), (">&-", 1), (">&- 2>&-", 1)):
        words = [*HALATION, "render", str(ten), "-o", str(out), "--json"]
        result = subprocess.run(["sh", "-c", f'"$@" {closed}', "sh", *words], capture_output=True, text=True)
        assert result.returncode == code and out.read_bytes()[:4] == b"v/1\x01", result
        assert not result.stdout or json.loads(result.stdout)["written"] == [str(out)]
        out.unlink()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
@pytest.mark.parametrize("words", [("nodes",), ("nodes", "--json"), ("--version",)])
def test_output_onto_a_full_disk(words):
    with Path("/dev/full").open("w") as full:
        result = subprocess.run([*HALATION, *words], stdout=full, stderr=subprocess.PIPE, text=True)
    assert result.returncode == 1
    assert result.stderr == "halation: standard output: the system reports an error: No space left on device\n"


@POSIX
def test_progress_shows_on_a_terminal_only(long, tmp_path):
    import pty

    words = [*HALATION, "render", str(long), "-o", str(tmp_path / "out.exr"), "--scale", "0.25"]
    ours, theirs = pty.openpty()
    with subprocess.Popen(words, stderr=theirs, env={**os.environ, "TERM": "xterm", "COLUMNS": "100"}) as running:
        os.close(theirs)
        said = b""
        try:
            while block := os.read(ours, 4096):
                said += block
        except OSError:  # Linux: the other end is closed
            pass
        assert running.wait() == 0
    os.close(ours)
    assert re.search(rb"\d+/\d+ passes", said), said
    assert said.count(b"\x1b[?25l") == said.count(b"\x1b[?25h")  # the cursor is hidden and shown again
    quiet = halation(*words[len(HALATION) :])
    assert "\x1b" not in quiet.stderr and len(quiet.stderr.splitlines()) == 2


def test_progress_for_programs(ten, tmp_path):
    """A line of JSON for every pass and for the frame, and nothing else that begins like one."""
    result = halation("render", ten, "-o", tmp_path / "out.exr", "--progress", "json", "--json")
    assert result.returncode == 0, result.stderr
    told = [json.loads(line) for line in result.stderr.splitlines() if line.startswith("{")]
    count = json.loads(result.stdout)["passes"]
    frame = told.pop()
    assert frame == {
        "frame": 1,
        "done": 1,
        "frames": 1,
        "written": [str(tmp_path / "out.exr")],
        "kept": False,
        "passes": count,
    }
    assert [(one["pass"], one["passes"]) for one in told] == [(number, count) for number in range(1, count + 1)]
    assert told[-1]["nodes"][-1] == "tone" and {name for one in told for name in one["nodes"]} <= set(TEN)
    refused = halation("render", ten, "-o", tmp_path / "out.exr", "--progress", "loud")
    assert (refused.returncode, refused.stderr) == (2, "halation: --progress loud: choose bar or json\n")


def test_a_graph_from_standard_input(ten, tmp_path):
    """Relative paths start at the current folder."""
    tree = json.loads(ten.read_text())
    sample = Path(tree["inputs"]["beauty"]["file"])
    tree["inputs"]["beauty"]["file"] = sample.name
    out = tmp_path / "out.exr"
    result = halation("render", "-", "-o", out, input=json.dumps(tree), cwd=sample.parent)
    assert result.returncode == 0 and out.stat().st_size > 1000, result.stderr
    assert halation("explain", "-", input=json.dumps(tree), cwd=sample.parent).stdout.count("\n") > 5
    broken = halation("render", "-", "-o", out, input="{", cwd=tmp_path)
    assert broken.returncode == 3 and broken.stderr.startswith("halation: -: not valid JSON")
    bytes = subprocess.run([*HALATION, "explain", "-"], input=b"\xff", capture_output=True)
    assert (bytes.returncode, bytes.stderr) == (3, b"halation: -: the text is not UTF-8 (byte 0); save it as UTF-8\n")


@POSIX
def test_names_that_no_encoding_knows(ten, tmp_path):
    folder = os.fsencode(tmp_path) + b"/caf\xe9"
    result = subprocess.run([*HALATION, "render", os.fspath(ten), "-o", folder + b"/out.exr"], capture_output=True)
    assert result.returncode == 1 and result.stderr.endswith(
        b"caf\\udce9/out.exr: cannot be written: there is no such folder: create it first\n"
    )


def test_the_installed_command(ten):
    script = Path(sys.executable).with_name("halation")
    if not script.exists():
        pytest.skip("not installed as a command")
    result = subprocess.run([script, "check", ten], capture_output=True, text=True)
    said = [line.rpartition(" ")[2] for line in result.stdout.splitlines()]
    assert (result.returncode, said) == (0, ["[absolute-path]", "[not-canonical]"])


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux keeps to it")
def test_a_process_can_be_copied_as_soon_as_its_threads_have_ended():
    """A thread that has ended is listed for a moment: without patience, one process in some hundred is not copied."""
    code = (
        "import threading; from halation.cli.watchdog import can_fork\n"
        "copied = 0\n"
        "for _ in range(500):\n"
        "    thread = threading.Thread(target=int); thread.start(); thread.join()\n"
        "    copied += can_fork()\n"
        "print(copied)\n"
        "event = threading.Event()\n"
        "threading.Thread(target=event.wait).start()\n"
        "print(can_fork())\n"
        "event.set()\n"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=100)
    assert run.stdout.split() == ["500", "False"], run.stdout + run.stderr
