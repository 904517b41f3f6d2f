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
    taken = ", ".join(
        [
            *(f"{glsl} {name}" for glsl, name in entry.parameters),
            *(f"out {glsl} {name}" for glsl, name in entry.outputs),
        ]
    )
    given = ", ".join(name for _, name in (*entry.parameters, *entry.outputs))
    call, made, back = f"{inner}({given});", entry.outputs, ""
    if not made:
        call, made, back = f"{entry.result} halation_made = {call}", ((entry.result, "halation_made"),), "halation_made"
    spoilt = " ".join(f"{name} = {glsl}({_NAN});" for glsl, name in made)
    return (
        f'{text}\n#include "lib/rounds.glsl"\n{entry.result} {outer}({taken}) {{'
        f" int halation_before = {COUNTER}; {COUNTER} = 0; {call}"
        f" if ({COUNTER} > {MOST_ROUNDS}) {{ {spoilt} }} {COUNTER} = halation_before; return {back}; }}\n"
    )
