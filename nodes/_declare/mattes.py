"""Cryptomattes: which names a list picks, and how it changes when one more is to be picked.

Friedman and Jones 2015, by Psyop's specification 1.2.0.
"""

from __future__ import annotations

import io
import struct
from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatchcase

from .render import Matte

EVERYTHING = "*"


def matte_of(mattes: Sequence[Matte], kind: str) -> Matte | None:
    """The cryptomatte of a kind (object, material, asset), or the only one whose kind is not known."""
    plain = [matte for matte in mattes if not matte.kind]
    return next((matte for matte in mattes if matte.kind == kind), plain[0] if len(plain) == 1 else None)


def pick_ids(pick: str, manifest: Mapping[str, int]) -> set[int]:
    """The ids that a list of names stands for, from left to right: a name adds its ids, a minus before it takes them.

    In a name, * is any text, ? any letter, [ab] one of these; what the manifest has as it stands is that name.
    """
    picked_ids: set[int] = set()
    for name in _entries(pick, manifest):
        leaves_out = name.startswith("-") and name not in manifest
        ids = set(_ids(name[1:] if leaves_out else name, manifest))
        picked_ids = picked_ids - ids if leaves_out else picked_ids | ids
    return picked_ids


def toggle_name(pick: str, name: str, manifest: Mapping[str, int]) -> str:
    """The list that picks a name of the manifest as well, or no longer. Everything becomes that name alone."""
    if pick.strip() == EVERYTHING:
        return format_names([name])
    id, is_added = float_bits(manifest[name]), name not in pick_names(pick, manifest)
    minus = f"-{name}"
    entries = [entry for entry in _entries(pick, manifest) if entry not in ({minus} if is_added else {name})]
    if (id in pick_ids(format_names(entries), manifest)) != is_added:
        entries.append(name if is_added else minus)
    return format_names(entries)


def pick_names(pick: str, manifest: Mapping[str, int]) -> frozenset[str]:
    """The names of the manifest that a list picks."""
    ids = pick_ids(pick, manifest)
    return frozenset(name for name, bits in manifest.items() if float_bits(bits) in ids)


def format_names(names: Sequence[str]) -> str:
    """Names as a list, in quotes where they need them."""
    return ", ".join(map(_quote, names))


def _quote(name: str) -> str:
    if name and name == name.strip() and not any(letter in name for letter in ',"\n\r'):
        return name
    import csv

    text = io.StringIO()
    csv.writer(text, quoting=csv.QUOTE_ALL, lineterminator="").writerow([name.replace("\n", "?").replace("\r", "?")])
    return text.getvalue()


def _entries(pick: str, manifest: Mapping[str, int]) -> Iterator[str]:
    """What a list names; blanks around a name do not count unless the manifest has them."""
    import csv

    for name in next(csv.reader([pick.replace("\n", ",")], skipinitialspace=True), list[str]()):
        if name.strip():
            yield name if name in manifest or name.removeprefix("-") in manifest else name.strip()


def _ids(name: str, manifest: Mapping[str, int]) -> Iterator[int]:
    if name not in manifest:
        name = name.strip()
    if name in manifest:
        yield float_bits(manifest[name])
    elif any(letter in name for letter in "*?["):
        yield from (float_bits(bits) for candidate, bits in manifest.items() if fnmatchcase(candidate, name))
    elif name:
        yield float_bits(murmur3(name.encode()))


def murmur3(data: bytes) -> int:
    """MurmurHash3_x86_32 with seed 0 and its constants (Appleby 2011, public domain)."""
    aligned = len(data) // 4 * 4
    digest = 0
    for (word,) in struct.iter_unpack("<I", data[:aligned]):
        digest = (_rotate(digest ^ _scramble(word), 13) * 5 + 0xE6546B64) & 0xFFFFFFFF
    digest ^= _scramble(int.from_bytes(data[aligned:], "little")) ^ len(data)
    digest = ((digest ^ digest >> 16) * 0x85EBCA6B) & 0xFFFFFFFF
    digest = ((digest ^ digest >> 13) * 0xC2B2AE35) & 0xFFFFFFFF
    return digest ^ digest >> 16


def _scramble(word: int) -> int:
    return _rotate(word * 0xCC9E2D51 & 0xFFFFFFFF, 15) * 0x1B873593 & 0xFFFFFFFF


def _rotate(word: int, count: int) -> int:
    return (word << count | word >> 32 - count) & 0xFFFFFFFF


def float_bits(number: int) -> int:
    """A hash as the bits of a float that is a usual number: no zero, denormal, infinity or NaN (Cryptomatte, 1.2)."""
    exponent = number >> 23 & 0xFF
    return number ^ 1 << 23 if exponent in (0, 0xFF) else number
