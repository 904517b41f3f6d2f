"""Conflicts of a merge, as they stand in a document: our version is in place, all three are under one key.

    "conflicts": [{"at": ["nodes", "bloom", "values", "sigma"], "base": 4.0, "ours": 8.0, "theirs": 2.0}]

A side that has no such part is left out. The document loads and can be edited; `problems` names every conflict until
it is resolved.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final, Literal, get_args

from msgspec import Struct

from ...errors import UsageError
from ...graph import did_you_mean
from .parts import ABSENT, CONFLICTS, PartPath, Tree, conflict_key, is_list, is_tree, path_text, to_document

Side = Literal["ours", "theirs", "base"]
SIDES: Final = get_args(Side)


class Conflict(Struct, frozen=True):
    """A part that both sides changed differently; ABSENT where a version has none."""

    at: PartPath
    base: Any
    ours: Any
    theirs: Any

    @property
    def path(self) -> str:
        """The path of the part, as messages write it."""
        return path_text(self.at)

    def entry(self) -> Tree:
        """The conflict as the document holds it."""
        sides = {side: to_document(getattr(self, side)) for side in SIDES}
        return {"at": list(self.at), **{side: part for side, part in sides.items() if part is not ABSENT}}


def add_conflicts(parts: Tree, conflicts: Mapping[PartPath, Conflict]) -> Tree:
    """Parts of a document with these conflicts, besides those that it has already."""
    if not conflicts:
        return parts
    old_entries = to_document(parts.get(CONFLICTS, []))
    new_entries = {conflict_key(list(at)): conflict.entry() for at, conflict in conflicts.items()}
    other_entries = (
        [item for item in old_entries if not is_tree(item) or conflict_key(item.get("at")) not in new_entries]
        if is_list(old_entries)
        else [old_entries]
    )
    return {**parts, CONFLICTS: [*other_entries, *new_entries.values()]}


def read_conflicts(document: Tree) -> tuple[Conflict, ...]:
    """The conflicts of a document. A damaged entry is left out."""
    entries = document.get(CONFLICTS)
    return tuple(_read(item) for item in entries if _is_entry(item)) if is_list(entries) else ()


def resolve_conflicts(document: Tree, choices: Mapping[str, Side]) -> Tree:
    """A document with the chosen side in place of the parts at or below these paths; the empty path is all of them.

    `ours` leaves the part as it is. Raises UsageError for a path without a conflict.
    """
    conflicts = read_conflicts(document)
    for path in choices:
        if not any(_covers(path, conflict.path) for conflict in conflicts):
            paths = [conflict.path for conflict in conflicts]
            raise UsageError(f"'{path}' has no conflict{did_you_mean(path, paths)}" if path else "it has no conflicts")
    unresolved: list[Tree] = []
    for conflict in conflicts:
        covering = [path for path in choices if _covers(path, conflict.path)]
        if not covering:
            unresolved.append(conflict.entry())
        elif (side := choices[max(covering, key=len)]) != "ours":
            document = _set_in_document(document, conflict.at, to_document(getattr(conflict, side)))
    rest = {key: part for key, part in document.items() if key != CONFLICTS}
    return rest | ({CONFLICTS: unresolved} if unresolved else {})


def _covers(path: str, inner: str) -> bool:
    return not path or inner == path or inner.startswith(f"{path}.")


def _is_entry(item: Any) -> bool:
    return is_tree(item) and is_list(item.get("at")) and bool(item["at"])


def _read(item: Tree) -> Conflict:
    at: PartPath = tuple(item["at"])
    return Conflict(at, *(item.get(side, ABSENT) for side in ("base", "ours", "theirs")))


def _set_in_document(item: Any, at: PartPath, part: Any) -> Any:
    """A document with the part at a path replaced; a key of an animation is found by its frame."""
    if not at:
        return part
    key, rest = at[0], at[1:]
    if is_list(item) and not isinstance(key, str):
        keys = {key_entry["frame"]: key_entry for key_entry in item if is_tree(key_entry) and "frame" in key_entry}
        keys[key] = _set_in_document(keys.get(key, {}), rest, part)
        return [keys[frame] for frame in sorted(keys) if keys[frame] is not ABSENT]
    inside = dict(_items(item))
    changed = _set_in_document(inside.get(str(key), [] if key == "keys" else {}), rest, part)
    unchanged = {name: entry for name, entry in inside.items() if name != key}
    return unchanged if changed is ABSENT else {**unchanged, key: changed}


def _items(item: Any) -> Iterator[tuple[Any, Any]]:
    yield from item.items() if is_tree(item) else ()
