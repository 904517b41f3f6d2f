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

from bench.conditions import compute_condition_rows, list_presets, measure_presets, measure_threads
from bench.extras import measure_extras
from bench.figures import compute_rows, format_table
from bench.measuring import Place, measure_in_memory, measure_processes
from bench.programs import HERE, OURS, find_programs
from bench.report import format_results
from bench.results import Results
from bench.started import run_process
from bench.tasks import PICTURES, SEED, SIZES, TASKS

STILL = 1920
"""Wider pictures come without the sequence: 24 frames of them take too long."""

PARTS = ("whole", "memory", "extras", "presets", "threads")
Say = Callable[[str], None]


def read_options() -> argparse.Namespace:
    """What was asked for."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "halation" / "bench"
    venvs = os.environ.get("HALATION_BENCH_VENVS")
    reader = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    reader.add_argument("--sizes", default="hd", help=f"some of {', '.join(SIZES)}")
    reader.add_argument("--tasks", default=",".join(TASKS), help=f"some of {', '.join(TASKS)}")
    reader.add_argument("--programs", default="", help="some of those that are installed; by default all of them")
    reader.add_argument("--rounds", type=int, default=5, help="how often each program does each task")
    reader.add_argument("--repeat", type=int, default=3, help="how often in each of half as many rounds in memory")
    reader.add_argument(
        "--seed", default="", help="vary sigmas, lengths and strengths: the same numbers for all programs"
    )
    reader.add_argument("--parts", default="whole,memory,extras", help=f"some of {', '.join(PARTS)}")
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
    arguments = reader.parse_args()
    if arguments.seed and os.environ.get(SEED) != arguments.seed:  # what is imported already has taken its numbers
        os.execve(sys.executable, [sys.executable, *sys.argv], {**os.environ, SEED: arguments.seed})
    for name, choices in (("sizes", SIZES), ("tasks", TASKS), ("parts", PARTS)):
        setattr(arguments, name, [word for word in getattr(arguments, name).split(",") if word])
        for word in getattr(arguments, name):
            if word not in choices:
                reader.error(f"--{name} {word}: it is none of {', '.join(choices)}")
    return arguments


def prepare_pictures(data: Path, size: str, say: Say) -> Path:
    """The pictures of a size, made if they are not there."""
    width, height = SIZES[size]
    folder = data / f"{PICTURES}-{width}x{height}"
    if not folder.exists():
        say(f"making pictures in {folder}")
        data.mkdir(parents=True, exist_ok=True)
        still = ["--still"] if width > STILL else []
        process = run_process([sys.executable, str(HERE / "inputs.py"), str(folder), f"{width}x{height}", *still])
        if process.code:
            raise SystemExit(process.output)
    return folder


def describe_machine() -> dict[str, object]:
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
        **({"seed": os.environ[SEED]} if os.environ.get(SEED) else {}),
    }


def main() -> None:
    """Measure, keep, print."""
    arguments = read_options()

    def say(text: str) -> None:
        print(text, file=sys.stderr, flush=True)

    results = Results.load(arguments.earlier) if arguments.earlier else measure(arguments, say)
    print(format_results(results, Results.load(arguments.against) if arguments.against else None))
    if arguments.table:
        print("\n" + format_table([*compute_rows(results), *compute_condition_rows(results.extras)]))


def measure(arguments: argparse.Namespace, say: Say) -> Results:
    """All that was asked for; kept after every task, so that nothing is lost."""
    programs = list(find_programs(arguments.venvs))
    names = arguments.programs.split(",") if arguments.programs else [one.name for one in programs]
    for name in names:
        if name not in [one.name for one in programs]:
            raise SystemExit(f"--programs {name}: it is not installed; there are {', '.join(p.name for p in programs)}")
    programs = [one for one in programs if one.name in names]
    say(f"programs: {', '.join(names)}")
    results = Results(describe_machine())
    with tempfile.TemporaryDirectory(prefix="halation-bench-") as output:
        for size in arguments.sizes:
            place = Place(size, prepare_pictures(arguments.data, size, say), Path(output, size))
            place.out.mkdir()
            for task in arguments.tasks:
                if task == "T10" and SIZES[size][0] > STILL:
                    continue
                say(f"{size} {task}")
                if "whole" in arguments.parts:
                    measure_processes(results, place, task, programs, arguments.rounds)
                if "memory" in arguments.parts:
                    measure_in_memory(results, place, task, programs, (arguments.rounds + 1) // 2, arguments.repeat)
                for file in place.out.iterdir():
                    file.unlink()
                if arguments.json:
                    results.save(arguments.json)
        if "extras" in arguments.parts and OURS in names:
            size = arguments.sizes[0]
            place = Place(size, prepare_pictures(arguments.data, size, say), Path(output, size))
            results.extras = {"size": size, **measure_extras(place, arguments.rounds, arguments.repeat, say)}
        if "presets" in arguments.parts:
            results.extras["presets"] = measure_presets(list_presets(), arguments.rounds, say)
        if "threads" in arguments.parts:
            size = arguments.sizes[0]
            place = Place(size, prepare_pictures(arguments.data, size, say), Path(output, size))
            results.extras["threads"] = measure_threads(place, arguments.rounds, say)
    if arguments.json:
        results.save(arguments.json)
    return results


if __name__ == "__main__":
    main()
