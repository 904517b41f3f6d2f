"""How colors are managed: a config of OpenColorIO, and the space that pictures are in between nodes.

The config that a graph names comes first, then the one that the environment variable OCIO names, then the built-in one.
What a config does not know is looked up in OpenColorIO's own studio config and brought over through ACES2065-1.
"""

from __future__ import annotations

import difflib
import os
from collections.abc import Iterable
from functools import cache, cached_property, lru_cache
from hashlib import sha256
from pathlib import Path
from typing import Any

from halation.nodes import WORKING_SPACE, ColorSettings
from halation.nodes.color._spaces import SPACES
from msgspec import Struct

from ..errors import GraphError, HalationError, UsageError
from ..resources.sandbox import outside
from .config_files import config_fault

BUILT_IN = "ocio://default"
DEFAULT_COLOR = ColorSettings()
LINEAR_REC709 = "lin_rec709_scene"
_STUDIO = "ocio://studio-config-latest"
_DEFAULTS = frozenset({"", "linear rec709", LINEAR_REC709, "linear rec.709 (srgb)"})
_BUILT_IN_MARK = "ocio://"
_NUMBERS = ("raw", "data", "unknown", "none")


class Space(Struct, frozen=True):
    """A color space of a config; `own` is False for one of the studio config. `data` are numbers without color."""

    name: str
    own: bool
    data: bool = False


class Managed:
    """A config, and the working space in it.

    Asking for anything loads the config, which raises GraphError or UsageError where it cannot be read.
    """

    def __init__(self, source: str, chosen: bool, fault: type[HalationError], working: str) -> None:
        self.source, self.chosen = source, chosen
        """Where the config comes from, and whether anyone asked for it."""
        self._fault, self._wanted = fault, working
        self._found: dict[str, Space | None] = {}

    @property
    def plain(self) -> bool:
        """True for linear Rec.709 in the built-in config: reading sRGB needs no library then."""
        return not self.chosen and self._wanted.casefold() in _DEFAULTS

    @property
    def where(self) -> str:
        """What messages call the config."""
        return f"$OCIO: {self.source}" if self._fault is UsageError and self.chosen else self.source

    @cached_property
    def config(self) -> Any:
        """What displays, views, looks and file rules come from."""
        return self._read(self.source)

    @cached_property
    def spaces(self) -> Any:
        """What color spaces come from: where nobody chose a config the studio one, for it knows cameras too."""
        return self.config if self.chosen else studio()

    @cached_property
    def working(self) -> Space:
        """The space between nodes. Raises GraphError for one that nobody knows."""
        if self._wanted.casefold() not in _DEFAULTS:
            found = self.find(self._wanted)
            if found is None or found.data:
                fault = "holds numbers, not color" if found else "is unknown"
                raise GraphError(f"settings.color.working: '{self._wanted}' {fault}{self.hint(self._wanted)}")
        else:
            found = self.find(LINEAR_REC709) or Space(LINEAR_REC709, False)
        if not found.own and self.chosen:
            self._check_bridge(found)
        config = self.spaces if found.own else studio()
        if not config.isColorSpaceLinear(found.name, ocio().REFERENCE_SPACE_SCENE):
            raise GraphError(
                f"settings.color.working: '{self._wanted or found.name}' is not scene-linear: light is added and "
                "blurred in the working space; choose one such as ACEScg"
            )
        return found

    @cached_property
    def interop(self) -> str:
        """What a header calls the working space."""
        return self.header_name(self.working)

    def find(self, name: str) -> Space | None:
        """A space by name, alias or role in any case, or by the name that nodes call it; None if nobody knows it."""
        if name.casefold() == WORKING_SPACE:
            return self.working
        if name not in self._found:
            self._found[name] = self._find(name)
        return self._found[name]

    def _find(self, name: str) -> Space | None:
        if found := self.spaces.getColorSpace(name):
            return Space(found.getName(), True, found.isData())
        if name.casefold() in _NUMBERS:
            return Space(name, True, True)
        known = studio().getColorSpace(SPACES.get(name.casefold(), name))  # type: ignore[arg-type]
        if not known:
            return None
        for alias in (known.getName(), *known.getAliases()):
            if found := self.spaces.getColorSpace(alias):
                return Space(found.getName(), True, found.isData())
        return self._same(known) or Space(known.getName(), False, known.isData())

    def names(self) -> tuple[str, ...]:
        """The color spaces of the config that pictures can be in."""
        api = ocio()
        kinds = (api.SEARCH_REFERENCE_SPACE_SCENE, api.SEARCH_REFERENCE_SPACE_DISPLAY)
        return tuple(name for kind in kinds for name in self.spaces.getColorSpaceNames(kind, api.COLORSPACE_ACTIVE))

    def hint(self, name: str) -> str:
        """The rest of a sentence about a space that nobody knows."""
        known = {word.casefold(): word for word in (*SPACES, *self.spaces.getRoleNames(), *self.names())}
        near = difflib.get_close_matches(name.casefold(), known, 1, 0.5)
        some = f"did you mean '{known[near[0]]}'? It" if near else "it"
        return f": {some} must be a color space or role of {self.where}, such as {_few(self.names())}"

    def processor(self, source: Space, target: Space) -> Any:
        """From one space to another. Raises GraphError or UsageError where the config cannot say how."""
        if source.data or target.data or source == target:
            return self._made(lambda: ocio().Config.CreateRaw().getProcessor(ocio().MatrixTransform()))
        return self._made(lambda: self._between(source, target))

    def header_name(self, space: Space) -> str:
        """What a header calls a space: its interchange name if there is one."""
        found = (self.spaces if space.own else studio()).getColorSpace(space.name)
        said = str(getattr(found, "getInteropID", str)() or "") if found else ""
        return said or space.name

    def bridged(self) -> tuple[Any, str]:
        """What brings the working space into the config of the views, and the space there."""
        group, working = ocio().GroupTransform(), self.working
        if found := self.config.getColorSpace(working.name) if working.own or not self.chosen else None:
            return group, found.getName()
        anchor = self.config.getColorSpace("scene_linear") or self.config.getColorSpace("aces_interchange")
        inside = Space(anchor.getName(), True)
        group.appendTransform(self.processor(working, inside).createGroupTransform())
        return group, inside.name

    def attempt(self, make: Any) -> Any:
        """What OpenColorIO makes, or its complaint about the config as a sentence."""
        return self._made(make)

    # --- parts -------------------------------------------------------------------------------------------------------

    def _between(self, source: Space, target: Space) -> Any:
        if source.own == target.own:
            return (self.spaces if source.own else studio()).getProcessor(source.name, target.name)
        first, second = (self.spaces if space.own else studio() for space in (source, target))
        return ocio().Config.GetProcessorFromConfigs(first, source.name, second, target.name)

    def _same(self, known: Any) -> Space | None:
        """A space of the config that computes the same under another name, where OpenColorIO finds one."""
        if not self.chosen or known.isData():
            return None
        try:
            name = ocio().Config.IdentifyBuiltinColorSpace(self.spaces, studio(), known.getName())
        except faults():
            return None
        return Space(name, True) if name else None

    def _check_bridge(self, space: Space) -> None:
        names = self.names()
        try:
            self._between(space, Space(names[0], True))
        except (*faults(), IndexError):
            raise self._fault(
                f"{self.where}: has neither '{space.name}' nor the role aces_interchange that would lead to it: set "
                f"settings.color.working to a space or role of this config, such as {_few(names)}"
            ) from None

    def _made(self, make: Any) -> Any:
        try:
            return make()
        except faults() as error:
            raise self._fault(f"{self.where}: {_first_line(error)}") from error

    def _read(self, source: str) -> Any:
        theirs = self._fault is GraphError and not source.startswith("ocio://")
        if theirs and (said := outside(source)):
            raise self._fault(f"{self._said(source)}: {said}")
        if not source.startswith("ocio://") and not Path(source).is_file():
            folder = Path(source).parent
            near = difflib.get_close_matches(Path(source).name, _listed(folder), 1)
            raise self._fault(f"{self._said(source)}: there is no such color config{_suggested(near)}")
        try:
            found = builtin(source) if source.startswith("ocio://") else ocio().Config.CreateFromFile(source)
            if theirs and (said := config_fault(found)):
                raise self._fault(f"{self._said(source)}: {said}")
            return found
        except faults() as error:
            said = f"is no color config that can be read: {_first_line(error)}"
            if source.startswith("ocio://"):
                near = difflib.get_close_matches(source, builtin_configs(), 1, 0.3)
                said = f"there is no such built-in config{_suggested(near)}"
            raise self._fault(f"{self._said(source)}: {said}") from None

    def _said(self, source: str) -> str:
        return f"$OCIO: {source}" if self._fault is UsageError else f"settings.color.config: {source}"


def managed(color: ColorSettings = DEFAULT_COLOR) -> Managed:
    """How colors are managed by these settings, whose config is a path as it stands."""
    named = os.environ.get("OCIO", "").strip()
    source = color.config or named or BUILT_IN
    fault = GraphError if color.config or not named else UsageError
    return _managed(source, _version(source), bool(color.config or named), fault, color.working)


def color_mark(color: ColorSettings) -> str:
    """Changes when the config does."""
    found = managed(color)
    return f"{found.source} {_version(found.source)} {color.working}"


def color_digest(color: ColorSettings) -> str:
    """The same wherever colors are managed in the same way: "" for linear Rec.709 in the built-in config."""
    found = managed(color)
    if found.plain:
        return ""
    if found.source.startswith(_BUILT_IN_MARK):
        return f"{found.source} {color.working}"
    try:
        return f"{sha256(Path(found.source).read_bytes()).hexdigest()} {color.working}"
    except OSError:
        return f"{found.source} {color.working}"


@lru_cache(maxsize=16)
def _managed(source: str, version: str, chosen: bool, fault: type[HalationError], working: str) -> Managed:
    return Managed(source, chosen, fault, working)


def _version(source: str) -> str:
    if source.startswith("ocio://"):
        return ""
    try:
        status = Path(source).stat()
    except (OSError, ValueError):
        return "gone"
    return f"{status.st_mtime_ns}:{status.st_size}"


@cache
def ocio() -> Any:
    """OpenColorIO, which comes without types. It is quiet: what is wrong is said in sentences of ours."""
    import PyOpenColorIO

    api: Any = PyOpenColorIO
    if not os.environ.get("OCIO_LOGGING_LEVEL"):
        api.SetLoggingLevel(api.LOGGING_LEVEL_NONE)
    return api


def faults() -> tuple[type[Exception], ...]:
    """What OpenColorIO raises."""
    return ocio().Exception, ocio().ExceptionMissingFile


@cache
def builtin(name: str) -> Any:
    """A config that comes with OpenColorIO, such as `ocio://default`."""
    return ocio().Config.CreateFromBuiltinConfig(name)


def studio() -> Any:
    """The config whose names changes of space go by: it knows what cameras write."""
    return builtin(_STUDIO)


def builtin_configs() -> tuple[str, ...]:
    """The configs that come with OpenColorIO, the default first."""
    known = [f"ocio://{name}" for name, *_ in ocio().BuiltinConfigRegistry().getBuiltinConfigs()]
    return (BUILT_IN, "ocio://cg-config-latest", _STUDIO, *known)


def _first_line(error: Exception) -> str:
    lines = str(error).strip().splitlines()
    return lines[0].rstrip(".") if lines else "OpenColorIO gave no reason"


def _few(names: Iterable[str]) -> str:
    listed = list(names)
    return ", ".join(listed[:12]) + (f" and {len(listed) - 12} more" if len(listed) > 12 else "")


def _suggested(near: list[str]) -> str:
    return f"; did you mean '{near[0]}'?" if near else ": check the name"


def _listed(folder: Path) -> list[str]:
    try:
        return [item.name for item in folder.iterdir()]
    except OSError:
        return []
