"""How a viewer shows a result: its place on a panel, its channels, exposure, view and comparison."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct, field

from ...color.management import ColorManager, get_default_color_manager

Channels = Literal["color", "red", "green", "blue", "alpha", "luminance", "false color"]
Meaning = Literal["image", "field", "vector", "normal"]
Compare = Literal["off", "wipe", "difference", "b"]
DisplayColor = tuple[float, float, float]
Point = tuple[float, float]
Size = tuple[int, int]


class Look(Struct, frozen=True):
    """The settings of a viewer. Colors are display-referred; lengths on the picture are in its full-size pixels."""

    zoom: float = 1.0
    """Panel pixels per full-size pixel of the picture, down."""
    stretch: float = 1.0
    """How much wider than high a pixel of the picture is shown: its pixel aspect ratio."""
    pan: Point = (0.0, 0.0)
    """Panel pixels from the center of the panel to that of the picture."""
    channels: Channels = "color"
    meaning: Meaning = "image"
    """Images go through exposure and view. Fields and vectors show a range, normals -1..1, as they are."""
    low: float = 0.0
    high: float = 1.0
    """The range of fields and vectors that is shown as black to white."""
    exposure: float = 0.0
    """EV."""
    gamma: float = 1.0
    view: str = ""
    """A view of OpenColorIO; "" is the default, "none" only encodes as sRGB."""
    display: str = ""
    look: str = ""
    """A look of OpenColorIO in place of those of the view; "" is what the view says, "none" none."""
    manager: ColorManager = field(default_factory=get_default_color_manager)
    """How colors are managed; by default as where no graph says so."""
    compare: Compare = "off"
    wipe: Point = (0.5, 0.5)
    """A point of the line between a and b, as a fraction of picture a."""
    angle: float = 0.0
    """Of that line in degrees: 0 is vertical with a on the left, 90 horizontal with a on top."""
    checker: bool = True
    """A pattern behind what is transparent, instead of `background`."""
    background: DisplayColor = (0.0, 0.0, 0.0)
    clipping: bool = False
    """Stripes over what is beyond 0..1: after exposure, or of the range."""
    nonfinite: bool = True
    """Magenta where a pixel is NaN or infinite."""
    region: tuple[float, float, float, float] | None = None
    """x, y, width, height; what lies outside is dimmed."""
    surround: DisplayColor = (0.12, 0.12, 0.12)

    @property
    def pixel_size(self) -> Point:
        """Panel pixels per full-size pixel of the picture, across and down."""
        return self.zoom * self.stretch, self.zoom


def find_origin(look: Look, panel: Size, picture: Size) -> Point:
    """The panel point where the picture's upper left corner lies, on whole pixels."""
    x, y = (panel[axis] / 2 + look.pan[axis] - picture[axis] * look.pixel_size[axis] / 2 for axis in (0, 1))
    return float(round(x)), float(round(y))


def find_picture_point(look: Look, panel: Size, picture: Size, point: Point) -> Point:
    """The point of the picture, in full-size pixels, under a point of the panel."""
    origin_x, origin_y = find_origin(look, panel, picture)
    across, down = look.pixel_size
    return (point[0] - origin_x) / across, (point[1] - origin_y) / down


def find_panel_point(look: Look, panel: Size, picture: Size, point: Point) -> Point:
    """Where a point of the picture, in full-size pixels, lies on the panel."""
    origin_x, origin_y = find_origin(look, panel, picture)
    across, down = look.pixel_size
    return point[0] * across + origin_x, point[1] * down + origin_y


def fit_zoom(panel: Size, picture: Size, stretch: float = 1.0) -> float:
    """The zoom at which the whole picture, whose pixels are shown wider by `stretch`, fills the panel."""
    return min(panel[0] / (picture[0] * stretch), panel[1] / picture[1])
