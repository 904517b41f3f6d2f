"""Finds and opens fonts: files, installed families by name, and those of the package."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any

from halation.nodes import Typeface
from msgspec import Struct

from ...errors import InputError
from ...resources.input_files import check_file, find_similar_name, fingerprint, read_bytes
from ...resources.sandbox import Sandbox
from . import FONT_ENDINGS
from .harfbuzz import hb

FONTS = Path(__file__).parent / "fonts"
PACKED = {"dejavu sans": ("DejaVuSans.ttf", "DejaVuSans-Bold.ttf"), "dejavu sans mono": ("DejaVuSansMono.ttf",)}
"""The families of the package, with their files by weight."""

DEFAULT_FAMILY = "DejaVu Sans"

_MOST_BYTES = 200_000_000
"""The largest font file. The largest that are in use hold Chinese, Japanese and Korean in all weights: 120 MB."""

_REGULAR, _BOLD = 400.0, 700.0
"""The weights of the regular and the bold faces (CSS Fonts 4); a font that names none is regular."""

_BOLD_FROM = (_REGULAR + _BOLD) / 2.0
"""The weight from which the bold file is nearer than the regular one."""

_SAME_WEIGHT = 50.0
"""Half of the step of 100 between named weights: a font that is nearer than that has the weight."""

_BOLD_STEP = 0.04 / 300.0
"""How much thicker strokes become for each unit of weight, in em: 0.04 from regular to bold, of the 0.01 to 0.05 that
HarfBuzz calls typical."""

_OUTLINE_TABLES = ("glyf", "CFF ", "CFF2")


class LoadedFont(Struct, frozen=True, eq=False):
    """A font that is ready to shape and draw."""

    font: Any
    upem: int
    name: str
    mark: str
    """Equal marks, equal outlines."""


def load_font(typeface: Typeface, sandbox: Sandbox) -> LoadedFont:
    """The font of a typeface. Raises InputError for one that is not there or cannot be read."""
    family = " ".join((typeface.family or DEFAULT_FAMILY).lower().split())
    if typeface.path:
        path = typeface.path
    elif family in PACKED:
        files = PACKED[family]
        file = FONTS / files[-1 if typeface.weight > _BOLD_FROM else 0]
        return _load(str(file), f"{file.name} 2.37", typeface.weight, None)
    else:
        path = _find_family(family, typeface, sandbox)
    return _load(path, fingerprint(path, sandbox), typeface.weight, sandbox)


@lru_cache(maxsize=32)  # chosen by judgement: more fonts than a graph has, a few MB each
def _load(path: str, mark: str, weight: float, sandbox: Sandbox | None) -> LoadedFont:
    """Open a font. HarfBuzz checks all tables before it uses them."""
    if sandbox is None:
        content = Path(path).read_bytes()
    else:
        if (size := check_file(path, sandbox).stat().st_size) > _MOST_BYTES:
            raise InputError(f"{path}: has {size:,} bytes, and a font at most {_MOST_BYTES:,}: choose another font")
        content = read_bytes(path, sandbox)
    face = hb.Face(hb.Blob(content))
    if fault := _find_fault(content, face):
        raise InputError(f"{path}: {fault}: choose a .ttf or .otf font")
    font = hb.Font(face)
    font.scale = (face.upem, face.upem)
    if any(axis.tag == "wght" for axis in face.axis_infos):
        font.set_variations({"wght": weight})
    else:
        own = font.get_style_value(hb.StyleTag.WEIGHT) or _REGULAR
        if (sandbox is None and own == weight) or abs(weight - own) < _SAME_WEIGHT:
            own = weight
        if weight != own:
            font.synthetic_bold = (weight - own) * _BOLD_STEP
    return LoadedFont(font, face.upem, _read_name(face) or Path(path).stem, f"{mark} {weight}")


def _find_fault(content: bytes, face: Any) -> str:
    """Why a file is no font that can be drawn; "" if it is one."""
    if content[:4] in (b"wOFF", b"wOF2"):
        return "is a packed font for web pages"
    try:
        tags = face.table_tags
    except UnicodeDecodeError:
        return "is damaged: its tables have no names"
    if face.glyph_count == 0 or not tags:
        return "is no font that can be read"
    if not any(tag in tags and len(face.reference_table(tag)) for tag in _OUTLINE_TABLES):
        return "has no outlines, only pictures of letters or nothing"
    if not len(face.unicodes):
        return "is damaged: it names no characters"
    return ""


def _read_name(face: Any) -> str:
    """The family of a font, as its file says."""
    ids = (hb.OTNameIdPredefined.TYPOGRAPHIC_FAMILY, hb.OTNameIdPredefined.FONT_FAMILY)
    try:
        return next((name for id in ids if (name := face.get_name(id))), "")
    except (UnicodeDecodeError, hb.HarfBuzzError):  # of a damaged font, which may be drawn all the same
        return ""


def _find_family(family: str, typeface: Typeface, sandbox: Sandbox) -> str:
    """The installed file of a family whose weight is the nearest."""
    families = list_installed_families()
    files = families.get(family)
    if not files:
        guess = find_similar_name(family, [*families, *PACKED])
        hint = f"did you mean '{guess}'?" if guess else "name the file of a font instead"
        raise InputError(f"there is no font family '{typeface.family}' here: {hint}")
    path = min(files, key=lambda file: abs(file[0] - typeface.weight))[1]
    sandbox.check(path)
    return path


def list_installed_families() -> dict[str, list[tuple[float, str]]]:
    """The upright fonts of this system, by family in small letters: their weights and files, in the order of names."""
    return _read_families(tuple(_list_folders()))


def _list_folders() -> Iterator[str]:
    """Where systems keep fonts."""
    home = Path.home()
    if sys.platform == "win32":
        yield r"C:\Windows\Fonts"
    elif sys.platform == "darwin":
        yield from ("/System/Library/Fonts", "/Library/Fonts", str(home / "Library" / "Fonts"))
    else:
        yield from (
            "/usr/share/fonts",
            "/usr/local/share/fonts",
            str(home / ".local/share/fonts"),
            str(home / ".fonts"),
        )


@lru_cache(maxsize=1)
def _read_families(folders: tuple[str, ...]) -> dict[str, list[tuple[float, str]]]:
    families = dict[str, list[tuple[float, str]]]()
    for folder in folders:
        for file in sorted(Path(folder).rglob("*")):
            if file.suffix.lower() not in FONT_ENDINGS or not file.is_file():
                continue
            face = hb.Face(hb.Blob.from_file_path(str(file)))
            font = hb.Font(face)
            if face.glyph_count and not font.get_style_value(hb.StyleTag.ITALIC):
                weight = font.get_style_value(hb.StyleTag.WEIGHT)
                families.setdefault(_read_name(face).lower(), []).append((weight, str(file)))
    return families
