"""Starts `halation render` many times and kills it at a random moment, looking at every file in between.

    python killed.py COUNT WORDS...

The moment is counted in changes of the folder, not in seconds: it then falls among the writes however slow the machine
is. Prints how many were killed before they had ended, and how many times there was a file to look at. Modules are
loaded once: every render is a fork of this process, which touches neither OpenGL nor a picture. It must have no thread
when it forks: a child has none of them, and would wait for their locks for ever.
"""

from __future__ import annotations

import json
import os
import random
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path


def main(count: int, words: list[str]) -> None:
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    import numpy  # noqa: F401
    import OpenImageIO as oiio
    from halation import document, media  # noqa: F401
    from halation.cli.program import run
    from halation.renderer.jobs import job  # noqa: F401

    folder = Path(words[words.index("-o") + 1]).parent

    def start(work: Callable[[], int]) -> int:
        assert sys.platform != "linux" or len([*Path("/proc/self/task").iterdir()]) == 1, "a fork would lose a thread"
        child = os.fork()
        if child == 0:
            try:
                os._exit(work())
            finally:
                os._exit(1)
        return child

    def render() -> int:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        return run(["render", *words])

    def look(files: list[Path]) -> int:
        for file in files:
            picture = oiio.ImageInput.open(str(file))
            if not picture or picture.read_image() is None:
                print(f"{file}: {oiio.geterror()}", file=sys.stderr, flush=True)
                return 1
            picture.close()
        return 0

    def ended(child: int, changes: int) -> bool:
        """Whether the child came to its end before the folder's listing had changed so many times."""
        listing = set(folder.iterdir())
        while changes:
            if os.waitpid(child, os.WNOHANG)[0]:
                return True
            if (now := set(folder.iterdir())) != listing:
                listing, changes = now, changes - 1
            time.sleep(0.0005)
        return False

    draw, killed, seen = random.Random(7), 0, 0
    for _ in range(count):
        child = start(render)
        if not ended(child, draw.randint(1, 12)):
            time.sleep(draw.uniform(0.0, 0.004))
            os.kill(child, signal.SIGKILL)
            killed += os.WIFSIGNALED(os.waitpid(child, 0)[1])
        files = sorted(folder.glob("out.*.exr"))
        assert os.waitpid(start(lambda: look(files)), 0)[1] == 0, "a file is not whole: see above"  # noqa: B023
        seen += bool(files)
        for file in files[draw.randrange(len(files) + 1) :]:  # so that there is something to do again
            file.unlink()
    print(json.dumps([killed, seen]))


main(int(sys.argv[1]), sys.argv[2:])
