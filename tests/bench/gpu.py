"""How fast Halation is on a card, and whether it makes the pictures that the software rasterizer makes:

    .venv/bin/python tests/bench/gpu.py --json card.json --table

Times are of timer queries, pass by pass; what they are held against is the bandwidth of copies, measured first. Where
there is no GPU it is a dry run of tiny pictures, whose figures mean nothing. docs/performance.md says what is printed.
"""

from __future__ import annotations

import argparse
import shutil
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from halation.resources.sandbox import UNRESTRICTED

sys.path.append(str(Path(__file__).parents[1]))

from bench.gpu_measuring import measure_copies, measure_presets, measure_work
from bench.gpu_pictures import PRESETS
from bench.gpu_table import format_results, format_table
from bench.gpu_work import WORK
from bench.results import Results
from bench.run import describe_machine
from bench.started import run_process
from halation.renderer import open_device

Say = Callable[[str], None]
PARTS = ("copies", "work", "presets")


def read_options(words: Sequence[str] | None = None) -> argparse.Namespace:
    """What was asked for."""
    reader = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    reader.add_argument("--parts", default=",".join(PARTS), help=f"some of {', '.join(PARTS)}")
    reader.add_argument("--work", default=",".join(WORK), help=f"some of {', '.join(WORK)}")
    reader.add_argument("--presets", default="", help="some presets, by name; by default all of them")
    reader.add_argument("--rounds", type=int, default=3, help="how often all of it takes its turn")
    reader.add_argument("--repeat", type=int, default=20, help="how often in each turn")
    reader.add_argument(
        "--software",
        type=Path,
        metavar="FOLDER",
        help="pictures of the software rasterizer; what is missing in it is made",
    )
    reader.add_argument("--dry", action="store_true", help="tiny pictures and few presets: see whether all of it runs")
    reader.add_argument("--json", type=Path, metavar="FILE", help="keep the results")
    reader.add_argument("--from", dest="earlier", type=Path, metavar="FILE", help="print these, measure nothing")
    reader.add_argument("--table", action="store_true", help="print what is wanted, too, and whether it is reached")
    arguments = reader.parse_args(words)
    for name, choices in (("parts", PARTS), ("work", WORK), ("presets", PRESETS)):
        setattr(arguments, name, [word for word in getattr(arguments, name).split(",") if word])
        for word in getattr(arguments, name):
            if word not in choices:
                reader.error(f"--{name} {word}: it is none of {', '.join(choices)}")
    return arguments


def main() -> None:
    """Measure, keep, print."""
    arguments = read_options()

    def say(text: str) -> None:
        print(text, file=sys.stderr, flush=True)

    results = Results.load(arguments.earlier) if arguments.earlier else measure(arguments, say)
    print(format_results(results))
    if arguments.table:
        print(format_table(results))


def measure(arguments: argparse.Namespace, say: Say) -> Results:
    """All that was asked for; kept after every part."""
    device = open_device(sandbox=UNRESTRICTED)
    software = device.target.software
    arguments.dry = arguments.dry or software
    if arguments.dry:
        arguments.rounds, arguments.repeat = min(arguments.rounds, 2), min(arguments.repeat, 3)
    results = Results(
        {
            **describe_machine(),
            "card": device.target.renderer,
            "driver": device.driver,
            "form": device.target.form,
            "why": device.target.why,
            "software": software,
            "dry": arguments.dry,
            "nvidia": describe_nvidia_card(),
        }
    )
    parts = {"copies": measure_copies, "work": measure_work, "presets": measure_presets}
    for name in PARTS:
        if name in arguments.parts:
            parts[name](results, device, arguments, say)
            if arguments.json:
                results.save(arguments.json)
    return results


def describe_nvidia_card() -> str:
    """What NVIDIA's own tool says of the card; "" without it."""
    if not shutil.which("nvidia-smi"):
        return ""
    facts = "name,driver_version,memory.total,clocks.max.sm,clocks.max.memory"
    process = run_process(["nvidia-smi", f"--query-gpu={facts}", "--format=csv,noheader"])
    return "" if process.code else process.output.strip().replace("\n", "; ")


if __name__ == "__main__":
    main()
