from typing import Annotated

from .._declare import (
    Doc,
    Draw,
    Drawn,
    Image,
    ItemSet,
    LightGroup,
    LightGroupSet,
    OfSpace,
    OutputSocket,
    Reader,
    RenderPath,
    light_groups_of,
)
from ..light._blackbody import blackbody_rec709


class LightGroups(Reader):
    """Read a render and change the light of its light groups: color, exposure, on, off and solo.

    A renderer writes a layer for each group of lights: Blender `Combined_key`, Arnold `RGBA_key`, V-Ray
    `LightSelect_key`, others `Beauty_key`. Light adds up, so a group can be dimmed or colored as if the render was made
    again. Name a group as the render does; groups that are not named stay as they are. `halation info FILE` lists them.
    """

    aliases = (
        "light mixer", "light mix", "light groups", "relight", "lpe", "light select", "per light aov",
        "interactive light mix",
    )  # fmt: skip

    path: Annotated[RenderPath, Doc("The render, relative to the graph's folder.")] = ""
    groups: Annotated[LightGroupSet, Doc("The groups that change, by their names in the render.")] = ItemSet()
    rest: Annotated[bool, Doc("Keeps the light that is in no group, such as emission. Off while a group is solo.")] = (
        True
    )
    color_space: Annotated[
        str, OfSpace(), Doc("The color space of the render, as of Read Render. If empty, it is recognized.")
    ] = ""

    out = OutputSocket(Image())

    def passes(self, draw: Draw) -> Drawn:
        """The picture plus what groups gain or lose: without changes it is the render, to the bit."""
        render = draw.render(self.path)
        total = self._read(draw, render.layers.get("beauty", "beauty"))
        changes = {name.casefold(): group for name, group in light_groups_of(self.groups).items()}
        layers = {name.casefold(): layer for name, layer in render.light_groups.items()}
        solo = any(group.solo for group in changes.values())
        if solo or not self.rest:
            total = draw.point("light_groups_rest", total=total, rest=False)
        for name in layers | dict.fromkeys(changes):
            group = changes.get(name, LightGroup())
            shines = group.on and (group.solo or not solo)
            kept = 0.0 if solo or not self.rest else 1.0
            gain = tuple(2.0**group.exposure * part if shines else 0.0 for part in group.color)
            if group.temperature == 0.0 and gain == (kept,) * 3:
                continue
            # A name that the render does not have is read as a layer, so that the message names those that exist.
            light = self._read(draw, layers.get(name, name))
            heated = group.temperature > 0.0
            tint = blackbody_rec709(group.temperature) if heated else (1.0,) * 3
            total = draw.point(
                "light_groups_add", total=total, light=light, gain=gain, tint=tint, heated=heated, kept=kept
            )
        return draw.point("light_groups", total=total)

    def _read(self, draw: Draw, layer: str) -> Drawn:
        return draw.read(self.path, layer, Image(), self.color_space)
