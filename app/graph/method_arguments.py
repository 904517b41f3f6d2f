"""Arguments of methods, checked against their annotations: a wrong type is a UsageError with one sentence.

Without this, `graph.add("a", 5)` would return a graph that fails much later, far from the mistake.
"""

from __future__ import annotations

import functools
import inspect
import types
import typing
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from ..errors import HalationError, UsageError

C = TypeVar("C", bound=type)


def check_method_arguments(kind: C) -> C:
    """Class decorator: public methods raise UsageError for arguments of another type than they declare."""
    for name, method in inspect.getmembers(kind, inspect.isfunction):
        if not name.startswith("_"):
            is_edit = method.__annotations__.get("return") == "Self"
            setattr(kind, name, (_check_before if is_edit else _explain_after)(kind, method))
    return kind


def _check_before(kind: type, method: Callable[..., Any]) -> Callable[..., Any]:
    """An edit, whose arguments are checked first: a wrong one could become part of the graph."""
    find = functools.cache(lambda: _find_faulty_argument(kind, method))

    @functools.wraps(method)
    def run(*args: Any, **options: Any) -> Any:
        if fault := find()(args, options):
            raise UsageError(fault)
        return method(*args, **options)

    return run


def _explain_after(kind: type, method: Callable[..., Any]) -> Callable[..., Any]:
    """A question, whose arguments are looked at only if it fails: some are asked a million times."""
    find = functools.cache(lambda: _find_faulty_argument(kind, method))

    @functools.wraps(method)
    def run(*args: Any, **options: Any) -> Any:
        try:
            return method(*args, **options)
        except HalationError:
            raise
        except Exception:
            if fault := find()(args, options):
                raise UsageError(fault) from None
            raise

    return run


def _find_faulty_argument(kind: type, method: Callable[..., Any]) -> Callable[[Any, Any], str]:
    """A function of arguments that says which of them has a wrong type; "" if none has."""
    names, hints = tuple(inspect.signature(method).parameters), typing.get_type_hints(method)
    types_by_name = {name: _list_types(hints[name]) for name in names if name in hints}
    key_types = {name: _list_key_types(hints[name]) for name in names if name in hints}

    def find(args: Any, options: Any) -> str:
        # A missing argument, one too many or an unknown keyword is for Python itself to say.
        for name, argument in (*zip(names, args, strict=False), *options.items()):
            accepted = types_by_name.get(name, ())
            if accepted and not isinstance(argument, accepted):
                words = " or ".join("None" if item is type(None) else item.__name__ for item in accepted)
                return f"{kind.__name__}.{method.__name__}: {name} is a {type(argument).__name__}; give a {words}"
            if (keys := key_types.get(name, ())) and (wrong := [key for key in argument if not isinstance(key, keys)]):
                return (
                    f"{kind.__name__}.{method.__name__}: {name} has the key {wrong[0]!a}; "
                    f"give a {' or '.join(item.__name__ for item in keys)}"
                )
        return ""

    return find


def _list_key_types(hint: Any) -> tuple[type, ...]:
    """The classes of the keys that an annotation accepts; none where it is not of a Mapping, or accepts any key."""
    return _list_types(typing.get_args(hint)[0]) if typing.get_origin(hint) is Mapping else ()


def _list_types(hint: Any) -> tuple[type, ...]:
    """The classes that an annotation accepts; none where it accepts anything."""
    if typing.get_origin(hint) in (typing.Union, types.UnionType):
        return tuple(item for part in typing.get_args(hint) for item in _list_types(part))
    origin = typing.get_origin(hint) or hint
    if origin is float:
        return (int, float)
    if origin is object or not isinstance(origin, type):
        return ()
    return (Mapping,) if origin is Mapping else (origin,)
