"""Spells names, texts and numbers in the code that game engines read."""

from __future__ import annotations

import re

import numpy as np


def write_name(name: str, prefix: str) -> str:
    """A name in the code of an engine: letters of ASCII, digits and underscores."""
    return f"{prefix}_{re.sub(r'[^A-Za-z0-9]+', '_', name)}"


def quote_text(text: str) -> str:
    """A text in quotation marks, on one line, without marks that would end it."""
    line = " ".join("".join(letter if letter.isprintable() else " " for letter in text).split())
    return f'"{line.replace(chr(92), "/").replace(chr(34), chr(39))}"'


def write_float(number: float) -> str:
    """A number as code spells it, with the fewest digits that mean the same in 32 bits, never as a whole number."""
    return str(np.float32(number))
