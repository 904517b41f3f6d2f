"""The contents of render files, read in a thread: layers, camera and mattes, for panels and for the compiler."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType

from halation.nodes import Matte, Render

from ...errors import HalationError, InputError
from ...language.translation import translate
from ...render_layers.mattes import IdMap, read_id_map
from ...render_layers.naming import Role
from ...render_layers.overview import RenderOverview, summarize_render
from ...render_layers.render import read_render
from ...resources.input_files import fingerprint
from ...resources.sandbox import Sandbox
from ...watch.sequence_files import representative_file
from ...watch.versions import FileVersions
from .cache import BackgroundCache

ROLES = (
    Role.BEAUTY,
    Role.ALBEDO,
    Role.EMISSION,
    Role.DEPTH,
    Role.NORMAL,
    Role.POSITION,
    Role.VELOCITY,
    Role.OCCLUSION,
    Role.OBJECT_ID,
    Role.MATERIAL_ID,
    Role.UV,
)
"""The roles that a layer of a render can have."""

_KEPT, _KEPT_IDS = 256, 3
"""Overviews, and pictures of ids, that are kept: one overview is a few texts, the ids of a frame are a picture."""

ChosenLayers = Mapping[str, str]
"""Layers that the user chose, by role."""

_Key = tuple[str, str, tuple[tuple[str, str], ...]]
"""Path, version of the file, and chosen layers."""


class OverviewPending(InputError):
    """A render is still being read. `ready` says when it makes sense to ask again."""

    def __init__(self, path: str, ready: Callable[[], bool]) -> None:
        super().__init__(translate("{path}: is still being read: wait a moment", path=path))
        self.ready = ready


class RenderOverviews:
    """The contents of renders. Never waits for a file."""

    def __init__(self, sandbox: Sandbox) -> None:
        self._sandbox, self._versions = sandbox, FileVersions(sandbox)
        self._overviews: BackgroundCache[_Key, tuple[RenderOverview | str, Render | str]] = BackgroundCache(
            "renders", self._read_overview, _KEPT
        )
        self._ids: BackgroundCache[tuple[str, str, str], IdMap | str] = BackgroundCache(
            "mattes", self._read_ids, _KEPT_IDS, 1
        )

    def overview(self, path: Path, named: ChosenLayers = MappingProxyType({})) -> RenderOverview | str | None:
        """The contents of a render; a sentence if it cannot be read, None while it is being read."""
        path = representative_file(path, sandbox=self._sandbox)
        version, fault = self._versions.of(path)
        if fault:
            return fault
        overview = self._overviews.get(_key(str(path), version, named))
        return overview and overview[0]

    def describe_render(self, path: str, named: ChosenLayers) -> Render:
        """The contents of a render, for the compiler. Raises Pending, and InputError for a file that cannot be read."""
        key = _key(path, fingerprint(path, sandbox=self._sandbox), named)
        entry = self._overviews.get(key)
        if entry is None:
            raise OverviewPending(path, lambda: self._overviews.get(key) is not None)
        if isinstance(entry[1], str):
            raise InputError(entry[1])
        return entry[1]

    def ids(self, path: Path, matte: Matte) -> IdMap | str | None:
        """The object at each pixel (cryptomatte); a sentence if it is unknown, None while it is being read."""
        path = representative_file(path, sandbox=self._sandbox)
        version, fault = self._versions.of(path)
        return fault or self._ids.get((str(path), version, matte.layers[0]))

    @property
    def is_busy(self) -> bool:
        """True while a file is being read."""
        return self._overviews.is_busy or self._ids.is_busy

    def close(self) -> None:
        """End the threads."""
        self._overviews.close()
        self._ids.close()

    # --- in threads ------------------------------------------------------------------------------------------------

    def _read_overview(self, key: _Key) -> tuple[RenderOverview | str, Render | str]:
        path, _, named = key
        try:
            contents = summarize_render(
                path, ROLES, {Role(role): layer for role, layer in named}, sandbox=self._sandbox
            )
        except HalationError as fault:
            return str(fault), str(fault)
        except Exception as fault:
            message = translate("{path}: cannot be read ({fault})", path=path, fault=fault)
            return message, message
        try:
            return contents, read_render(path, dict(named), sandbox=self._sandbox)
        except HalationError as fault:
            return contents, str(fault)

    def _read_ids(self, key: tuple[str, str, str]) -> IdMap | str:
        path, _, layer = key
        try:
            return read_id_map(path, layer, sandbox=self._sandbox)
        except HalationError as fault:
            return str(fault)


def _key(path: str, version: str, named: ChosenLayers) -> _Key:
    return path, version, tuple(sorted((role, layer) for role, layer in named.items() if layer))
