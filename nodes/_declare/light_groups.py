"""Light groups as named items: how bright, and in which color, each group of lights of a render shines."""

from typing import Annotated, get_type_hints

from msgspec import Struct
from msgspec.structs import fields as fields_of

from .items import ItemSet, NamedItem
from .lights import Temperature
from .values import Doc, ItemKind, Items, Slider, Swatch, read_value


class LightGroup(Struct, frozen=True):
    """The light of some of the lights of a render, which the renderer wrote as a layer of its own."""

    on: Annotated[bool, Doc("Whether the light of the group is in the picture.")] = True
    solo: Annotated[bool, Doc("While any group is solo, only solo groups are in the picture.")] = False
    color: Annotated[tuple[float, float, float], Swatch(), Doc("Factor on the light of the group.")] = (1.0, 1.0, 1.0)
    temperature: Temperature = 0.0
    exposure: Annotated[float, Slider(-6.0, 6.0, unit="EV", doc="Doubles the light of the group with each stop.")] = 0.0


_HINTS = get_type_hints(LightGroup, include_extras=True)

LIGHT_GROUPS = Items(
    (
        ItemKind(
            "group",
            tuple(read_value(field.name, _HINTS[field.name], field.default) for field in fields_of(LightGroup)),
            "The light of a group of lights of the render, by its name there.",
        ),
    ),
    "light group",
    256,
)
"""What a value of light groups can hold."""

LightGroupSet = Annotated[ItemSet, LIGHT_GROUPS]


def light_groups_of(items: ItemSet) -> dict[str, LightGroup]:
    """The groups that a value holds, by name."""
    return {name: LightGroup(**LIGHT_GROUPS.settings(item)) for name, item in items.items()}


def name_light_groups(**groups: LightGroup) -> ItemSet:
    """The value that holds these groups under these names."""
    default = LightGroup()
    return ItemSet(
        {
            name: NamedItem.of(
                "group",
                {
                    field.name: getattr(group, field.name)
                    for field in fields_of(LightGroup)
                    if getattr(group, field.name) != getattr(default, field.name)
                },
            )
            for name, group in groups.items()
        }
    )
