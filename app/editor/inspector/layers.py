"""Headers of files and thumbnails of their layers, read in a thread. Nothing here draws."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from halation.nodes import Kind

from ...authoring.background.cache import BackgroundCache
from ...color.display import NO_VIEW, to_display
from ...color.file_space import FileSpace
from ...color.management import ColorManager
from ...color.transforms import Array
from ...errors import HalationError
from ...language.translation import translate
from ...media import ImageInfo, find_layer, read_info, read_layer
from ...media.color_spaces import find_layer_spaces
from ...resources.sandbox import Sandbox
from ...watch.versions import FileVersions

WIDTH, HEIGHT = 96, 54
_KEPT = 300
"""Thumbnails and layers of files that are kept: several renders of fifty layers each. Chosen by judgement."""
_NOTHING = 1e9
"""The depth from which on there is only background."""

Key = tuple[str, str, str | None]
"""Path, version of the file, layer; None for the header."""
SpaceKey = tuple[str, str, ColorManager, str]
"""Path, version of the file, color manager, and the color space that the user chose."""


class Layers:
    """The headers and thumbnails of files. Never waits for a file; the last requested one is read first."""

    def __init__(self, sandbox: Sandbox) -> None:
        self._sandbox, self._versions = sandbox, FileVersions(sandbox)
        self._made: BackgroundCache[Key, ImageInfo | Array | str] = BackgroundCache("layers", self._read, _KEPT)
        self._spaces: BackgroundCache[SpaceKey, Mapping[str, FileSpace] | str] = BackgroundCache(
            "spaces", self._find_spaces, _KEPT
        )

    def header(self, path: Path) -> ImageInfo | str | None:
        """The header, a sentence if there is none, None while it is being read."""
        version, fault = self._versions.of(path)
        header = fault or self._made.get((str(path), version, None))
        return header if isinstance(header, ImageInfo | str) else None

    def fault(self, path: Path) -> str:
        """Why a file does not exist, or ""."""
        return self._versions.of(path)[1]

    def picture(self, path: Path, layer: str) -> Array | None:
        """A thumbnail of a layer, [h, w, 3] of uint8, at most 96 x 54; None while it is read, or if that fails."""
        version, fault = self._versions.of(path)
        picture = None if fault else self._made.get((str(path), version, layer))
        return picture if isinstance(picture, np.ndarray) else None

    def space(self, path: Path, layer: str, manager: ColorManager, chosen_space: str) -> tuple[str, bool]:
        """The color space of a layer and how it was detected, and whether that is an error; "" while it is read."""
        version, fault = self._versions.of(path)
        spaces = None if fault else self._spaces.get((str(path), version, manager, chosen_space))
        header = self.header(path)
        if spaces is None or isinstance(spaces, str) or not isinstance(header, ImageInfo):
            return (spaces, True) if isinstance(spaces, str) else ("", False)
        try:
            space = spaces.get(find_layer(header, layer).full_name)
        except HalationError:
            return "", False
        return (f"{space.name}: {space.reason}", False) if space else ("", False)

    def version(self, path: Path) -> str:
        """A number that changes when the file changes."""
        return self._versions.of(path)[0]

    @property
    def busy(self) -> bool:
        """True while something is being read."""
        return self._made.is_busy or self._spaces.is_busy

    def close(self) -> None:
        """End the threads."""
        self._made.close()
        self._spaces.close()

    # --- in threads --------------------------------------------------------------------------------------------------

    def _read(self, key: Key) -> ImageInfo | Array | str:
        path, _, layer = key
        try:
            header = read_info(path, sandbox=self._sandbox)
            return header if layer is None else small_picture(path, layer, header, self._sandbox)
        except HalationError as fault:
            return str(fault)
        except Exception as fault:
            return translate("{path}: cannot be shown ({fault})", path=path, fault=fault)

    def _find_spaces(self, key: SpaceKey) -> Mapping[str, FileSpace] | str:
        path, _, manager, chosen_space = key
        try:
            return find_layer_spaces(path, manager, chosen_space, sandbox=self._sandbox)
        except HalationError as fault:
            return str(fault)
        except Exception as fault:
            return translate("{path}: cannot be read ({fault})", path=path, fault=fault)


def small_picture(path: str, layer: str, header: ImageInfo, sandbox: Sandbox) -> Array:
    """A thumbnail of a layer, [h, w, 3] of uint8, at most 96 x 54: every n-th pixel; data from lowest to highest.

    Raises InputError.
    """
    named_layer = find_layer(header, layer)
    array = read_layer(path, layer, Kind.IMAGE, sandbox=sandbox).array
    step = max(1, -(-array.shape[1] // WIDTH), -(-array.shape[0] // HEIGHT))
    small = np.ascontiguousarray(array[::step, ::step, :3], dtype=np.float32)
    if named_layer.is_data:
        finite = small[np.isfinite(small) & (np.abs(small) < _NOTHING)]
        low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
        small = np.nan_to_num((small - low) / max(high - low, 1e-12), nan=0.0, posinf=1.0, neginf=0.0)
        return (np.clip(small, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)
    return to_display(small, NO_VIEW)


def describe_layer(header: ImageInfo, layer: str) -> str:
    """A summary of a file: size, the channels of a layer, and their format."""
    try:
        named_layer = find_layer(header, layer)
    except HalationError as fault:
        return str(fault).removeprefix(f"{header.path}: ")
    channels = (
        "".join(named_layer.channels)
        if all(len(name) == 1 for name in named_layer.channels)
        else ", ".join(named_layer.channels)
    )
    kind = "data" if named_layer.is_data else "color"
    return f"{header.size[0]} x {header.size[1]}, {channels}, {named_layer.format}, {kind}"
