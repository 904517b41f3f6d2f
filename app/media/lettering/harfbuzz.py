"""HarfBuzz, which states no types: its names are made while it is imported.

The package has a HarfBuzz of its own. Other libraries may load that of the system for the whole process, as the
FreeType inside of OpenImageIO does when it first draws letters. On Linux calls of the package would then go to the
other one, whose objects have another layout, and letters would be damaged or end the process. `RTLD_DEEPBIND` keeps
them apart.
"""

from __future__ import annotations

import os
import sys
from typing import Any

_flags = sys.getdlopenflags() if sys.platform == "linux" else 0
if sys.platform == "linux":
    sys.setdlopenflags(os.RTLD_NOW | getattr(os, "RTLD_DEEPBIND", 0))
try:
    import uharfbuzz
finally:
    if sys.platform == "linux":
        sys.setdlopenflags(_flags)

hb: Any = uharfbuzz
