"""The hostile campaign: everything that a file, a folder or a machine can do to Halation, by one command.

    .venv/bin/python tests/hostile/run.py                         # a quick round of everything
    .venv/bin/python tests/hostile/run.py graphs --seed 3 --count 20000 -j 2
    .venv/bin/python tests/hostile/run.py images --collection FOLDER      # public collections, fetched by you

The same seed makes the same cases. Files of cases that went wrong are kept in the folder that --keep names. Ends with 1
if any case crashed, hung, escaped, printed a traceback, left a file half-written, or ended with a code that no page
promises.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import abuse
import graphs
import images
import jails
import kills
import oddities
import soak
from pool import Tally, run_cases

import shaders

KINDS = ("graphs", "shaders", "images", "jails", "oddities", "kills", "abuse", "concurrency", "soak")
QUICK = {
    "graphs": 400,
    "shaders": 120,
    "images": 200,
    "jails": 150,
    "oddities": 150,
    "kills": 40,
    "concurrency": 3,
    "soak": 700,
}
FULL = {
    "graphs": 20000,
    "shaders": 5000,
    "images": 2000,
    "jails": 0,
    "oddities": 0,
    "kills": 500,
    "concurrency": 40,
    "soak": 1500,
}
"""Cases of a whole campaign, as docs/security.md reports it; 0 jails or oddities are all of them."""


def read_options() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kinds", nargs="*", choices=[*KINDS, []], help="what to run; by default everything")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, help="cases of each kind")
    parser.add_argument("--full", action="store_true", help="as many cases as a whole campaign has")
    parser.add_argument("-j", "--jobs", type=int, default=2, help="cases at the same time")
    parser.add_argument("--patience", type=float, default=1.0, help="multiplies the time that each case may take")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="where the files of bad cases are copied to")
    parser.add_argument("--collection", type=Path, metavar="FOLDER", help="pictures to damage, instead of our own")
    return parser.parse_args()


def run_kind(kind: str, options: argparse.Namespace) -> Tally:
    """One kind of case."""
    count = options.count if options.count is not None else (FULL if options.full else QUICK).get(kind, 0)
    if kind == "kills":
        return kills.run_kills(count, options.jobs, options.keep)
    if kind == "abuse":
        return abuse.run_abuse(options.keep)
    if kind == "concurrency":
        return soak.run_concurrency(count)
    if kind == "soak":
        return soak.run_soak(count)
    if kind == "images":
        cases = images.build_cases(options.seed, count, options.collection)
    else:
        cases = {"graphs": graphs, "shaders": shaders, "jails": jails, "oddities": oddities}[kind].build_cases(
            options.seed, count
        )
    return run_cases(cases, options.jobs, options.keep, options.patience)


def main() -> int:
    """Run what is asked for and print a table."""
    options = read_options()
    rows: list[tuple[str, Tally, float]] = []
    for kind in options.kinds or KINDS:
        began = time.monotonic()
        rows.append((kind, run_kind(kind, options), time.monotonic() - began))
    print("\n| what | cases | faults | slowest, s | largest, MiB | minutes |\n|---|---|---|---|---|---|")
    for kind, tally, seconds in rows:
        figures = f"{tally.slowest:.1f} | {tally.peak >> 20} | {seconds / 60:.1f}"
        print(f"| {kind} | {tally.count} | {len(tally.faults)} | {figures} |")
    return int(any(tally.faults for _, tally, _ in rows))


if __name__ == "__main__":
    sys.exit(main())
