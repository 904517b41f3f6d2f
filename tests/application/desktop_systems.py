"""Builds the application for macOS or Windows, on that system: a bundle, or a folder with a program.

    PYTHONPATH=tests python -m application.desktop_systems FOLDER      # halation.app, or halation/halation.exe

Untested so far: no machine with either system has run it. `.github/workflows/applications.yml` calls it on machines of
GitHub, signs and packs what it makes. The environment that runs it needs Halation with all extras for users, and
PyInstaller. On macOS, HALATION_SIGN is the identity of a certificate "Developer ID Application", by which all programs
and libraries inside are signed, as notarization needs it.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

from application.build import HERE, ROOT, list_options

_ENTITLEMENTS = HERE / "macos.entitlements"
_ICON = ROOT / "app/desktop/icons/512.png"


def list_system_options(system: str, environment: Mapping[str, str]) -> list[str]:
    """Options of PyInstaller for a system, by its name in `sys.platform`; the icon is converted by Pillow."""
    if system == "darwin":
        options = ["--windowed", "--osx-bundle-identifier", "org.halation.halation", "--icon", str(_ICON)]
        if identity := environment.get("HALATION_SIGN"):
            options += ["--codesign-identity", identity, "--osx-entitlements-file", str(_ENTITLEMENTS)]
        return options
    if system == "win32":
        return ["--icon", str(_ICON), "--hide-console", "hide-early"]
    sys.exit(f"desktop_systems: {system} has another script: ./dev release builds the application for Linux")


def main() -> None:
    """Build the application of this system in the folder that is named."""
    if len(sys.argv) != 2:
        sys.exit("desktop_systems: name the folder in which the application is built")
    folder = Path(sys.argv[1]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    options = [*list_options(folder), *list_system_options(sys.platform, os.environ)]
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    command = [sys.executable, "-m", "PyInstaller", *options, HERE / "program.py"]
    subprocess.run(command, cwd=folder, env=environment, check=True)


if __name__ == "__main__":
    main()
