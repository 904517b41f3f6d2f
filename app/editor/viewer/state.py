"""The state of the viewer. Nothing here changes the document."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Literal

from msgspec import Struct, field

from ...authoring.preview.large_files import LargeFiles
from .brush import PaintBrush
from .pacing import Pace
from .pen import SplinePen
from .reading import ValueReader

if TYPE_CHECKING:
    from halation.nodes import Plain

    from ...color.transforms import Array
    from ...graph import Port
    from .snapping import SnapGuide

Channels = Literal["color", "red", "green", "blue", "alpha", "luminance", "false color"]
Compare = Literal["off", "wipe", "beside", "difference", "toggle"]
Background = Literal["checker", "black", "gray", "white"]
Meaning = Literal["auto", "image", "field", "vector", "normal"]
CHANNELS: tuple[Channels, ...] = ("color", "red", "green", "blue", "alpha", "luminance", "false color")
BACKGROUNDS: tuple[Background, ...] = ("checker", "black", "gray", "white")
MEANINGS: tuple[Meaning, ...] = ("auto", "image", "field", "vector", "normal")
PROXIES = (1.0, 0.5, 0.25, 0.125)
"""The scales at which the viewer can render: with the last one a picture has a 64th of its pixels."""
SCOPES = ("histogram", "waveform", "parade", "vectorscope")

Box = tuple[float, float, float, float]
"""Left, top, right, bottom as fractions of the picture."""


class ViewerState(Struct):
    """One viewer. Lengths are panel pixels, `zoom` panel pixels per picture pixel at full size; 0 fits the panel."""

    zoom: float = 0.0
    pan: tuple[float, float] = (0.0, 0.0)
    nearer: float = 1.0
    """A requested zoom factor, applied about the pointer in the next frame."""
    shift: tuple[float, float] = (0.0, 0.0)
    """By how much of the panel the picture is moved in the next frame."""
    channels: Channels = "color"
    exposure: float = 0.0
    gamma: float = 1.0
    display: str = ""
    view: str = ""
    """OpenColorIO display and view; empty takes what the shown output asks for, else the default."""
    look: str = ""
    """A look in place of those of the view; "none" for none at all."""
    compare: Compare = "off"
    wipe: tuple[float, float] = (0.5, 0.5)
    """A point on the wipe line, as a fraction of the picture."""
    wipe_angle: float = 0.0
    """Degrees; 0 is a vertical line."""
    toggled: bool = False
    """True shows B while comparing by toggle."""
    background: Background = "checker"
    overscan: bool = True
    """True shows what pictures have beyond their frame, dimmed."""
    unsqueezes: bool = True
    """True shows pixels in their shape, as the pixel aspect ratio of the picture says."""
    pixel_aspect: float = 1.0
    """The pixel aspect ratio of the picture that was drawn last."""
    warn_clipping: bool = False
    warn_nonfinite: bool = True
    region: Box | None = None
    """Region of interest: the rest is dimmed, and not measured."""
    drawing_region: bool = False
    """True while the next drag makes the region."""
    measured: Box | None = None
    """The rectangle that the pixel table measures."""
    markers: tuple[tuple[float, float], ...] = ()
    """Points whose values stay in the pixel table, as fractions of the picture."""
    table: bool = False
    """True shows the values of every layer under the pointer."""
    finding: bool = False
    """True while the search for the first node with NaN or infinity runs."""
    saving: bool = False
    """True asks for a file and saves the picture."""
    snapshot: Callable[[Array], object] | None = None
    """Takes the next whole picture in small, [h, w, 3] of uint8."""
    copying: bool = False
    """True copies the values under the pointer to the clipboard."""
    proxy: float = 1.0
    paused: bool = False
    pace: Pace = field(default_factory=Pace)
    large_files: LargeFiles = field(default_factory=LargeFiles)
    meaning: Meaning = "auto"
    low: float = 0.0
    high: float = 0.0
    """The range of data shown as gray; if `low` and `high` are equal, it is measured."""
    span: tuple[float, float] = (0.0, 1.0)
    """The range of data in the last frame."""
    pixel: tuple[int, int] | None = None
    """The pixel under the pointer, at full size."""
    panel: tuple[int, int] = (0, 0)
    """Size of the panel in pixels as drawn last."""
    picture: tuple[int, int] = (0, 0)
    """Size of the shown picture at full size, as drawn last."""
    hovered: bool = False
    picking: str = ""
    """`node.value` that the next click on the picture sets: a color to that of the pixel, a position to its place."""
    has_gizmos: bool = True
    """False hides the handles on the picture, and lets the mouse reach what is below them."""
    guides: tuple[SnapGuide, ...] = ()
    """The lines to which what is dragged has snapped."""
    deferred: Mapping[Port, Plain] | None = None
    """Values of a drag that count when the button is released."""
    orbiting: bool = False
    """True lets the mouse move the camera of the viewed scene, not the picture."""
    pen: SplinePen = field(default_factory=SplinePen)
    brush: PaintBrush = field(default_factory=PaintBrush)
    scene: str = ""
    """The node of that scene; "" if there is none."""
    reader: ValueReader = field(default_factory=ValueReader)
    """The numbers that handles have read."""
    compare_after: Compare = "off"
    """How to compare when the flipbook is closed."""
    scopes: set[str] = field(default_factory=lambda: {"histogram", "waveform"})
    scopes_of_scene: bool = False
    """True measures scene-linear values, False display values."""
    scopes_logarithmic: bool = False

    @property
    def stretch(self) -> float:
        """How much wider than high pixels are shown."""
        return self.pixel_aspect if self.unsqueezes else 1.0

    @property
    def compares(self) -> bool:
        """True if B is needed."""
        return self.compare != "off"

    @property
    def orbits(self) -> bool:
        """True if the mouse moves a camera."""
        return self.orbiting and self.scene != ""

    def show(self, channels: Channels) -> None:
        """Show some channels; a second call shows all."""
        self.channels = "color" if self.channels == channels else channels

    def toggle_comparison(self, mode: Compare) -> None:
        """Set how to compare; a second call ends the comparison."""
        self.compare = "off" if self.compare == mode else mode

    def fit(self) -> None:
        """Fit the picture into the panel."""
        self.zoom, self.pan = 0.0, (0.0, 0.0)

    def begin_flipbook(self, count: int, *, again: bool) -> None:
        """Show one sequence, or compare two; `again` if another flipbook is on the screen."""
        if not again:
            self.compare_after = self.compare
        if count == 1:
            self.compare = "off"
        elif not self.compares:
            self.compare = "beside"
        self.fit()

    def end_flipbook(self) -> None:
        """Compare as before the flipbook."""
        self.compare = self.compare_after
