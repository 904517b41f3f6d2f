"""Which results stay when there is no room for all, decided without a device."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from halation.compiler import Surface
from halation.renderer.execution.texture_pool import MIN_TEXTURE_BYTES, TextureLease, TexturePool
from hypothesis import given
from hypothesis import strategies as st

SIDE = 128
LARGE = SIDE * SIDE * 16
"""Bytes of a picture of four floats."""


class EndlessDevice:
    """A device with endless room that counts what lives on it."""

    def __init__(self) -> None:
        self.live = 0

    def create_texture(self, size: tuple[int, int], components: int, depth: str) -> SimpleNamespace:
        self.live += 1
        return SimpleNamespace(size=size, release=self._gone)

    def _gone(self) -> None:
        self.live -= 1


def pool(results: float) -> TexturePool:
    """Room for so many large results that nobody leases."""
    return TexturePool(EndlessDevice(), int(results * LARGE))  # type: ignore[arg-type]


def use(textures: TexturePool, key: str, cost: float, side: int = SIDE) -> bool:
    """Read a result, after making it at this cost where it is gone; True if it was there."""
    lease, there = TextureLease(textures), key in textures
    if there:
        lease.add(key)
    else:
        lease.create(Surface(key, key, (side, side), 4, "f4", 0, 0, 1)).cost = cost
    lease.close()
    return there


def kept(textures: TexturePool, keys: str) -> str:
    return "".join(key for key in keys if key in textures)


def test_of_equal_costs_the_least_recently_used_goes():
    textures = pool(3)
    for key in "abc":
        use(textures, key, 1.0)
    use(textures, "a", 1.0)
    use(textures, "d", 1.0)
    assert kept(textures, "abcd") == "acd"


@given(st.lists(st.sampled_from("abcdefg"), max_size=60), st.integers(1, 5))
def test_of_equal_costs_it_is_the_plain_rule(uses: list[str], room: int):
    """A list in order of use is the reference."""
    textures, recent = pool(room), list[str]()
    for key in uses:
        use(textures, key, 0.25)
        recent = [*(other for other in recent if other != key), key][-room:]
        assert {other for other in "abcdefg" if other in textures} == set(recent)


def test_what_is_cheap_to_make_goes_before_what_is_older():
    textures = pool(3)
    for key, cost in (("a", 5.0), ("b", 0.1), ("c", 0.1), ("d", 0.1)):
        use(textures, key, cost)
    assert kept(textures, "abcd") == "acd"


def test_costs_count_by_the_byte():
    """A quarter of the bytes at a half of the cost: a byte of it costs twice as much."""
    textures = pool(1.25)
    use(textures, "a", 1.0, SIDE // 2)
    use(textures, "b", 2.0)
    use(textures, "c", 2.0)
    assert kept(textures, "abc") == "ac"


def test_even_the_dearest_goes_when_nobody_wants_it_any_more():
    textures = pool(2)
    use(textures, "a", 5.0)
    for number in range(20):
        use(textures, f"{number}", 0.1)
    assert "a" in textures
    for number in range(20, 120):
        use(textures, f"{number}", 0.1)
    assert "a" not in textures and "119" in textures


def test_small_results_do_not_stay_for_ever():
    """One value, such as a measured luminance, is expensive by the byte; there is one for every frame."""
    textures = pool(2)
    for number in range(4000):
        use(textures, f"small{number}", 0.01, 1)
        use(textures, f"large{number}", 0.01)
    assert sum(f"small{number}" in textures for number in range(4000)) < 100


def test_tiny_results_are_counted_by_what_the_driver_takes():
    """A pixel has 16 bytes, of which millions would fit: the number of objects on the device stays bounded as well."""
    textures = pool(8)
    for number in range(5000):
        use(textures, f"{number}", 0.01, 1)
        textures.next_round()
    allowed = 8 * LARGE // MIN_TEXTURE_BYTES
    assert allowed <= textures._device.live <= allowed + 2  # type: ignore[attr-defined]
    assert "4999" in textures and "0" not in textures


def test_what_somebody_leases_stays_whatever_it_costs():
    textures = pool(1)
    lease = TextureLease(textures)
    lease.create(Surface("a", "a", (SIDE, SIDE), 4, "f4", 0, 0, 1)).cost = 0.0
    for key in "bcd":
        use(textures, key, 1.0)
    assert kept(textures, "abcd") == "ad"
    lease.close()
    assert kept(textures, "abcd") == "d"


def test_it_saves_work_where_costs_differ():
    """Dear and cheap results, wanted at random: less is spent than if the oldest went."""
    rng = np.random.default_rng(7)
    costs = {f"{number}": 1.0 if number % 4 == 0 else 0.05 for number in range(16)}
    uses = [f"{number}" for number in rng.integers(0, 16, 3000)]

    def spent(told: dict[str, float]) -> float:
        textures = pool(6)
        return sum(costs[key] for key in uses if not use(textures, key, told[key]))

    assert spent(costs) < 0.6 * spent(dict.fromkeys(costs, 1.0))


@pytest.mark.parametrize("budget", [0, 1])
def test_textures_are_given_back_when_nobody_wants_them(budget: int):
    textures = pool(budget)
    for number in range(20):
        use(textures, f"{number}", 1.0)
        textures.next_round()
    assert textures._device.live <= budget + 2  # type: ignore[attr-defined]
    textures.clear()
    assert textures._device.live == 0 and textures.allocated == 0  # type: ignore[attr-defined]
