"""Formats, drags, steps and parses the number of a number field. Nothing here draws."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from decimal import Decimal
from types import MappingProxyType

from halation.nodes import Value, read_reference
from msgspec import Struct

from ...errors import UsageError
from ...language.translation import mark, translate
from ..shared.declared_words import name_choice
from .arithmetic import evaluate

SUFFIX: Mapping[str | None, str] = MappingProxyType(
    {
        "px": "px",
        "height": "h",
        "deg": "°",
        "EV": "EV",
        "s": "s",
        None: "",
        "ratio": "",
        "count": "",
        "scene": "",
        "K": "K",
        "mm": "mm",
    }
)
"""The suffix of a number, by unit."""

MEANING: Mapping[str | None, str] = MappingProxyType(
    {
        "px": mark("pixels at full size"),
        "height": mark("fraction of the picture's height"),
        "deg": mark("degrees"),
        "EV": mark("photographic stops"),
        "s": mark("seconds"),
        "ratio": mark("a plain factor"),
        "count": mark("a whole number"),
        None: "",
        "scene": mark("scene units"),
        "K": mark("kelvin"),
        "mm": mark("millimeters"),
    }
)


def unit_suffix(unit: str | None) -> str:
    """The suffix of a number with a unit; that of pixels at a height is the unit itself: px@1080."""
    return SUFFIX.get(unit, unit or "")


def unit_meaning(unit: str | None) -> str:
    """What a unit means, in words."""
    if height := read_reference(unit):
        return translate("pixels of a picture that is {height} pixels high", height=height)
    return translate(MEANING.get(unit, ""))


RATE = Value("rate", "float", 24.0, low=1.0, high=60.0, minimum=0.01, maximum=1000.0)
"""Frames per second."""

FINE, UNBOUNDED_SPAN = 0.1, 2.0
_PLAIN = re.compile(r"\s*[-+]?\d*\.?\d*\s*")


def span(declaration: Value) -> float:
    """The width of the soft range; a guess for a number without one."""
    width = declaration.high - declaration.low
    return width if math.isfinite(width) and width > 0.0 else UNBOUNDED_SPAN


def near(frame: int, reach: int = 10) -> Value:
    """A declaration for a frame number, which has no range and is dragged in steps of about 1."""
    return Value("frame", "int", 1, low=float(frame - reach), high=float(frame + reach))


def count_decimals(declaration: Value) -> int:
    """The number of decimals to show, by the soft range."""
    return 0 if declaration.type == "int" else min(max(3 - round(math.log10(span(declaration))), 1), 6)


def format_number(number: float, declaration: Value) -> str:
    """The number as a field shows it, without its unit; a very small one keeps three significant digits."""
    if isinstance(number, int) and declaration.type == "int":
        return str(number)
    digits = count_decimals(declaration)
    if number and (abs(number) < 10.0 ** (1 - digits) or abs(number) >= 1e7) and round(number, digits) != number:
        return f"{number:.3g}"
    text = f"{number:.{digits}f}"
    return text.removeprefix("-") if float(text) == 0.0 else text


def drop_digit(text: str) -> str:
    """A displayed number with one decimal less; unchanged if it has none."""
    part = text.partition(".")[2]
    if not part.isdigit():
        return text
    short = f"{float(text):.{len(part) - 1}f}"
    return short.removeprefix("-") if float(short) == 0.0 else short


def edit_text(number: float) -> str:
    """The number as text to edit, with all of its digits."""
    return str(number) if isinstance(number, int) else repr(float(number)).removesuffix(".0")


def find_step(declaration: Value) -> float:
    """A round step: about a twentieth of the soft range."""
    raw = span(declaration) / 20.0
    power = 10.0 ** math.floor(math.log10(raw))
    size = next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= raw * 0.999)
    return max(1.0, round(size)) if declaration.type == "int" else size


def clamp_number(number: float, declaration: Value) -> float | int:
    """The nearest number within the hard range; a whole one for an int."""
    inside = min(max(number, declaration.minimum), declaration.maximum)
    return round(inside) if declaration.type == "int" else inside


def bar(number: float, declaration: Value) -> tuple[float, float] | None:
    """The filled part of the field, as fractions of its width: from zero, or from the low end. None without a range."""
    low, high = declaration.low, declaration.high
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        return None
    zero, place = (min(max((part - low) / (high - low), 0.0), 1.0) for part in (0.0, number))
    return min(zero, place), max(zero, place)


class Drag(Struct, frozen=True):
    """A drag of a number: its start, and how far it was moved since, in its own units."""

    start: float
    travel: float = 0.0

    def move(self, pixels: float, width: float, declaration: Value, *, fine: bool = False) -> Drag:
        """Drag on: the width of the field is the soft range, or a tenth of it if `fine`."""
        speed = span(declaration) / max(width, 1.0)
        return Drag(self.start, self.travel + pixels * speed * (FINE if fine else 1.0))

    def number(self, declaration: Value, *, fine: bool = False, snap: bool = False) -> float | int:
        """The number now: within the soft range (or as far out as it started), rounded to the digits shown."""
        low, high = min(declaration.low, self.start), max(declaration.high, self.start)
        number = min(max(self.start + self.travel, low), high)
        if snap:
            size = find_step(declaration)
            number = round(number / size) * size
        if self.travel:
            number = round(number, count_decimals(declaration) + (1 if fine and declaration.type != "int" else 0))
        return clamp_number(number, declaration)


def parse_number(text: str, old: float, declaration: Value) -> float | int:
    """The typed number. Raises UsageError if it is invalid or outside of the hard range."""
    number = evaluate(text, old, declaration.unit)
    if declaration.type == "int":
        if abs(number - round(number)) > 1e-9:
            raise UsageError(translate("{number:g} is not a whole number: type one without decimals", number=number))
        number = round(number)
    if not declaration.minimum <= number <= declaration.maximum:
        limits = _limits(declaration)
        if number < declaration.minimum:
            raise UsageError(translate("{number:g} is too small: type a number {limits}", number=number, limits=limits))
        raise UsageError(translate("{number:g} is too large: type a number {limits}", number=number, limits=limits))
    return number


def step_digit(text: str, caret: int, direction: int) -> tuple[str, int]:
    """The text and caret after an arrow key: the digit left of the caret (or the first one) goes up or down by 1."""
    if not _PLAIN.fullmatch(text) or not any(letter.isdigit() for letter in text):
        return text, caret
    point = text.index(".") if "." in text else len(text.rstrip())
    at = max(caret - 1, 0)
    while at < len(text) and not text[at].isdigit():
        at = at - 1 if text[at] == "." and at > 0 and text[at - 1].isdigit() else at + 1
    if at >= len(text):
        at = max(index for index, letter in enumerate(text) if letter.isdigit())
    power = point - at - 1 if at < point else point - at
    number = Decimal(text.strip()) + direction * Decimal(10) ** power
    stepped_text = f"{number:f}"
    if number == 0:
        stepped_text = stepped_text.removeprefix("-")
    return stepped_text, min(max(len(stepped_text) - (len(text.rstrip()) - at - 1), 1), len(stepped_text))


def describe_value(declaration: Value, default: str) -> str:
    """The tooltip of a value: description, unit, range and default."""
    lines = [translate(declaration.doc)] if declaration.doc else []
    if declaration.type in ("float", "int", "vector", "curve"):
        meaning, limits = unit_meaning(declaration.unit), _limits(declaration)
        low, high = declaration.low, declaration.high
        soft = (
            translate("usually {low:g} to {high:g}", low=low, high=high)
            if math.isfinite(low) and math.isfinite(high)
            else ""
        )
        facts = "; ".join(part for part in (meaning, soft, limits) if part)
        lines += [facts[0].upper() + facts[1:]] if facts else []
    return "\n".join([*lines, translate("Default: {default}", default=default)] if default else lines)


def describe_default(declaration: Value) -> str:
    """The default as text for a tooltip; "" if it is too long."""
    default = declaration.default
    match declaration.type:
        case "float" | "int":
            assert isinstance(default, int | float)
            return format_number(default, declaration)
        case "bool":
            return translate("on") if default else translate("off")
        case "choice":
            return name_choice(str(default))
        case "text" | "path":
            return str(default)
        case "curve" | "ramp" | "spline" | "stroke" | "point" | "items":
            return ""
        case _:
            assert isinstance(default, tuple)
            return ", ".join(f"{part:g}" for part in default)


def _limits(declaration: Value) -> str:
    low, high = declaration.minimum, declaration.maximum
    if math.isinf(low) and math.isinf(high):
        return ""
    if math.isinf(high):
        return translate("at least {low:g}", low=low)
    return (
        translate("at most {high:g}", high=high)
        if math.isinf(low)
        else translate("from {low:g} to {high:g}", low=low, high=high)
    )
