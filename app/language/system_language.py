"""Which language the system asks for."""

from __future__ import annotations

import locale
import os
import sys
from collections.abc import Collection

_VARIABLES = ("LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG")
"""As gettext reads them: the first one that is set counts. Only the first may be a list."""


def find_system_language(known: Collection[str]) -> str:
    """The first language that the system asks for and that is known, by its code; else English."""
    wishes = next((words for name in _VARIABLES if (words := os.environ.get(name))), "") or _ask_windows()
    codes = (wish.partition(".")[0].partition("_")[0].partition("-")[0].lower() for wish in wishes.split(":"))
    return next((code for code in codes if code in known), "en")


def _ask_windows() -> str:
    """The language of the interface of Windows, such as `de_DE`; "" elsewhere."""
    if sys.platform != "win32":
        return ""
    import ctypes

    return locale.windows_locale.get(ctypes.windll.kernel32.GetUserDefaultUILanguage(), "")
