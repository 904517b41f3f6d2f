"""What a merge could not decide, as it stands in a document: what ours says is in place, the rest under one key.

    "conflicts": [{"at": ["nodes", "bloom", "values", "sigma"], "base": 4.0, "ours": 8.0, "theirs": 2.0}]

A side that has nothing there is left out. The document loads and can be edited; `problems` names every conflict until
it is decided.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal, get_args

from ...errors import UsageError
from ...graph import did_you_mean
from .parts import ABSENT, CONFLICTS, At, Tree, about, is_list, is_tree, path_of, plain

Side = Literal["ours", "theirs", "base"]
SIDES: Final = get_args(Side)


@dataclass(frozen=True)
class Conflict:
    """A part that both sides changed, each in its way; ABSENT where a version has none."""

    at: At
    base: Any
    ours: Any
    theirs: Any

    @property
    def path(self) -> str:
        """What messages call it."""
        return path_of(self.at)

    def entry(self) -> Tree:
        """What the document says of it."""
        found = {side: plain(getattr(self, side)) for side in SIDES}
        return {"at": list(self.at), **{side: part for side, part in found.items() if part is not ABSENT}}


def with_conflicts(parts: Tree, found: Mapping[At, Conflict]) -> Tree:
    """Parts of a document that say what is to be decided, besides what they said already."""
    if not found:
        return parts
    old = plain(parts.get(CONFLICTS, []))
    new = {about(list(at)): conflict.entry() for at, conflict in found.items()}
    kept = [item for item in old if not is_tree(item) or about(item.get("at")) not in new] if is_list(old) else [old]
    return {**parts, CONFLICTS: [*kept, *new.values()]}


def conflicts_of(document: Tree) -> tuple[Conflict, ...]:
    """What a document has to be decided. What is damaged is left out."""
    found = document.get(CONFLICTS)
    return tuple(_read(item) for item in found if _is_entry(item)) if is_list(found) else ()


def resolved(document: Tree, choices: Mapping[str, Side]) -> Tree:
    """A document where a side was chosen for the parts at or below these paths; the empty path is all of them.

    `ours` leaves what is in place. Raises UsageError for a path at which nothing is to be decided.
    """
    open = conflicts_of(document)
    for path in choices:
        if not any(_covers(path, conflict.path) for conflict in open):
            paths = [conflict.path for conflict in open]
            raise UsageError(f"'{path}' has no conflict{did_you_mean(path, paths)}" if path else "it has no conflicts")
    left: list[Tree] = []
    for conflict in open:
        fitting = [path for path in choices if _covers(path, conflict.path)]
        if not fitting:
            left.append(conflict.entry())
        elif (side := choices[max(fitting, key=len)]) != "ours":
            document = _put(document, conflict.at, plain(getattr(conflict, side)))
    rest = {key: part for key, part in document.items() if key != CONFLICTS}
    return rest | ({CONFLICTS: left} if left else {})


def _covers(path: str, other: str) -> bool:
    return not path or other == path or other.startswith(f"{path}.")


def _is_entry(item: Any) -> bool:
    return is_tree(item) and is_list(item.get("at")) and bool(item["at"])


def _read(item: Tree) -> Conflict:
    at: At = tuple(item["at"])
    return Conflict(at, *(item.get(side, ABSENT) for side in ("base", "ours", "theirs")))


def _put(item: Any, at: At, part: Any) -> Any:
    """A document with another part there; a key of an animation is found by its frame."""
    if not at:
        return part
    key, rest = at[0], at[1:]
    if is_list(item) and not isinstance(key, str):
        keys = {one["frame"]: one for one in item if is_tree(one) and "frame" in one}
        keys[key] = _put(keys.get(key, {}), rest, part)
        return [keys[frame] for frame in sorted(keys) if keys[frame] is not ABSENT]
    inside = dict(_items(item))
    made = _put(inside.get(str(key), [] if key == "keys" else {}), rest, part)
    kept = {name: one for name, one in inside.items() if name != key}
    return kept if made is ABSENT else {**kept, key: made}


def _items(item: Any) -> Iterator[tuple[Any, Any]]:
    yield from item.items() if is_tree(item) else ()
