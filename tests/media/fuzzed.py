"""Reads damaged copies of a file, one after the other: run as a process, so that a crash of a library is noticed.

    python fuzzed.py COUNT FILES...

Copies are cut short, or have bytes flipped, by a generator seeded with their number. Prints file and number before it
reads a copy, and at the end how many were refused; ends with 3 where anything but InputError came out.
"""

from __future__ import annotations

import random
import sys
import traceback
from pathlib import Path

from halation.resources.sandbox import UNRESTRICTED


def damaged(whole: bytes, number: int) -> bytes:
    """A copy: cut, with bytes flipped, most of them near the beginning, or with a part repeated or zeroed."""
    draw = random.Random(number)
    data = bytearray(whole)
    kind = draw.randrange(4)
    if kind == 0:
        del data[draw.randrange(len(data)) :]
    elif kind == 3:
        at, length = draw.randrange(len(data)), draw.randrange(1, 64)
        data[at : at + length] = draw.choice([bytes(length), b"\xff" * length, data[:length]])
    else:
        reach = len(data) if kind == 1 else min(len(data), 400)
        for _ in range(draw.choice([1, 2, 8, 40])):
            data[draw.randrange(reach)] = draw.choice([0, 255, 127, 128, draw.randrange(256)])
    return bytes(data)


def main(count: int, sources: list[Path]) -> int:
    from halation.errors import InputError
    from halation.media import read_info, read_layer, read_metadata
    from halation.nodes import Kind
    from halation.render_layers.analysis import analyze_render

    refused = 0
    for source in sources:
        whole, path = source.read_bytes(), source.with_name(f"damaged{source.suffix}")
        for number in range(count):
            print(source.name, number, flush=True)
            path.write_bytes(damaged(whole, number))
            for act in (
                read_info,
                lambda one, sandbox: read_layer(one, "", Kind.IMAGE, sandbox=sandbox),
                read_metadata,
                analyze_render,
            ):
                try:
                    act(path, sandbox=UNRESTRICTED)
                except InputError as fault:
                    refused += 1
                    if "\n" in str(fault) or str(path) not in str(fault):
                        print(f"not one sentence with the name of the file: {fault}")
                        return 3
                except Exception:
                    traceback.print_exc()
                    return 3
    print(refused)
    return 0


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]), [Path(word) for word in sys.argv[2:]]))
