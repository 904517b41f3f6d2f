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

sys.path.append(str(Path(__file__).parents[1]))

from bench.gpu_measuring import measure_copies, measure_presets, measure_work
from bench.gpu_pictures import PRESETS
from bench.gpu_table import listing, table
from bench.gpu_work import WORK
from bench.results import Results
from bench.run import machine
from bench.started import run
from halation.renderer import open_device

Say = Callable[[str], None]
PARTS = ("copies", "work", "presets")


def options(words: Sequence[str] | None = None) -> argparse.Namespace:
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
    given = reader.parse_args(words)
    for name, known in (("parts", PARTS), ("work", WORK), ("presets", PRESETS)):
        setattr(given, name, [word for word in getattr(given, name).split(",") if word])
        for word in getattr(given, name):
            if word not in known:
                reader.error(f"--{name} {word}: it is none of {', '.join(known)}")
    return given


def main() -> None:
    """Measure, keep, print."""
    given = options()

    def say(text: str) -> None:
        print(text, file=sys.stderr, flush=True)

    results = Results.load(given.earlier) if given.earlier else measured(given, say)
    print(listing(results))
    if given.table:
        print(table(results))


def measured(given: argparse.Namespace, say: Say) -> Results:
    """All that was asked for; kept after every part."""
    device = open_device()
    software = device.target.software
    given.dry = given.dry or software
    if given.dry:
        given.rounds, given.repeat = min(given.rounds, 2), min(given.repeat, 3)
    results = Results(
        {
            **machine(),
            "card": device.target.renderer,
            "driver": device.driver,
            "form": device.target.form,
            "why": device.target.why,
            "software": software,
            "dry": given.dry,
            "nvidia": nvidia(),
        }
    )
    parts = {"copies": measure_copies, "work": measure_work, "presets": measure_presets}
    for name in PARTS:
        if name in given.parts:
            parts[name](results, device, given, say)
            if given.json:
                results.save(given.json)
    return results


def nvidia() -> str:
    """What NVIDIA's own tool says of the card; "" without it."""
    if not shutil.which("nvidia-smi"):
        return ""
    facts = "name,driver_version,memory.total,clocks.max.sm,clocks.max.memory"
    ended = run(["nvidia-smi", f"--query-gpu={facts}", "--format=csv,noheader"])
    return "" if ended.code else ended.said.strip().replace("\n", "; ")


if __name__ == "__main__":
    main()
