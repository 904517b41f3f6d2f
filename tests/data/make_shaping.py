"""Makes hb_shape.json: what the program hb-shape of HarfBuzz 6.0.0 (Debian's libharfbuzz-bin) says of texts.

`python make_shaping.py HB_SHAPE`; noto_devanagari.ttf was cut from Debian's Noto Sans Devanagari by fontTools' subset
with `--layout-features=* --no-hinting`.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
DEJAVU = HERE.parents[1] / "app/media/lettering/fonts/DejaVuSans.ttf"
TEXTS = {
    "latin": (DEJAVU, "AVAR fi e\u0301\u0323"),
    "arabic": (DEJAVU, "السلام عليكم"),
    "arabic marks": (DEJAVU, "مُحَمَّد لا"),
    "hebrew": (DEJAVU, "שָׁלוֹם"),
    "devanagari": (HERE / "noto_devanagari.ttf", "क्षत्रिय हिन्दी"),
    "devanagari greeting": (HERE / "noto_devanagari.ttf", "नमस्ते विश्व"),
}
GLYPH = re.compile(r"(\d+)=(\d+)(?:@(-?\d+),(-?\d+))?\+(-?\d+)")


def main() -> None:
    """Run hb-shape and write what it says: glyph, cluster, x and y offset, advance."""
    cases = {}
    for name, (font, text) in TEXTS.items():
        words = [sys.argv[1], str(font), text, "--no-glyph-names", "--language=und"]
        line = subprocess.run(words, capture_output=True, text=True, check=True).stdout
        glyphs = [[int(part or 0) for part in match.groups()] for match in GLYPH.finditer(line)]
        cases[name] = {"font": font.name, "text": text, "glyphs": glyphs}
    lines = (f"{json.dumps(name)}: {json.dumps(case, ensure_ascii=False)}" for name, case in cases.items())
    (HERE / "hb_shape.json").write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


main()
