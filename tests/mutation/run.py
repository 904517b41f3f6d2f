"""Puts faults into a copy of the tree, one at a time, and says which of them no test notices.

    .venv/bin/python tests/mutation/run.py --seed 7 --count 20                  # 20 faults anywhere
    .venv/bin/python tests/mutation/run.py --seed 7 --count 20 renderer editor  # 20 faults in each of these rooms
    .venv/bin/python tests/mutation/run.py --at app/media/goldens.py:105        # all faults of one line
    .venv/bin/python tests/mutation/run.py --repairs                            # holes that were mended, opened again

The same seed draws the same faults of the same tree. Each is shown only to the tests near its file that `choice.py`
chooses, the nearest first, so a fault that is noticed far away counts as a survivor. Ends with 1 if a room's share of
noticed faults is below its floor in `floors.json`; a better share of at least fifty faults raises it with
`HALATION_RENEW=1`.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import sys
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1]))

from mutation.choice import select_tests
from mutation.forks import open_forks
from mutation.mutants import Mutant, list_mutants
from mutation.repairs import REPAIRS
from mutation.trials import SECONDS, Trial, Trials, rate, room_of
from source_trees import ROOT, copy_tree, import_from

FLOORS = Path(__file__).with_name("floors.json")
"""Room -> percent of faults that must be noticed: the least of what was measured on several seeds."""

ENOUGH = 50
"""Faults of a room from which on a better share raises its floor: of fewer, luck decides."""


def list_files(rooms: Iterable[str] = ()) -> list[Path]:
    """The files of those rooms, or of all."""
    files = [*(ROOT / "app").rglob("*.py"), *(ROOT / "nodes").rglob("*.py"), *(ROOT / "shaders").rglob("*.glsl")]
    paths = sorted(path.relative_to(ROOT) for path in files)
    return [path for path in paths if not (chosen := {*rooms}) or room_of(path) in chosen]


def draw_mutants(seed: int, count: int, rooms: tuple[str, ...]) -> list[Mutant]:
    """That many faults anywhere, or in each of those rooms; every fault is as likely as any other."""
    chance, sample = random.Random(seed), list[Mutant]()
    for room in rooms or ("",):
        files = list_files((room,) if room else ())
        mutants = [mutant for path in files for mutant in list_mutants(path, (ROOT / path).read_text("utf-8"))]
        sample += chance.sample(mutants, min(count, len(mutants)))
    return sample


def list_line_mutants(place: str) -> list[Mutant]:
    """All faults of one line, `app/media/goldens.py:105`."""
    name, _, number = place.rpartition(":")
    source = (ROOT / name).read_text("utf-8")
    mutants = list_mutants(Path(name), source)
    return [mutant for mutant in mutants if source.count("\n", 0, mutant.start) + 1 == int(number)]


@contextmanager
def open_trials(seconds: float = SECONDS) -> Iterator[Trials]:
    """A copy of the tree to try faults in, each by tests of so many seconds."""
    with tempfile.TemporaryDirectory() as folder:
        tree = copy_tree(Path(folder) / "tree")
        with open_forks(tree, import_from(tree)) as forks:
            yield Trials(tree, forks, seconds)


def undo_repairs(names: Iterable[str]) -> int:
    """Undo all repairs, or those whose name holds one of these words; 1 if a test does not notice one."""
    chosen = [repair for repair in REPAIRS if not names or any(word in repair.name for word in names)]
    survivors = 0
    with open_trials() as trials:
        for repair in chosen:
            source = (ROOT / repair.file).read_text("utf-8")
            trial = trials.try_test(repair.find_mutant(source), "repairs", repair.test)
            line = source.count("\n", 0, trial.mutant.start) + 1
            survivors += not trial.was_noticed
            print(
                "noticed " if trial.was_noticed else "SURVIVED", f"{repair.name}: {repair.file}:{line} ({trial.words})"
            )
    print(f"{len(chosen) - survivors} of {len(chosen)} repairs have a test that fails without them")
    return int(survivors > 0)


def raise_floors(floors: dict[str, float], scores: dict[str, tuple[int, int]]) -> dict[str, float]:
    """The floors with better shares of rooms where enough faults were tried."""
    shares = {room: 100.0 * noticed / count for room, (noticed, count) in scores.items() if count >= ENOUGH}
    return {**floors, **{room: max(round(share, 1), floors.get(room, 0.0)) for room, share in shares.items()}}


def read_options() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rooms", nargs="*", help="folders of app, `nodes` or `shaders`; by default everything")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=20, help="faults, of each room that is named")
    parser.add_argument("--seconds", type=float, default=SECONDS, help="processor time for the tests of a fault")
    parser.add_argument("--repairs", action="store_true", help="undo repairs; words choose some by their names")
    parser.add_argument("--at", metavar="FILE:LINE", action="append", default=[], help="all faults of a line")
    return parser.parse_args()


def main() -> int:
    """Try faults, list survivors, compare with the floors."""
    options = read_options()
    sys.stdout.reconfigure(line_buffering=True)  # pyright: ignore[reportAttributeAccessIssue]
    if options.repairs:
        return undo_repairs(options.rooms)
    mutants = [mutant for place in options.at for mutant in list_line_mutants(place)]
    mutants = mutants if options.at else draw_mutants(options.seed, options.count, tuple(options.rooms))
    found = list[Trial]()
    with open_trials(options.seconds) as trials:
        for mutant in mutants:
            source = (ROOT / mutant.path).read_text("utf-8")
            line = source.count("\n", 0, mutant.start) + 1
            found.append(trial := trials.try_mutant(mutant, select_tests(mutant.path, line)))
            print("noticed " if trial.was_noticed else "SURVIVED", mutant.describe(source), f"({trial.words})")
    scores, floors = rate(found), json.loads(FLOORS.read_text("utf-8"))
    for room, (noticed, count) in scores.items():
        print(f"{room:<16} {noticed:>3} of {count:<3} {100.0 * noticed / count:5.1f} %")
    if os.environ.get("HALATION_RENEW"):
        FLOORS.write_text(json.dumps(raise_floors(floors, scores), indent=1, sort_keys=True) + "\n", "utf-8")
    below = [room for room, (noticed, count) in scores.items() if 100.0 * noticed / count < floors.get(room, 0.0)]
    if below and not options.at:
        print("below their floors:", *below)
    return int(bool(below) and not options.at)


if __name__ == "__main__":
    sys.exit(main())
