"""Workers that die, crash, lack something, or are no longer wanted: frames are whole, and all others are finished."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest
from farms import (
    CRASH,
    FRAMES,
    FULL,
    SLOW,
    check_whole,
    customize,
    end_group,
    list_written,
    make_graph,
    render_words,
    start_halation,
    wait_for_frames,
)

pytest.importorskip("distributed", reason="Dask is not installed")

OLD = """
import halation.version
halation.version.VERSION = "0.0.7"
"""
"""The same: an older version of Halation."""

BLIND = """
import sys
if "--chunks" in sys.orig_argv:
    from halation.errors import DeviceError
    from halation import renderer
    from halation.renderer import pinned_device
    def open_pinned(*_, **__):
        raise DeviceError("no usable OpenGL: install a driver")
    pinned_device.open_pinned = renderer.open_pinned = open_pinned
"""
"""The same: a machine without OpenGL."""


HUNGRY = """
import sys
if "--chunks" in sys.orig_argv:
    import time
    from halation.renderer.jobs import item_session
    plan = item_session.ItemSession.plan_task
    def plan_task(self, frame):
        if frame == 3:
            memory = bytearray(b"1") * (2 << 30)
            time.sleep(5.0)
        return plan(self, frame)
    item_session.ItemSession.plan_task = plan_task
"""
"""The same: a frame that takes 2 GiB."""

OTHER_GLSL = """
import sys
if "--chunks" in sys.orig_argv:
    import os, pathlib
    from halation.compiler import library
    library.folder = lambda: pathlib.Path(os.environ["OTHER_SHADERS"])
"""
"""The same: shaders that were changed."""

SHADERS = Path(__file__).parents[2] / "shaders"


def install_plug_in(folder: Path, version: str) -> Path:
    """A folder that Python imports a plug-in with one node from."""
    nodes, notes = folder / "acme" / "nodes" / "tone", folder / f"acme-{version}.dist-info"
    nodes.mkdir(parents=True)
    notes.mkdir()
    (nodes / "dim.py").write_text(
        "from halation.nodes import Image, Pointwise\n\n\n"
        'class Dim(Pointwise):\n    """Darken."""\n\n    image = Image()\n    factor: float = 0.5\n'
    )
    shader = folder / "acme" / "shaders" / "tone"
    shader.mkdir(parents=True)
    (shader / "dim.glsl").write_text("vec4 acme_dim(vec4 image, float factor) { return image * factor; }\n")
    (notes / "METADATA").write_text(f"Metadata-Version: 2.1\nName: acme\nVersion: {version}\n")
    (notes / "entry_points.txt").write_text("[halation.nodes]\nacme = acme\n")
    return folder


def test_a_frame_that_ends_its_process_each_time_is_named_and_others_are_finished(halation, shot, farm):
    graph = json.loads((shot / "shot.json").read_text())
    graph["inputs"]["plate"]["missing"] = "hold"
    (shot / "shot.json").write_text(json.dumps(graph))
    ending = halation(*render_words(farm, "660-670"), "--json")
    assert ending.code == 1
    assert re.search(r"frame 666: on 3 tries, the last on \S+: its process was ended by SIGKILL", ending.err), (
        ending.err
    )
    report = json.loads(ending.out)
    assert list(report["failed"]) == ["666"]
    assert list_written(shot) == [frame for frame in range(660, 671) if frame != 666]


def test_code_that_does_not_end_is_stopped_at_the_time_limit(halation, shot, farm):
    """In frames and in cases of a suite; the worker goes on."""
    loops = "for (int i = 0; i < 100000; i++) for (int j = 0; j < 100000; j++)"
    endless = f"float x = image.r; {loops} x = fract(sin(x + i) * j);"
    graph = {
        "halation": 1,
        "inputs": {"plate": {"type": "Image", "default": [0.5, 0.5, 0.5, 1.0]}},
        "nodes": {"slow": {"type": "glsl", "code": ["vec4 f(vec4 image) {", endless, "return image * x;", "}"]}},
        "links": {"slow.image": "inputs.plate", "outputs.image": "slow.out"},
        "outputs": {"image": {"type": "Image"}},
        "settings": {"size": [512, 512]},
    }
    (shot / "endless.json").write_text(json.dumps(graph))
    ending = halation("render", "endless.json", "-o", "x.exr", "--timeout", "1", "--cluster", farm.address)
    assert ending.code == 1 and not (shot / "x.exr").exists()
    assert "node 'slow': its code has not ended after 1 seconds" in ending.err, ending.err
    (shot / "e.suite.toml").write_text('[cases.endless]\ngraph = "endless.json"\ngolden = ""\n')
    ending = halation("test", "e.suite.toml", "--timeout", "1", "--cluster", farm.address, "--json")
    assert ending.code == 1 and "its code has not ended after 1 seconds" in ending.out, ending.out
    assert halation(*render_words(farm, "1")).code == 0


def test_machines_that_cannot_render_the_same_are_refused_with_the_reason(halation, shot, make_farm, tmp_path):
    """One has another version, one no OpenGL, one a full disk; the last one renders everything."""
    farm = make_farm()
    for name, text in (("old", OLD), ("blind", BLIND), ("full", FULL)):
        farm.start_worker(**customize(tmp_path / name, text))
    farm.start_worker()
    farm.wait_for_workers()
    ending = halation(*render_words(farm))
    assert ending.code == 0, ending.err
    lines = [line for line in ending.err.splitlines() if line.startswith("worker tcp://")]
    assert any("it has Halation 0.0.7, and the job was sent by " in line for line in lines), lines
    check_whole(halation, shot)
    end_group(farm.workers[3])
    ending = halation(*render_words(farm))
    assert ending.code == 1 and "no usable OpenGL: install a driver" in ending.err, ending.err


def test_a_worker_with_another_plug_in_or_other_glsl_is_refused_with_both_versions(
    halation, shot, make_farm, tmp_path, monkeypatch
):
    sites = [install_plug_in(tmp_path / f"site{version}", version) for version in ("1.0", "2.0")]
    shaders = shutil.copytree(SHADERS, tmp_path / "shaders")
    exposure = shaders / "color" / "exposure.glsl"
    exposure.write_text(exposure.read_text().replace("exp2(", "exp2(0.5 * "))
    graph = make_graph()
    graph["nodes"]["dim"] = {"type": "acme.dim"}
    graph["links"] |= {"dim.image": "blur.out", "outputs.image": "dim.out"}
    (shot / "shot.json").write_text(json.dumps(graph))
    monkeypatch.setenv("HALATION_PLUGINS", "acme")
    monkeypatch.setenv("PYTHONPATH", str(sites[0]))
    farm = make_farm()
    farm.start_worker(PYTHONPATH=str(sites[1]))
    glsl = customize(tmp_path / "glsl", OTHER_GLSL)["PYTHONPATH"]
    farm.start_worker(PYTHONPATH=f"{glsl}{os.pathsep}{sites[0]}", OTHER_SHADERS=str(shaders))
    farm.wait_for_workers()
    ending = halation(*render_words(farm))
    assert ending.code == 1 and not list_written(shot)
    assert "it has the plug-in acme 2.0, and the job was sent by 1.0" in ending.err, ending.err
    assert re.search(r"it has node type exposure [0-9a-f]{12}, and the job was sent by [0-9a-f]{12}", ending.err)
    farm.start_worker(PYTHONPATH=str(sites[0]))
    farm.wait_for_workers()
    ending = halation(*render_words(farm))
    assert ending.code == 0, ending.err
    check_whole(halation, shot)


def test_a_frame_that_needs_more_memory_than_its_worker_has_is_named_and_the_worker_goes_on(
    halation, shot, make_farm, tmp_path
):
    farm = make_farm()
    farm.start_worker("--memory-limit", "900MiB", **customize(tmp_path / "hungry", HUNGRY))
    ending = halation(*render_words(farm))
    assert ending.code == 1
    assert re.search(r"frame 3: on 3 tries, the last on \S+: it takes more than the 0.9 GiB of its worker", ending.err)
    assert list_written(shot) == [frame for frame in FRAMES if frame != 3]
    os.killpg(farm.workers[0], 0)  # it is there


def test_a_killed_worker_and_a_new_one(halation, shot, make_farm, tmp_path):
    farm = make_farm()
    slow = customize(tmp_path / "slow", SLOW)
    for _ in range(2):
        farm.start_worker(**slow)
    process = start_halation(*render_words(farm), cwd=shot)
    wait_for_frames(shot, 2)
    end_group(farm.workers[0])
    farm.start_worker(**slow)
    _, err = process.communicate(timeout=100)
    assert process.returncode == 0, err
    check_whole(halation, shot)


@pytest.mark.parametrize("place", ["farm", "local"])
def test_an_interrupt_ends_a_job_soon_and_leaves_finished_frames(
    shot, make_farm, tmp_path, place, monkeypatch, is_nightly
):
    if place == "local" and not is_nightly:
        pytest.skip("tried nightly")
    slow = customize(tmp_path / "slow", SLOW)
    if place == "farm":
        farm = make_farm()
        farm.start_worker(**slow)
        words = render_words(farm)
    else:
        monkeypatch.setenv("PYTHONPATH", slow["PYTHONPATH"])
        words = ("render", "shot.json", "-o", "f.####.exr", "--deterministic", "--cluster", "local:1")
    process = start_halation(*words, cwd=shot)
    wait_for_frames(shot, 2)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=30)
    assert process.returncode == 130 and "interrupted" in err, err
    time.sleep(1.5)
    written = list_written(shot)
    assert len(written) < len(FRAMES) and not list(shot.glob(".halation-*"))
    time.sleep(1.0)
    assert list_written(shot) == written
    assert os.name == "nt" or not find_processes(shot)


def find_processes(shot) -> list[str]:
    """Processes that render chunks in the folder of a shot."""
    lines = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=True).stdout.splitlines()
    return [line for line in lines if "--chunks" in line and str(shot) in line]


CRASH_ONCE = """
import os, sys
if "--chunks" in sys.orig_argv:
    from halation.renderer.jobs import item_session
    plan = item_session.ItemSession.plan_task
    def plan_task(self, frame):
        mark = os.environ["CRASH_MARK"]
        if frame == 6 and not os.path.exists(mark):
            open(mark, "w").close()
            os.kill(os.getpid(), 9)
        return plan(self, frame)
    item_session.ItemSession.plan_task = plan_task
"""
"""The same: a frame that ends its process the first time."""


def test_a_video_is_whole_after_its_process_has_ended(halation, shot, make_farm, tmp_path):
    """All frames are in one file, so those before the crash are rendered again."""
    pytest.importorskip("av", reason="PyAV is not installed")
    farm = make_farm()
    farm.start_worker(**customize(tmp_path / "crash", CRASH_ONCE), CRASH_MARK=str(tmp_path / "crashed"))
    words = ("shot.json", "--codec", "ffv1", "--deterministic")
    assert halation("render", *words, "-o", "one.mkv").code == 0
    ending = halation("render", *words, "-o", "many.mkv", "--cluster", farm.address)
    assert ending.code == 0 and (tmp_path / "crashed").exists(), ending.err
    pictures = [read_video(shot / name) for name in ("one.mkv", "many.mkv")]
    assert len(pictures[0]) == 8 and all((a == b).all() for a, b in zip(*pictures, strict=True))


def read_video(path):
    import av

    with av.open(str(path)) as container:
        return [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]


def test_the_frame_at_fault_of_a_chain_is_named(halation, shot, farm):
    """One worker has another picture for frame 3: all frames of the chain fail, and the sentence is about that one."""
    graph = make_graph()
    graph["nodes"]["blur"] = {"type": "feedback"}
    del graph["animation"]
    (shot / "shot.json").write_text(json.dumps(graph))
    elsewhere = shot.parent.parent / "volumes"
    shutil.copytree(shot.parent, elsewhere)
    (elsewhere / "shot" / "plates" / "p.0003.exr").write_bytes(b"short")
    words = ("-o", "f.####.exr", "--deterministic", "--cluster", farm.address, "--map", f"{shot.parent}={elsewhere}")
    ending = halation("render", "shot.json", *words)
    assert ending.code == 1, ending.err
    assert f"frame 3: {elsewhere / 'shot' / 'plates' / 'p.0003.exr'}: is another file" in ending.err, ending.err
    assert "frame 1: one worker renders all frames, and frame 3 cannot be rendered" in ending.err


def test_a_frame_of_a_chain_that_ends_its_process_is_named_and_others_are_finished(halation, shot, make_farm, tmp_path):
    """Frames before it may be written and not reported yet when the process ends."""
    graph = make_graph()
    graph["nodes"]["blur"] = {"type": "feedback"}
    del graph["animation"]
    (shot / "shot.json").write_text(json.dumps(graph))
    farm = make_farm()
    farm.start_worker(**customize(tmp_path / "crash", CRASH), CRASH_AT="4")
    ending = halation(*render_words(farm))
    assert ending.code == 1 and "one worker renders all frames: node 'blur'" in ending.err, ending.err
    named = re.findall(r"^frame (\d): (.*)", ending.err, re.M)
    assert [frame for frame, _ in named] == ["4"] and named[0][1].startswith("on 3 tries, the last on "), ending.err
    (shot / "one").mkdir()
    assert halation("render", "shot.json", "-o", "one/f.####.exr", "--deterministic").code == 0
    for frame in (1, 2, 3, 5, 6, 7, 8):
        assert (shot / f"f.{frame:04d}.exr").read_bytes() == (shot / "one" / f"f.{frame:04d}.exr").read_bytes()
    assert list_written(shot) == [1, 2, 3, 5, 6, 7, 8]


def test_a_chain_with_a_missing_picture_names_each_frame(halation, shot, farm):
    """The frames before the faulty one are finished; the others are named, although another worker has tried them."""
    graph = make_graph()
    graph["nodes"]["blur"] = {"type": "feedback"}
    del graph["animation"]
    (shot / "shot.json").write_text(json.dumps(graph))
    (shot / "plates" / "p.0005.exr").unlink()
    words = ("-o", "f.####.exr", "--deterministic", "--cluster", farm.address, "--frames", "1-8")
    ending = halation("render", "shot.json", *words)
    assert ending.code == 1 and "frame 5: " in ending.err and "p.0005.exr" in ending.err, ending.err
    assert "frame 6: one worker renders all frames, and frame 5 cannot be rendered" in ending.err
    assert list_written(shot) == [1, 2, 3, 4]


def test_a_row_of_faulty_frames_costs_no_worker(halation, shot, farm):
    """Six plates are missing: each of their frames is named, and the others are finished."""
    for frame in range(2, 8):
        (shot / "plates" / f"p.{frame:04d}.exr").unlink()
    ending = halation(*render_words(farm))
    assert ending.code == 1, ending.err
    assert [frame for frame in range(1, 9) if f"frame {frame}: " in ending.err] == [*range(2, 8)], ending.err
    assert list_written(shot) == [1, 8]
