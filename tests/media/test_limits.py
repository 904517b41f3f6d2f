"""How large a picture may be, and how much memory it may take: the arithmetic of what is refused."""

from __future__ import annotations

import pytest
from halation.errors import InputError
from halation.media import limits
from halation.resources.picture import MAX_SIDE


@pytest.mark.parametrize(("width", "height", "channels"), [(7, 5, 1), (64, 3, 4), (2, 2, 40)])
def test_memory_holds_the_file_and_three_copies_of_four_channels(
    monkeypatch: pytest.MonkeyPatch, width: int, height: int, channels: int
) -> None:
    """As stored, as light and as RGBA, in floats of four bytes, besides what was read."""
    needed = width * height * 4 * (channels + 3 * 4)
    monkeypatch.setattr(limits, "machine_memory", lambda: needed)
    limits.check_memory("a.exr", (width, height), channels)
    monkeypatch.setattr(limits, "machine_memory", lambda: needed - 1)
    with pytest.raises(InputError, match=f"a.exr: {width}x{height} pixels of {channels} channels take 0 GiB"):
        limits.check_memory("a.exr", (width, height), channels)


def test_what_is_said_is_in_gibibytes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "machine_memory", lambda: 3 << 30)
    with pytest.raises(InputError, match="take 4 GiB, and this machine has 3:"):
        limits.check_memory("a.exr", (1 << 13, 1 << 13), 4)


@pytest.mark.parametrize(
    ("setting", "most"), [("", 1 << 28), ("35", 35), ("many", 1 << 28), ("-1", 1 << 28), ("\u0663\u0665", 1 << 28)]
)
def test_a_picture_has_as_many_pixels_as_are_allowed(monkeypatch: pytest.MonkeyPatch, setting: str, most: int) -> None:
    monkeypatch.setenv(limits.LIMIT, setting)
    width = 7 if most == 35 else 1 << 14
    limits.check_size("a.exr", (width, most // width))
    for size in ((width, most // width + 1), (0, 4), (4, 0), (-3, 4), (4, -3)):
        with pytest.raises(InputError, match=f"claims to be {size[0]}x{size[1]} pixels, more .*{most:,} in all"):
            limits.check_size("a.exr", size)


def test_sides_are_as_long_as_textures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(limits.LIMIT, str(4 * MAX_SIDE))
    for size in ((MAX_SIDE, 3), (3, MAX_SIDE)):
        limits.check_size("a.exr", size)
    for size in ((MAX_SIDE + 1, 3), (3, MAX_SIDE + 1)):
        with pytest.raises(InputError, match="more than can be read"):
            limits.check_size("a.exr", size)
