"""Renders and saves that are killed at every system call that writes: what is there afterwards is whole, old or new.

`tracer.py` counts the calls that change files of the folder, in which home and caches lie as well, and kills at the one
of a number, so no moment is left to luck. In a second round everything that the command started is killed with it, as
by a machine that has no memory left. Then the same command runs once more and must end well.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import zip_longest
from pathlib import Path
from typing import Any

import av
import OpenImageIO as oiio
from av.error import FFmpegError
from cases import UNFINISHED
from pool import Tally

HALATION = (sys.executable, "-P", "-m", "halation.cli")
SAVING = (sys.executable, "-P", str(Path(__file__).with_name("saving.py")))
TRACER = (sys.executable, str(Path(__file__).with_name("tracer.py")))

VIDEO_FRAMES = 4

SCENES: dict[str, tuple[str, ...]] = {
    "one EXR": (*HALATION, "render", "graph.json", "-o", "out.exr"),
    "a PNG": (*HALATION, "render", "graph.json", "-o", "out.png"),
    "two files": (*HALATION, "render", "graph.json", "-o", "out.exr", "-o", "image=out.png"),
    "a TIFF": (*HALATION, "render", "graph.json", "-o", "out.tif"),
    "a JPEG": (*HALATION, "render", "graph.json", "-o", "out.jpg"),
    "a WebP": (*HALATION, "render", "graph.json", "-o", "out.webp"),
    "an HDR": (*HALATION, "render", "graph.json", "-o", "out.hdr"),
    "a DPX": (*HALATION, "render", "graph.json", "-o", "out.dpx"),
    "a video": (*HALATION, "render", "graph.json", "-o", "out.mp4", "--frames", f"1-{VIDEO_FRAMES}"),
    "two processes": (*HALATION, "render", "graph.json", "-o", "out.####.exr", "--frames", "1-6", "-j", "2"),
    "a long sequence": (*HALATION, "render", "graph.json", "-o", "out.####.exr", "--frames", "1-12"),
    "pictures of a sequence": (*HALATION, "render", "graph.json", "-o", "out.####.png", "--frames", "1-12"),
    "tiles": (*HALATION, "render", "graph.json", "-o", "out.exr", "--size", "900x700", "--memory", "12M"),
    "a sweep": (*HALATION, "sweep", "graph.json", "--set", "n.size=10,50", "-o", "out.png"),
    "goldens": (*HALATION, "test", "--update"),
    "reports of tests": (*HALATION, "test", "--report", "report.html", "--junit", "junit.xml", "--out", "failed"),
    "fmt": (*HALATION, "fmt", "messy.json"),
    "many graphs": (*HALATION, "fmt", "many"),
    "a merge": (*HALATION, "merge", "graph.json", "messy.json", "other.json", "-o", "merged.json"),
    "an ISF": (*HALATION, "export", "graph.json", "-o", "out.fs"),
    "a log": (*HALATION, "check", "messy.json", "--sarif", "log.json"),
    "the cache of devices": (*SAVING, "cache"),
    "preferences": (*SAVING, "preferences"),
    "unsaved work": (*SAVING, "recovery"),
    "saves of the editor": (*SAVING, "session"),
}

GOOD_CODES = {"reports of tests": (1,)}
"""Where a command that ends well finds a difference."""

GRAPH = {
    "halation": 1,
    "settings": {"size": [40, 24]},
    "outputs": {"image": {"type": "Image"}},
    "nodes": {"n": {"type": "noise"}},
    "links": {"outputs.image": "n.out"},
}


SUITE = """[defaults]
size = "24x16"

[cases.one]
graph = "graph.json"
golden = "goldens/one.exr"

[cases.two]
graph = "messy.json"
golden = "goldens/two.png"
"""


def prepare(folder: Path) -> None:
    """Graphs, and older results where new ones will be written."""
    (folder / "graph.json").write_text(json.dumps(GRAPH))
    (folder / "messy.json").write_text(json.dumps(GRAPH, indent=7))
    (folder / "other.json").write_text(json.dumps({**GRAPH, "settings": {"size": [80, 24]}}))
    (folder / "log.json").write_text("{}")
    (folder / "many").mkdir()
    for number in range(12):
        (folder / "many" / f"{number}.json").write_text(json.dumps(GRAPH, indent=5))
    for name in ("out.exr", "out.png", "out.0001.exr", "out.0002.exr"):
        oiio.ImageBuf(oiio.ImageSpec(8, 8, 4, "half")).write(str(folder / name))


def _prepare_more(folder: Path) -> None:
    """The suite, a golden that differs, and the folders of a user."""
    prepare(folder)
    (folder / "looks.suite.toml").write_text(SUITE)
    (folder / "goldens").mkdir()
    oiio.ImageBuf(oiio.ImageSpec(24, 16, 4, "half")).write(str(folder / "goldens" / "one.exr"))
    (folder / "home").mkdir()


def find_broken(folder: Path) -> Iterator[str]:
    """Results that are neither whole nor absent."""
    paths = (*folder.glob("out.*"), *folder.glob("goldens/*"), *folder.glob("failed/**/*.*"))
    for path in sorted(path for path in paths if not UNFINISHED.search(path.name)):
        if path.suffix == ".fs":
            if not path.read_text("utf-8").endswith("}\n"):
                yield f"half-written: {path.name}"
            continue
        if not _is_whole_video(path) if path.suffix == ".mp4" else not _is_whole_picture(path):
            yield f"half-written: {path.name}"
    for path in sorted(folder.rglob("*.json")):
        try:
            json.loads(path.read_text("utf-8"))
        except ValueError:
            yield f"half-written: {path.name}"
    for name, end in (("report.html", "</html>"), ("junit.xml", "</testsuites>")):
        path = folder / name
        if path.exists() and not path.read_text("utf-8").rstrip().endswith(end):
            yield f"half-written: {name}"


def _is_whole_picture(path: Path) -> bool:
    picture = oiio.ImageInput.open(str(path))
    return picture is not None and picture.read_image() is not None


def _is_whole_video(path: Path) -> bool:
    try:
        with av.open(str(path)) as container:
            return len(list(container.decode(video=0))) == VIDEO_FRAMES
    except FFmpegError:
        return False


def run_kills(count: int, jobs: int, keep: Path | None) -> Tally:
    """So many kills, spread evenly over all calls of all scenes."""
    with ThreadPoolExecutor(jobs) as threads:
        totals = list(threads.map(_count_changes, SCENES))
        moments = _choose_moments(dict(zip(SCENES, totals, strict=True)), count)
        results = list(threads.map(lambda moment: _kill(moment[0], moment[1], moment[2], keep), moments))
    tally = Tally()
    for name, faults in filter(None, results):
        tally.count += 1
        tally.faults += [(name, fault) for fault in faults]
    print(f"{sum(totals)} calls in {len(totals)} scenes; {tally.count} of {len(moments)} moments were hit", flush=True)
    return tally


def _choose_moments(totals: dict[str, int], count: int) -> list[tuple[str, int, str]]:
    """Scene, number of the call, and what is killed: every scene in turn, one process and everything in turn."""
    moments: list[tuple[str, int, str]] = []
    for kinds in (("one", "all"), ("all", "one")):
        scenes = [
            [(scene, number, kinds[number % 2]) for number in range(1, total + 1)] for scene, total in totals.items()
        ]
        moments += [moment for turn in zip_longest(*scenes) for moment in turn if moment]
    return moments[:count]


def _count_changes(scene: str) -> int:
    with tempfile.TemporaryDirectory(prefix="hostile-kill-") as text:
        _prepare_more(Path(text))
        answer = _trace(Path(text), 0, "one", SCENES[scene])
        assert answer["changes"], f"{scene}: nothing is written"
        return answer["changes"]


def _environment(folder: Path) -> dict[str, str]:
    home = {"HOME": folder / "home", "XDG_CACHE_HOME": folder / "home" / "cache", "XDG_CONFIG_HOME": folder / "home"}
    fixed = {"LP_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": "1", "MESA_SHADER_CACHE_DISABLE": "true"}
    return {**os.environ, **fixed, **{name: str(path) for name, path in home.items()}}


def _trace(folder: Path, moment: int, which: str, command: tuple[str, ...]) -> dict[str, Any]:
    words = [*TRACER, str(folder), str(moment), which, *command]
    process = subprocess.run(words, cwd=folder, capture_output=True, text=True, env=_environment(folder))
    if process.returncode:
        return {"code": process.returncode, "changes": 0, "killed": "", "hang": process.returncode < 0}
    return json.loads(process.stdout.splitlines()[-1])


def _kill(scene: str, moment: int, which: str, keep: Path | None) -> tuple[str, list[str]] | None:
    """The name and the faults of a kill; None if the run came to its end, because it wrote less this time."""
    with tempfile.TemporaryDirectory(prefix="hostile-kill-") as text:
        folder = Path(text)
        _prepare_more(folder)
        answer = _trace(folder, moment, which, SCENES[scene])
        name = f"kill {which} {scene} {moment}: {answer['killed']}"
        faults = ["hang"] if answer.get("hang") else list(find_broken(folder))
        if not faults and not answer["killed"]:
            return None
        again = subprocess.run(SCENES[scene], cwd=folder, capture_output=True, text=True, env=_environment(folder))
        if again.returncode not in GOOD_CODES.get(scene, (0,)):
            faults.append(f"the same command ends with {again.returncode} afterwards: {again.stderr.strip()[-200:]}")
        faults += [fault for fault in find_broken(folder) if fault not in faults]
        for fault in faults:
            print(f"{name}: {fault}", flush=True)
        if faults and keep:
            shutil.copytree(folder, keep / f"kill-{which}-{scene}-{moment}".replace(" ", "-"), dirs_exist_ok=True)
        return name, faults
