"""Makes overlapping_variable.ttf: a variable font of one letter, whose contours overlap. Needs the package fonttools.

`H` has two posts and a bar across both, and a slanted stroke over all three, each a contour of its own. The axis
`wght`, 100 to 900, makes all of them wider, so that more of them overlap. A curved dot, which turns the other way, lies
partly on a post and cuts it out there.
"""

from __future__ import annotations

from pathlib import Path

from fontTools.designspaceLib import AxisDescriptor, DesignSpaceDocument, SourceDescriptor
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont
from fontTools.varLib import build

UPEM = 1000


def make_master(width: float) -> TTFont:
    """The font with strokes of a width."""
    pen, half = TTGlyphPen(None), width / 2.0

    def add(*points: tuple[float, float]) -> None:
        pen.moveTo(points[0])
        for point in points[1:]:
            pen.lineTo(point)
        pen.closePath()

    for x in (180.0, 620.0):
        add((x - half, 0.0), (x - half, 700.0), (x + half, 700.0), (x + half, 0.0))
    add((100.0, 350.0 - half), (100.0, 350.0 + half), (700.0, 350.0 + half), (700.0, 350.0 - half))
    add((60.0 - half, 20.0), (60.0 + half, 20.0), (740.0 + half, 690.0), (740.0 - half, 690.0))
    reach = 60.0 + half
    pen.moveTo((180.0 + reach, 700.0))
    pen.qCurveTo((180.0 + reach, 700.0 + reach), (180.0, 700.0 + reach))
    pen.qCurveTo((180.0 - reach, 700.0 + reach), (180.0 - reach, 700.0))
    pen.qCurveTo((180.0 - reach, 700.0 - reach), (180.0, 700.0 - reach))
    pen.qCurveTo((180.0 + reach, 700.0 - reach), (180.0 + reach, 700.0))
    pen.closePath()
    builder = FontBuilder(UPEM, isTTF=True)
    builder.setupGlyphOrder([".notdef", "H"])
    builder.setupCharacterMap({ord("H"): "H"})
    builder.setupGlyf({".notdef": TTGlyphPen(None).glyph(), "H": pen.glyph()}, calcGlyphBounds=True)
    left = builder.font["glyf"]["H"].xMin
    builder.setupHorizontalMetrics({".notdef": (800, 0), "H": (800, left)})
    builder.setupHorizontalHeader(ascent=850, descent=-150)
    builder.setupNameTable({"familyName": "Overlapping", "styleName": "Regular"})
    builder.setupOS2(sTypoAscender=850, sTypoDescender=-150, usWeightClass=400)
    builder.setupPost()
    return builder.font


def main() -> None:
    """Write the font beside this file."""
    space = DesignSpaceDocument()
    axis = AxisDescriptor(tag="wght", name="Weight", minimum=100, default=100, maximum=900)
    space.addAxis(axis)
    for weight, width in ((100, 60.0), (900, 220.0)):
        source = SourceDescriptor(font=make_master(width), name=f"master {weight}", location={"Weight": weight})
        source.familyName, source.styleName = "Overlapping", str(weight)
        space.addSource(source)
    build(space)[0].save(Path(__file__).with_name("overlapping_variable.ttf"))


if __name__ == "__main__":
    main()
