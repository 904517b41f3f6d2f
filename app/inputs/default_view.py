"""Chooses the view of a picture where nobody names one.

A view such as ACES turns the light of a scene into a picture for a screen. Pictures from phones and paint programs
(PNG, JPEG, most videos) have been through a view already: a second one would darken them and take their contrast. So a
result that is made of such pictures alone is only encoded, and a graph that changes nothing gives back what it reads.
As soon as light of a scene is part of it, from an EXR, a mesh or an array, the default view of the config applies.
"""

from __future__ import annotations

from typing import Protocol

from halation.nodes import Kind

from ..color.display import NO_VIEW, VIDEO_VIEW
from ..compiler import Plan
from ..resources.picture import Picture


class PictureEncodings(Protocol):
    """Knows how files encode color."""

    def find_plain_view(self, picture: Picture) -> str | None:
        """The view that encodes color as a picture for a screen has it, "" for light of a scene, None for data.

        Raises InputError for a file that cannot be read.
        """
        ...


def choose_default_view(plan: Plan, surface: int, encodings: PictureEncodings) -> str:
    """The view `none` if an output of a plan is made of display-referred pictures only, else "": that of the config.

    If all of them are video for a BT.1886 display, it is `bt1886`, so that video comes back with the codes that it had.

    Raises InputError for a file that cannot be read.
    """
    surfaces = {surface}
    for render_pass in reversed(plan.passes):  # each stands after those that it reads
        if not surfaces.isdisjoint(render_pass.targets):
            if render_pass.mesh is not None:
                return ""
            surfaces.update(render_pass.textures)
    pictures = (upload.picture for upload in plan.uploads if upload.surface in surfaces)
    views = {encodings.find_plain_view(picture) for picture in pictures if picture.kind is Kind.IMAGE} - {None}
    if not views or "" in views:
        return ""
    return VIDEO_VIEW if views == {VIDEO_VIEW} else NO_VIEW
