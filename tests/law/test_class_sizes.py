"""No class of the editor becomes the place for everything: what a class offers, inherited members included, is bounded.

The limits are a little above the largest class of today. A class that meets one does two jobs: give the second one to
a part of its own, as `Session` does with `files`, `time` and `views`.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).parents[2]

ROOMS = ("app/editor", "app/authoring")
SESSION_PARTS = ("DocumentFiles", "CodeFiles", "DocumentTime", "ViewedPorts", "History")
"""What the attributes of the session are."""


class ClassSize(NamedTuple):
    """How much a class offers and holds, with all that it inherits from other classes of the project."""

    public_names: int
    methods: int
    statements: int

    def exceeds(self, limit: ClassSize) -> bool:
        """True if one of the numbers is above its limit."""
        return any(number > most for number, most in zip(self, limit, strict=True))


LIMIT = ClassSize(public_names=30, methods=40, statements=300)
"""For each class of the editor and of what editing is without a window."""
SESSION_LIMIT = ClassSize(public_names=30, methods=40, statements=220)
"""For the session: all changes of the document go through one of its methods, `apply`."""
PART_LIMIT = ClassSize(public_names=14, methods=20, statements=110)
"""For each part of the session."""


def parse_classes(texts: Iterable[str]) -> dict[str, ast.ClassDef]:
    """Every class by its name; `test_names.py` proves that names are unique."""
    return {item.name: item for text in texts for item in ast.walk(ast.parse(text)) if isinstance(item, ast.ClassDef)}


def list_bases(cls: ast.ClassDef, classes: Mapping[str, ast.ClassDef]) -> Iterator[ast.ClassDef]:
    """The class and all classes of the project that it derives from."""
    yield cls
    for base in cls.bases:
        name = base.value if isinstance(base, ast.Subscript) else base
        if isinstance(name, ast.Name) and name.id in classes:
            yield from list_bases(classes[name.id], classes)


def measure(cls: ast.ClassDef, classes: Mapping[str, ast.ClassDef]) -> ClassSize:
    """The size of a class, inherited members included."""
    family = {item.name: item for item in list_bases(cls, classes)}.values()
    methods = {item.name for cls in family for item in cls.body if isinstance(item, ast.FunctionDef)}
    statements = sum(map(count_statements, family))
    return ClassSize(sum(not name.startswith("_") for name in methods), len(methods), statements)


@cache
def count_statements(cls: ast.ClassDef) -> int:
    """The statements in the body of a class, those in its methods included."""
    return sum(isinstance(node, ast.stmt) for item in cls.body for node in ast.walk(item))


Rooms = dict[str, dict[str, ast.ClassDef]]


@pytest.fixture(scope="module")
def rooms() -> Rooms:
    """The classes of each room, and of the rest of the package."""
    places: dict[str, list[str]] = {room: [] for room in (*ROOMS, "")}
    for path in sorted((ROOT / "app").rglob("*.py")):
        room = "/".join(path.relative_to(ROOT).parts[:2])
        places[room if room in ROOMS else ""].append(path.read_text("utf-8"))
    return {room: parse_classes(texts) for room, texts in places.items()}


@pytest.fixture(scope="module")
def classes(rooms: Rooms) -> dict[str, ast.ClassDef]:
    """All classes of the package."""
    return {name: cls for inside in rooms.values() for name, cls in inside.items()}


@pytest.mark.parametrize("room", ROOMS)
def test_no_class_grows_past_the_limit(room: str, rooms: Rooms, classes: dict[str, ast.ClassDef]) -> None:
    inside = rooms[room]
    assert len(inside) > 50
    sizes = {name: measure(cls, classes) for name, cls in inside.items()}
    assert not {name: size for name, size in sizes.items() if size.exceeds(LIMIT)}, f"the limit is {LIMIT}"


@pytest.mark.parametrize("name", ["Session", *SESSION_PARTS])
def test_the_session_and_its_parts_stay_small(name: str, classes: dict[str, ast.ClassDef]) -> None:
    size, limit = measure(classes[name], classes), SESSION_LIMIT if name == "Session" else PART_LIMIT
    assert not size.exceeds(limit), f"{size}, the limit is {limit}"


def test_the_session_has_no_other_parts(classes: dict[str, ast.ClassDef]) -> None:
    """Each public attribute that is made of a class of the project is one of the parts that are measured here."""
    created = {
        item.value.func.id
        for cls in list_bases(classes["Session"], classes)
        for item in ast.walk(cls)
        if isinstance(item, ast.Assign)
        and isinstance(item.targets[0], ast.Attribute)
        and not item.targets[0].attr.startswith("_")
        and isinstance(item.value, ast.Call)
        and isinstance(item.value.func, ast.Name)
        and item.value.func.id in classes
    }
    assert created == set(SESSION_PARTS)


def test_nothing_is_mixed_in(rooms: Rooms, classes: dict[str, ast.ClassDef]) -> None:
    """A class of the editor derives from at most one class of the project that has methods: no mixins."""
    inside = {name: cls for room in ROOMS for name, cls in rooms[room].items()}
    several = {
        name: [base.id for base in cls.bases if isinstance(base, ast.Name) and base.id in classes]
        for name, cls in inside.items()
    }
    assert not {name: bases for name, bases in several.items() if len(bases) > 1}


def test_inherited_members_count() -> None:
    text = """
class Ground:
    name: str
    def __init__(self): self.size = 1
    def open(self): pass

class Upper(Ground):
    def close(self): pass
    def _hide(self): pass
"""
    small = parse_classes([text])
    assert measure(small["Ground"], small) == ClassSize(1, 2, 5)
    assert measure(small["Upper"], small) == ClassSize(2, 4, 9)
