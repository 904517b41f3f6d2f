"""What becomes of a function whose loops might not end."""

from __future__ import annotations

import re

from ..glsl import GlslFunction
from ..glsl.loops import COUNTER, MOST_ROUNDS

_NAN = "uintBitsToFloat(0x7fc00000u)"


def add_ending(text: str, entry: GlslFunction, prefix: str) -> str:
    """`text`, whose loops are counted, with a function around the one that is the node.

    It counts for every pixel anew. A pixel whose loops had to be left is NaN: a wrong number would be taken for a
    right one.
    """
    outer, inner = f"{prefix}{entry.name}", f"{prefix[:-1]}x_{entry.name}"
    text = re.sub(rf"\b{outer}\b", inner, text)
    parameters = ", ".join(
        [
            *(f"{glsl} {name}" for glsl, name in entry.parameters),
            *(f"out {glsl} {name}" for glsl, name in entry.outputs),
        ]
    )
    arguments = ", ".join(name for _, name in (*entry.parameters, *entry.outputs))
    call, results, returned = f"{inner}({arguments});", entry.outputs, ""
    if not results:
        returned = "halation_made"
        call, results = f"{entry.result} {returned} = {call}", ((entry.result, returned),)
    fill_with_nan = " ".join(f"{name} = {glsl}({_NAN});" for glsl, name in results)
    return (
        f'{text}\n#include "lib/rounds.glsl"\n{entry.result} {outer}({parameters}) {{'
        f" int halation_before = {COUNTER}; {COUNTER} = 0; {call}"
        f" if ({COUNTER} > {MOST_ROUNDS}) {{ {fill_with_nan} }} {COUNTER} = halation_before; return {returned}; }}\n"
    )
