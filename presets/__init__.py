"""Ready graphs, in the same JSON as user files."""

from __future__ import annotations

from pathlib import Path


def paths() -> tuple[Path, ...]:
    """Every preset of Halation itself, by name."""
    return tuple(sorted(Path(__file__).parent.glob("*.json")))


def picture(preset: Path) -> Path:
    """A small picture of what it makes of its sample."""
    return preset.parent / "pictures" / f"{preset.stem}.jpg"


def sample() -> Path:
    """The frame that presets and nodes are shown on: layers of a small scene."""
    return Path(__file__).parent / "samples" / "neon.exr"
