"""How much memory the editor takes in an hour of work, without a display.

    .venv/bin/python tests/bench/editor_memory.py [--acts 3600] [--presets 10] [--seed 1]

Somebody opens one preset after the other and plays with each for a minute: an act for each second of an hour. After the
last preset comes the first again. It prints, twelve times, the MiB of the process that are no files of libraries, and
how many of them are textures.
"""

from __future__ import annotations

import argparse
import gc
import os
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from gui_driver import CANVAS, Ui, drive
from gui_player import SIZE, Player
from halation import presets
from halation.compiler.lowering import pictures
from halation.renderer.execution.texture_pool import TexturePool
from resident import count_resident

ACTS_OF_A_PRESET, ROWS = 60, 12


def play(ui: Ui, acts: int, count: int, seed: int) -> None:
    """Play with so many presets, and print a row for each part."""
    player, paths = Player(ui, seed), sorted(presets.paths())
    paths = [paths[number * len(paths) // count] for number in range(count)]
    print("| acts | MiB | of textures |\n|---|---|---|")
    for number in range(acts):
        if number % ACTS_OF_A_PRESET == 0:
            ui.session.files.open_copy(paths[number // ACTS_OF_A_PRESET % len(paths)])
            ui.wait(5)
        player.act()
        if (number + 1) % (acts // ROWS) == 0:
            gc.collect()
            textures = sum(pool.allocated for pool in gc.get_objects() if isinstance(pool, TexturePool))
            print(f"| {number + 1} | {count_resident() >> 20} | {textures >> 20} |", flush=True)


def main() -> None:
    """Play for an hour."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--acts", type=int, default=3600)
    parser.add_argument("--presets", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    pictures.DEFAULT_CANVAS = CANVAS
    with tempfile.TemporaryDirectory() as folder:
        os.environ["HALATION_STATE"] = folder
        os.chdir(folder)
        drive(
            lambda ui: play(ui, arguments.acts, arguments.presets, arguments.seed), Path(folder), size=SIZE, faulty=True
        )


if __name__ == "__main__":
    main()
