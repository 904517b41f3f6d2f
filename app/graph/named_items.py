"""Named items of a value: their paths, checks and conversions.

A field of an item is addressed like a value, by a socket with dots: `lights.lamp_3.intensity` of the node `relight`.
`kind` is a field that every item has. Where it is clear, the value may be left out, as in `relight.lamp_3.intensity`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from typing import Any, cast

from halation.nodes import ItemKind, Items, ItemSet, NamedItem, Plain, Scalar, Value
from msgspec import structs

from ..errors import GraphError
from .names import did_you_mean, make_printable, name_fault, name_several
from .scalars import coerce_scalar, describe_scalar, describe_type, scalar_fault
from .spline_points import put_points

KIND = "kind"
"""The field that says what kind an item is of."""


def split_path(socket: str) -> tuple[str, str, str]:
    """The value, the item and the field that a socket names; the last two are empty for a value as a whole."""
    value, _, rest = socket.partition(".")
    item, _, field = rest.partition(".")
    return value, item, field


def join_path(value: str, item: str, field: str) -> str:
    """The socket that stands for a field of an item."""
    return f"{value}.{item}.{field}"


def expand_path(socket: str, values: Mapping[str, Value]) -> str:
    """The full path of a field whose value is left out: `lights.lamp_3.intensity` for `lamp_3.intensity`."""
    head, dot, rest = socket.partition(".")
    _, inner, number = rest.partition(".")
    if not dot or (inner and not number.isdecimal()) or head in values:
        return socket
    holders = [name for name, value in values.items() if isinstance(value.default, ItemSet) and head in value.default]
    if not holders:
        holders = [name for name, value in values.items() if value.items]
    return f"{holders[0]}.{socket}" if len(holders) == 1 else socket


def find_field(value: Value, item_name: str, field: str) -> Value | None:
    """The declaration of a field of an item, with its setting as default; None if there is none.

    `value` is the value that holds the items, with its setting as default.
    """
    declaration = find_field_declaration(value, item_name, field)
    if declaration is None or not isinstance(value.default, ItemSet):
        return None
    item = value.default[item_name]
    setting = item.kind if field == KIND else item.fields.get(field, declaration.default)
    return structs.replace(declaration, default=setting)


def find_field_declaration(value: Value, item_name: str, field: str) -> Value | None:
    """The declaration of a field of an item, with its default; None if there is none. See `find_field`."""
    if value.items is None or not isinstance(value.default, ItemSet) or item_name not in value.default:
        return None
    if field == KIND:
        return _declare_kind(value.items, value.items.kinds[0].name)
    kind = value.items.by_name.get(value.default[item_name].kind)
    declaration = kind and kind.fields.get(field)
    if declaration is not None and declaration.names_item:
        others = (name for name in value.default if name != item_name)
        return structs.replace(declaration, type="choice", choices=("", *others))
    return declaration


def _declare_kind(items: Items, kind: str) -> Value:
    names = tuple(choice.name for choice in items.kinds)
    return Value(KIND, "choice", kind, choices=names, doc=f"What the {items.noun} is like.")


def explain_missing_field(value: Value, path: str, item_name: str, field: str) -> str:
    """Why `find_field` finds nothing: a sentence that names what there is. `path` is that of the value."""
    assert value.items is not None
    noun, items = value.items.noun, value.default
    if not isinstance(items, ItemSet) or item_name not in items:
        names = tuple(items) if isinstance(items, ItemSet) else ()
        return f"'{path}' has no {noun} '{make_printable(item_name)}'{did_you_mean(item_name, names)}"
    kind = value.items.by_name[items[item_name].kind]
    if not field:
        return f"'{path}.{item_name}' is a {noun}: name one of its fields, such as '{path}.{item_name}.{_first(kind)}'"
    hint = did_you_mean(field, (KIND, *kind.fields))
    return f"{noun} '{path}.{item_name}', a {kind.name}, has no field '{make_printable(field)}'{hint}"


def _first(kind: ItemKind) -> str:
    return next(iter(kind.fields), KIND)


def group_settings(
    settings: Iterable[tuple[str, str, Plain]],
) -> dict[tuple[str, str], dict[tuple[str, str], Plain]]:
    """Settings of a node and a socket as those of each value: by item and field, which are empty for a whole value."""
    groups: dict[tuple[str, str], dict[tuple[str, str], Plain]] = {}
    for node, socket, plain in settings:
        name, item, field = split_path(socket)
        groups.setdefault((node, name), {})[item, field] = plain
    return groups


def join_settings(settings: Mapping[tuple[str, str], Plain], find: Callable[[], Value]) -> Plain:
    """The setting of a value, from one for it as a whole or for fields of its items; `find` gives its declaration."""
    if len(settings) == 1 and ("", "") in settings:
        return settings["", ""]
    value = find()
    whole = settings.get(("", ""), value.default)
    if isinstance(whole, ItemSet) and value.items:
        return _put_fields(whole, value.items, settings)
    points = {int(number): plain for (number, _), plain in settings.items() if number.isdecimal()}
    return put_points(whole, points) if value.type == "spline" and isinstance(whole, tuple) else whole


def _put_fields(items: ItemSet, declared: Items, fields: Mapping[tuple[str, str], Plain]) -> ItemSet:
    """The items with fields set, by item and field, without checks; those that do not exist change nothing.

    Points of a spline are set after the spline as a whole.
    """
    changed: dict[str, NamedItem] = {}
    for (name, path), plain in sorted(fields.items(), key=lambda entry: "." in entry[0][1]):
        item, (field, _, number) = changed.get(name) or items.get(name), path.partition(".")
        if item is None or isinstance(plain, ItemSet):
            continue
        if field == KIND:
            changed[name] = change_kind(declared, item, str(plain))
        elif declaration := declared.by_name[item.kind].fields.get(field):
            if number and isinstance(points := item.fields.get(field, declaration.default), tuple):
                plain = put_points(points, {int(number): plain})
            changed[name] = item.with_field(field, None if plain == declaration.default else plain)
    return items.replace(changed)


def change_kind(items: Items, item: NamedItem, kind: str) -> NamedItem:
    """The item as another kind: fields that both kinds have stay, except a default, which becomes the new one."""
    if kind not in items.by_name:
        return item
    known = items.by_name[kind]
    fields = {name: part for name, part in item.fields.items() if name in known.fields and part != known.defaults[name]}
    return NamedItem.of(kind, fields)


# --- checks --------------------------------------------------------------------------------------------------------


def coerce_items(value: Value, setting: object) -> ItemSet | None:
    """A mapping of names to objects as named items, with fields at their default left out; None if it does not fit."""
    if isinstance(setting, ItemSet):
        return setting
    objects = _list_objects(value, setting)
    if objects is None or any(True for _ in _find_object_faults(value, objects)):
        return None
    return ItemSet({name: _read_item(value, fields) for name, fields in objects.items()})


def _list_objects(value: Value, setting: object) -> Mapping[str, Any] | None:
    """Objects by name, also of what an older version saved; None for anything else."""
    assert value.items is not None
    if not isinstance(setting, Mapping):
        return value.items.convert(setting) if value.items.convert else None
    return cast("Mapping[str, Any]", setting)


def _read_item(value: Value, fields: Mapping[str, Any]) -> NamedItem:
    assert value.items is not None
    kind = value.items.by_name[fields.get(KIND, value.items.kinds[0].name)]
    plains: dict[str, Scalar] = {}
    for name, setting in fields.items():
        if name != KIND:
            plain = coerce_scalar(kind.fields[name], setting)
            if plain is not None and plain != kind.fields[name].default:
                plains[name] = plain
    return NamedItem.of(kind.name, plains)


def _find_object_faults(value: Value, objects: Mapping[str, Any]) -> Iterator[tuple[tuple[str, ...], str]]:
    """The faults of types and names in objects by name: the path inside of the value, and a sentence."""
    assert value.items is not None
    noun = value.items.noun
    for name, fields in objects.items():
        if fault := name_fault(name, noun):
            yield (), fault
        elif not isinstance(fields, Mapping):
            yield (name,), f'a {noun} is an object of fields, such as {{"{KIND}": "{value.items.kinds[0].name}"}}'
        else:
            yield from _find_field_faults(value.items, name, cast("Mapping[str, Any]", fields))


def _find_field_faults(items: Items, name: str, fields: Mapping[str, Any]) -> Iterator[tuple[tuple[str, ...], str]]:
    kind_name = fields.get(KIND, items.kinds[0].name)
    if not isinstance(kind_name, str) or kind_name not in items.by_name:
        yield (name, KIND), _explain_kind(items, kind_name)
        return
    kind = items.by_name[kind_name]
    for field, setting in fields.items():
        if field == KIND:
            continue
        if field not in kind.fields:
            yield (
                (name, field),
                f"a {kind_name} has no field '{make_printable(field)}'{did_you_mean(field, kind.fields)}",
            )
        elif coerce_scalar(kind.fields[field], setting) is None:
            yield (name, field), f"expected {describe_type(kind.fields[field])}, got {setting!r}"


def items_fault(value: Value, setting: object) -> str | None:
    """Why named items are invalid, or None: the item and the field, and a sentence."""
    for path, sentence in find_item_faults(value, setting):
        return f"{'.'.join(path)}: {sentence}" if path else sentence
    return None


def find_item_faults(value: Value, setting: object) -> Iterator[tuple[tuple[str, ...], str]]:
    """The faults of named items: the item and the field, and a sentence for each."""
    assert value.items is not None
    items = coerce_items(value, setting)
    if items is None:
        objects = _list_objects(value, setting)
        if objects is None:
            yield (), f"{setting!r} does not fit: it takes {describe_type(value)}"
        else:
            yield from _find_object_faults(value, objects)
        return
    if len(items) > value.items.most:
        yield (), f"{len(items)} {name_several(value.items.noun)} are too many: it takes at most {value.items.most}"
        return  # what they name would take time with the square of their number
    for name, item in items.items():
        kind = value.items.by_name.get(item.kind)
        if fault := name_fault(name, value.items.noun):
            yield (), fault
        elif kind is None:
            yield (name, KIND), _explain_kind(value.items, item.kind)
        else:
            yield from _find_setting_faults(kind, name, item)
            yield from _find_name_faults(value.items, kind, items, name)


def _find_setting_faults(kind: ItemKind, name: str, item: NamedItem) -> Iterator[tuple[tuple[str, ...], str]]:
    for field, plain in item.settings:
        if field not in kind.fields:
            yield (name, field), _explain_field(kind, field)
        elif fault := scalar_fault(kind.fields[field], plain):
            yield (name, field), fault


def _find_name_faults(
    declared: Items, kind: ItemKind, items: ItemSet, name: str
) -> Iterator[tuple[tuple[str, ...], str]]:
    """The fields of an item that name another one: there must be one, and it must not lead back."""
    for field in kind.fields:
        if not kind.fields[field].names_item:
            continue
        chain, other = dict.fromkeys([name]), str(items[name].fields.get(field, ""))  # in order, and found at once
        if other and other not in items:
            yield (name, field), f"there is no {declared.noun} '{make_printable(other)}'{did_you_mean(other, items)}"
        while other in items and other not in chain:
            chain[other] = None
            other = str(items[other].fields.get(field, ""))
        if other == name:
            yield (name, field), f"it leads back to itself: {' -> '.join((*chain, name))}"


def _explain_kind(items: Items, name: object) -> str:
    hint = did_you_mean(name, items.by_name) if isinstance(name, str) else ""
    return f"{name!r} is no kind of {items.noun}{hint or '; there is ' + ', '.join(items.by_name)}"


def _explain_field(kind: ItemKind, field: str) -> str:
    return f"a {kind.name} has no field '{make_printable(field)}'{did_you_mean(field, kind.fields)}"


Unknowns = dict[tuple[str, ...], dict[str, Any]]
"""What this version does not know, by its place: whole items under (), fields of an item under its name."""


def split_unknown(items: Items, objects: Mapping[str, Any]) -> tuple[dict[str, Any], Unknowns]:
    """What this version knows of objects by name, and what it only keeps: unknown kinds and fields."""
    known: dict[str, Any] = {}
    unknown: Unknowns = {}
    for name, fields in objects.items():
        parts = cast("Mapping[str, Any]", fields if isinstance(fields, Mapping) else {})
        kind = items.by_name.get(str(parts.get(KIND, items.kinds[0].name)))
        if kind is None and isinstance(parts[KIND], str):
            unknown.setdefault((), {})[name] = fields
            continue
        known[name] = fields
        strange = {key: part for key, part in parts.items() if kind and key != KIND and key not in kind.fields}
        if strange:
            unknown[(name,)] = strange
            known[name] = {key: part for key, part in parts.items() if key not in strange}
    return known, unknown


def describe_items(declared: Items, items: ItemSet) -> dict[str, dict[str, Any]]:
    """Named items as a file holds them: by name their kind and the fields that differ from its defaults."""
    return {name: {KIND: item.kind, **_describe_fields(declared, item)} for name, item in items.items()}


def _describe_fields(declared: Items, item: NamedItem) -> dict[str, Any]:
    kind = declared.by_name.get(item.kind)
    return {
        name: describe_scalar(kind.fields[name], plain) if kind and name in kind.fields else plain
        for name, plain in item.fields.items()
    }


def check_new_item(items: Items, names: Collection[str], name: str) -> None:
    """Raise GraphError unless an item can have this name beside the others."""
    if fault := name_fault(name, items.noun):
        raise GraphError(fault)
    if name in names:
        raise GraphError(f"a {items.noun} called '{name}' already exists; choose another name")
