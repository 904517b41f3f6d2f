"""Pairs of curves as named items: where a feature lies in one picture, and where it lies in another."""

from typing import Annotated, get_type_hints

from msgspec import Struct
from msgspec.structs import fields as fields_of

from .items import ItemSet, NamedItem
from .values import Doc, Handle, ItemKind, Items, read_value

_Place = tuple[float, float]


class CurvePair(Struct, frozen=True):
    """A curve through three points in the first picture, and the same curve in the second, in fractions of both."""

    on: Annotated[bool, Doc("Whether the pair counts.")] = True
    from_start: Annotated[_Place, Handle(), Doc("Where the curve starts in the first picture.")] = (0.45, 0.35)
    from_middle: Annotated[_Place, Handle(), Doc("A point in its middle.")] = (0.45, 0.5)
    from_end: Annotated[_Place, Handle(), Doc("Where it ends.")] = (0.45, 0.65)
    to_start: Annotated[_Place, Handle(), Doc("Where the same curve starts in the second picture.")] = (0.55, 0.35)
    to_middle: Annotated[_Place, Handle(), Doc("A point in its middle there.")] = (0.55, 0.5)
    to_end: Annotated[_Place, Handle(), Doc("Where it ends there.")] = (0.55, 0.65)

    @property
    def points_from(self) -> tuple[_Place, _Place, _Place]:
        """The points in the first picture."""
        return self.from_start, self.from_middle, self.from_end

    @property
    def points_to(self) -> tuple[_Place, _Place, _Place]:
        """The points in the second picture."""
        return self.to_start, self.to_middle, self.to_end


_HINTS = get_type_hints(CurvePair, include_extras=True)

CURVE_PAIRS = Items(
    (
        ItemKind(
            "pair",
            tuple(read_value(field.name, _HINTS[field.name], field.default) for field in fields_of(CurvePair)),
            "A curve in one picture, and where it lies in another.",
        ),
    ),
    "pair of curves",
    64,
)
"""What a value of pairs can hold."""

CurvePairSet = Annotated[ItemSet, CURVE_PAIRS]


def curve_pairs_of(items: ItemSet) -> tuple[CurvePair, ...]:
    """The pairs that a value holds, in the order of their names."""
    return tuple(CurvePair(**CURVE_PAIRS.settings(item)) for item in items.values())


def name_curve_pairs(**pairs: CurvePair) -> ItemSet:
    """The value that holds these pairs under these names."""
    defaults = CURVE_PAIRS.kinds[0].defaults
    return ItemSet(
        {
            name: NamedItem.of(
                "pair", {key: part for key, default in defaults.items() if (part := getattr(pair, key)) != default}
            )
            for name, pair in pairs.items()
        }
    )
