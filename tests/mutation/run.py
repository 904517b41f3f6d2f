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
import subprocess
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1]))

from mutation.choice import select_tests
from mutation.mutants import Mutant, list_mutants
from mutation.repairs import REPAIRS, Repair
from source_trees import ROOT, copy_tree, run_in_tree

FLOORS = Path(__file__).with_name("floors.json")
"""Room -> percent of faults that must be noticed: the least of what was measured on several seeds."""

LIMIT = 600.0
"""Seconds after which a fault counts as noticed: it may loop for ever."""

ENOUGH = 50
"""Faults of a room from which on a better share raises its floor: of fewer, luck decides."""

PATIENCE = 120
"""Seconds after which a test that sees a fault has failed: few need more, and those fail without the fault too."""

_PYTEST = ("-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "--tb=no", f"--timeout={PATIENCE}")


@dataclass(frozen=True)
class Trial:
    """A fault and what the tests said."""

    mutant: Mutant
    room: str
    was_noticed: bool
    words: str


def room_of(path: Path) -> str:
    """The room of a file, as scores are counted: a folder of `app`, the nodes, or the shaders."""
    top, room, *_ = path.parts
    return room.removesuffix(".py") if top == "app" else top


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


def try_mutant(tree: Path, mutant: Mutant, broken: set[str]) -> Trial:
    """Show a fault to its tests, and take it out of the tree again.

    Tests that fail without it too, or that pass with it when they are asked again, are added to those that are
    `broken`, and say nothing: a full machine may fail a test that has nothing to do with the fault.
    """
    while True:
        trial = _try_once(tree, mutant, broken)
        failing = trial.words.removeprefix("FAILED ").partition(" - ")[0]
        if not trial.words.startswith("FAILED ") or failing in broken:
            return trial
        with _put(tree, mutant):
            fails_again = not _passes(tree, failing)
        if fails_again and _passes(tree, failing):
            return trial
        broken.add(failing)


@contextmanager
def _put(tree: Path, mutant: Mutant) -> Iterator[None]:
    path = tree / mutant.path
    source = path.read_text("utf-8")
    path.write_text(mutant.apply(source), "utf-8")
    try:
        yield
    finally:
        path.write_text(source, "utf-8")


def _passes(tree: Path, test: str) -> bool:
    try:
        return run_in_tree(tree, *_PYTEST, test, timeout=LIMIT).returncode == 0
    except subprocess.TimeoutExpired:
        return False


def _try_once(tree: Path, mutant: Mutant, broken: set[str]) -> Trial:
    room = room_of(mutant.path)
    line = (tree / mutant.path).read_text("utf-8").count("\n", 0, mutant.start) + 1
    selections = select_tests(mutant.path, line)
    words = [*_PYTEST, *(f"--deselect={name}" for name in sorted(broken))]
    try:
        for selection in selections:
            with _put(tree, mutant):
                ended = run_in_tree(tree, *words, *selection, timeout=LIMIT)
            if ended.returncode not in (0, 5):  # 5: all tests of the files are slow
                lines = [line for line in ended.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))]
                return Trial(mutant, room, True, " ".join(lines[:1]) or f"exit code {ended.returncode}")
        count = len({word.partition("::")[0] for words in selections for word in words if word.endswith(".py")})
        return Trial(mutant, room, False, f"{count} files of tests pass" if selections else "no test is near the file")
    except subprocess.TimeoutExpired:
        return Trial(mutant, room, True, "no end")


def try_repair(tree: Path, repair: Repair) -> Trial:
    """Undo a repair, show that to its test, and take it out of the tree again."""
    path = tree / repair.file
    source = path.read_text("utf-8")
    mutant = repair.find_mutant(source)
    path.write_text(mutant.apply(source), "utf-8")
    try:
        ended = run_in_tree(tree, *_PYTEST, repair.test, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        return Trial(mutant, "repairs", True, "no end")
    finally:
        path.write_text(source, "utf-8")
    lines = [line for line in ended.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))]
    # A test that is not there, or a tree that cannot be imported, says nothing about the repair.
    return Trial(mutant, "repairs", ended.returncode == 1, " ".join(lines[:1]) or f"exit code {ended.returncode}")


def undo_repairs(names: Iterable[str]) -> int:
    """Undo all repairs, or those whose name holds one of these words; 1 if a test does not notice one."""
    chosen = [repair for repair in REPAIRS if not names or any(word in repair.name for word in names)]
    survivors = 0
    with tempfile.TemporaryDirectory() as folder:
        tree = copy_tree(Path(folder) / "tree")
        for repair in chosen:
            trial = try_repair(tree, repair)
            line = (ROOT / repair.file).read_text("utf-8").count("\n", 0, trial.mutant.start) + 1
            survivors += not trial.was_noticed
            print(
                "noticed " if trial.was_noticed else "SURVIVED", f"{repair.name}: {repair.file}:{line} ({trial.words})"
            )
    print(f"{len(chosen) - survivors} of {len(chosen)} repairs have a test that fails without them")
    return int(survivors > 0)


def rate(trials: Iterable[Trial]) -> dict[str, tuple[int, int]]:
    """Faults that were noticed, and all faults, by room."""
    scores = defaultdict[str, list[int]](lambda: [0, 0])
    for trial in trials:
        scores[trial.room][0] += trial.was_noticed
        scores[trial.room][1] += 1
    return {room: (noticed, count) for room, (noticed, count) in sorted(scores.items())}


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
    trials, broken = list[Trial](), set[str]()
    with tempfile.TemporaryDirectory() as folder:
        tree = copy_tree(Path(folder) / "tree")
        for mutant in mutants:
            trials.append(trial := try_mutant(tree, mutant, broken))
            text = mutant.describe((ROOT / mutant.path).read_text("utf-8"))
            print("noticed " if trial.was_noticed else "SURVIVED", text, f"({trial.words})")
    scores, floors = rate(trials), json.loads(FLOORS.read_text("utf-8"))
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
