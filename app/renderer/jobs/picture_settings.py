"""The settings of a render that decide its pixels and how they are encoded: in jobs, and in the headers of pictures."""

from __future__ import annotations

from typing import Self

from halation.nodes import Size
from msgspec import Struct

from ...resources.render_choices import Dither, Form, Precision
from ...resources.struct_json import read_struct, write_struct


class PictureSettings(Struct, frozen=True, kw_only=True, omit_defaults=True):
    """What `RenderJob` and `RecordedSettings` share, in the same JSON."""

    node: str = ""
    """The node, or the output of one, that is rendered instead of the graph's outputs."""
    size: Size | None = None
    scale: float = 1.0
    precision: Precision | None = None
    form: Form | None = None
    view: str = ""
    display: str = ""
    look: str = ""
    colorspace: str = ""
    compression: str = "zip"
    dither: Dither = "none"
    """`none` where a header does not say it: earlier versions did not dither."""

    def to_json(self) -> str:
        """The settings as one line of JSON in ASCII, which can hold names of files in any encoding."""
        return write_struct(self)


class RecordedSettings(PictureSettings, frozen=True, kw_only=True, omit_defaults=True):
    """The settings of one picture, as its header keeps them. They name no files: the header lists these apart.

    `outputs` are the outputs of the graph in the file. `frames` are the first and last frame of the graph if it has
    temporal nodes. `precision` is that of the file, `intermediates` that of the pixels between passes.
    """

    frame: int = 1
    outputs: tuple[str, ...] = ()
    frames: tuple[int, int] | None = None
    intermediates: Precision | None = None

    @classmethod
    def from_json(cls, text: str) -> Self:
        """The settings in a text of `to_json`; names that this version does not know are ignored. Raises ValueError."""
        return read_struct(text, cls)
