"""How fast Halation is, beside other programs on the same work. One command measures everything and prints it:

    .venv/bin/python tests/bench/run.py --sizes hd,uhd --venvs FOLDER --json new.json --table

Every task is done by whole processes, which read EXR, work and write EXR, and in memory, all programs in turn, again
and again: a moment in which the machine is busy falls on all of them alike. docs/performance.md says what is printed.
"""

from __future__ import annotations

import argparse
import os
import platform
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1]))

from bench.extras import extras
from bench.figures import table
from bench.measuring import Place, memory, whole
from bench.programs import HERE, OURS, installed
from bench.report import listing
from bench.results import Results
from bench.started import run
from bench.tasks import PICTURES, SIZES, TASKS

STILL = 1920
"""Wider pictures come without the sequence: 24 frames of them take too long."""

Say = Callable[[str], None]


def options() -> argparse.Namespace:
    """What was asked for."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "halation" / "bench"
    venvs = os.environ.get("HALATION_BENCH_VENVS")
    reader = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    reader.add_argument("--sizes", default="hd", help=f"some of {', '.join(SIZES)}")
    reader.add_argument("--tasks", default=",".join(TASKS), help=f"some of {', '.join(TASKS)}")
    reader.add_argument("--programs", default="", help="some of those that are installed; by default all of them")
    reader.add_argument("--rounds", type=int, default=5, help="how often each program does each task")
    reader.add_argument("--repeat", type=int, default=3, help="how often in each of half as many rounds in memory")
    reader.add_argument("--parts", default="whole,memory,extras", help="what to measure")
    reader.add_argument(
        "--venvs",
        type=Path,
        default=Path(venvs) if venvs else None,
        metavar="FOLDER",
        help="virtual environments of peers: blender, blender5, numba, opencv; or HALATION_BENCH_VENVS",
    )
    reader.add_argument("--data", type=Path, default=cache, metavar="FOLDER", help=f"pictures, made once; {cache}")
    reader.add_argument("--json", type=Path, metavar="FILE", help="keep the results")
    reader.add_argument("--against", type=Path, metavar="FILE", help="compare with results that were kept")
    reader.add_argument("--from", dest="earlier", type=Path, metavar="FILE", help="print these, measure nothing")
    reader.add_argument("--table", action="store_true", help="print what is wanted, too, and whether it is reached")
    given = reader.parse_args()
    for name, known in (("sizes", SIZES), ("tasks", TASKS), ("parts", ("whole", "memory", "extras"))):
        setattr(given, name, [word for word in getattr(given, name).split(",") if word])
        for word in getattr(given, name):
            if word not in known:
                reader.error(f"--{name} {word}: it is none of {', '.join(known)}")
    return given


def folder_of(data: Path, size: str, say: Say) -> Path:
    """The pictures of a size, made if they are not there."""
    width, height = SIZES[size]
    folder = data / f"{PICTURES}-{width}x{height}"
    if not folder.exists():
        say(f"making pictures in {folder}")
        data.mkdir(parents=True, exist_ok=True)
        still = ["--still"] if width > STILL else []
        ended = run([sys.executable, str(HERE / "inputs.py"), str(folder), f"{width}x{height}", *still])
        if ended.code:
            raise SystemExit(ended.said)
    return folder


def machine() -> dict[str, object]:
    """What the numbers are of."""
    processor = platform.processor() or platform.machine()
    try:
        lines = Path("/proc/cpuinfo").read_text("utf-8").splitlines()
        processor = next(line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        pass
    return {
        "processor": processor,
        "processors": len(os.sched_getaffinity(0)),
        "system": platform.platform(),
        "python": platform.python_version(),
    }


def main() -> None:
    """Measure, keep, print."""
    given = options()

    def say(text: str) -> None:
        print(text, file=sys.stderr, flush=True)

    results = Results.load(given.earlier) if given.earlier else measured(given, say)
    print(listing(results, Results.load(given.against) if given.against else None))
    if given.table:
        print("\n" + table(results))


def measured(given: argparse.Namespace, say: Say) -> Results:
    """All that was asked for; kept after every task, so that nothing is lost."""
    programs = list(installed(given.venvs))
    wanted = given.programs.split(",") if given.programs else [one.name for one in programs]
    for name in wanted:
        if name not in [one.name for one in programs]:
            raise SystemExit(f"--programs {name}: it is not installed; there are {', '.join(p.name for p in programs)}")
    programs = [one for one in programs if one.name in wanted]
    say(f"programs: {', '.join(wanted)}")
    results = Results(machine())
    with tempfile.TemporaryDirectory(prefix="halation-bench-") as made:
        for size in given.sizes:
            place = Place(size, folder_of(given.data, size, say), Path(made, size))
            place.out.mkdir()
            for task in given.tasks:
                if task == "T10" and SIZES[size][0] > STILL:
                    continue
                say(f"{size} {task}")
                if "whole" in given.parts:
                    whole(results, place, task, programs, given.rounds)
                if "memory" in given.parts:
                    memory(results, place, task, programs, (given.rounds + 1) // 2, given.repeat)
                for file in place.out.iterdir():
                    file.unlink()
                if given.json:
                    results.save(given.json)
        if "extras" in given.parts and OURS in wanted:
            size = given.sizes[0]
            place = Place(size, folder_of(given.data, size, say), Path(made, size))
            results.extras = {"size": size, **extras(place, given.rounds, given.repeat, say)}
    if given.json:
        results.save(given.json)
    return results


if __name__ == "__main__":
    main()
