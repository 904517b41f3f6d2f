"""Code of users that no driver has compiled before.

Drivers keep compiled programs on disk, from one run of the tests to the next; a number that is new each time keeps
them from finding these.
"""

from __future__ import annotations

import numpy as np


def write_slow_code() -> str:
    """An array that is read at places known only at run time, which takes minutes to compile."""
    return f"""vec4 slow(vec4 image) {{
    float a[16000];
    a[int(image.r * 1e6)] = {_choose_number()}.0;
    return vec4(a[int(image.g)]);
}}"""


def write_sum(terms: int) -> str:
    """A sum that takes the longer to compile the more terms it has."""
    number = _choose_number()
    total = " + ".join(f"sin(image.r * {term}.{number})" for term in range(terms))
    return f"vec4 f(vec4 image) {{ return vec4({total}); }}"


def write_product(factor: float) -> str:
    """The image times a number."""
    return f"vec4 f(vec4 image) {{ return image * {factor} + {_choose_number()}.0 * 0.0; }}"


def _choose_number() -> int:
    return int(np.random.default_rng().integers(1, 10**6))
