"""Color management: a config of OpenColorIO, and the working space, in which pictures are between nodes.

The config is the one that the graph names, then the one that the environment variable OCIO names, then OpenColorIO's
built-in one. The working space is the one that the graph names, else linear Rec.709.

- Most graphs have no color settings. Then sRGB files are decoded by a table and OpenColorIO is not loaded (`is_plain`):
  importing it takes longer than rendering a small graph.
- A name is looked up in the config first, as name, alias or role, then in OpenColorIO's studio config, which has the
  spaces of cameras. A space of the studio config is converted through ACES2065-1, for which configs have a role
  (aces_interchange), so it works with every config that has that role (`ColorSpace.own`).
- Color is linear between nodes: a working space that is not linear is an error, since light is added and blurred there.
- Errors name the source of the fault: the graph (GraphError) for its config, the environment (UsageError) for $OCIO.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from functools import cache, cached_property, lru_cache
from pathlib import Path
from typing import Any

from halation.nodes import WORKING_SPACE, ColorSettings
from halation.nodes.color._spaces import SPACES
from msgspec import Struct

from ..errors import GraphError, HalationError, InputError, UsageError
from ..resources.input_files import content_hash, find_special_kind
from ..resources.library_names import is_utf8
from ..resources.sandbox import UNRESTRICTED, Sandbox
from ..resources.suggestions import find_near_names
from .config_files import find_config_fault, open_config

_MOST_LISTED = 12
"""Names in a message: about three lines."""

BUILT_IN = "ocio://default"
LINEAR_REC709 = "lin_rec709_scene"
_STUDIO = "ocio://studio-config-latest"
_DEFAULT_NAMES = frozenset({"", "linear rec709", LINEAR_REC709, "linear rec.709 (srgb)"})
_BUILT_IN_MARK = "ocio://"
_DATA_NAMES = ("raw", "data", "unknown", "none")


class OcioColorSpace(Struct, frozen=True):
    """A color space of a config; `own` is False for one of the studio config. `data` means numbers without color."""

    name: str
    own: bool
    data: bool = False


class ColorManager:
    """A config, and the working space in it.

    Its facts are read on first use, which loads the config; that raises GraphError or UsageError if it cannot be read.
    """

    def __init__(
        self,
        source: str,
        version: str,
        chosen: bool,
        fault: type[HalationError],
        working: str,
        sandbox: Sandbox,
    ) -> None:
        self.source, self.is_chosen, self._sandbox = source, chosen, sandbox
        """The source of the config, and whether the user chose it."""
        self.mark = f"{source} {version} {working}"
        """A mark that changes when the config or the working space does."""
        self._error, self._working_name = fault, working
        self._files: Any = None
        """Opens the tables of the graph's own config."""
        self._spaces_by_name: dict[str, OcioColorSpace | None] = {}

    @property
    def is_plain(self) -> bool:
        """True for linear Rec.709 in the built-in config: reading sRGB then needs no library."""
        return not self.is_chosen and self._working_name.casefold() in _DEFAULT_NAMES

    @property
    def where(self) -> str:
        """The name of the config in messages."""
        return f"$OCIO: {self.source}" if self._error is UsageError and self.is_chosen else self.source

    @property
    def digest(self) -> str:
        """A key that is equal for equal color management: "" for linear Rec.709 in the built-in config."""
        if self.is_plain:
            return ""
        if self.source.startswith(_BUILT_IN_MARK):
            return f"{self.source} {self._working_name}"
        try:
            return f"{content_hash(self.source, self._sandbox)} {self._working_name}"
        except InputError:
            return f"{self.source} {self._working_name}"

    @cached_property
    def config(self) -> Any:
        """The config of displays, views, looks and file rules."""
        return self._read_config(self.source)

    @cached_property
    def spaces(self) -> Any:
        """The config of color spaces: without a chosen config the studio one, since it has the spaces of cameras
        too."""
        return self.config if self.is_chosen else load_studio_config()

    @cached_property
    def working(self) -> OcioColorSpace:
        """The working space. Raises GraphError if it is unknown."""
        if self._working_name.casefold() not in _DEFAULT_NAMES:
            space = self.find(self._working_name)
            if space is None or space.data:
                fault = "holds numbers, not color" if space else "is unknown"
                raise GraphError(
                    f"settings.color.working: '{self._working_name}' {fault}{self.suggest_space(self._working_name)}"
                )
        else:
            space = self.find(LINEAR_REC709) or OcioColorSpace(LINEAR_REC709, False)
        if not space.own and self.is_chosen:
            self._check_bridge(space)
        config = self.spaces if space.own else load_studio_config()
        reference = load_ocio().REFERENCE_SPACE_SCENE
        if not self._run(lambda: config.isColorSpaceLinear(space.name, reference)):
            raise GraphError(
                f"settings.color.working: '{self._working_name or space.name}' is not scene-linear: light is added and "
                "blurred in the working space; choose one such as ACEScg"
            )
        return space

    @cached_property
    def header_name(self) -> str:
        """The name of the working space in a header."""
        return self.find_header_name(self.working)

    def find(self, name: str) -> OcioColorSpace | None:
        """A space by name, alias or role, in any case, or by its name in nodes; None if it is unknown."""
        if name.casefold() == WORKING_SPACE:
            return self.working
        if name not in self._spaces_by_name:
            self._spaces_by_name[name] = self._find(name)
        return self._spaces_by_name[name]

    def _find(self, name: str) -> OcioColorSpace | None:
        if space := self.spaces.getColorSpace(name):
            return OcioColorSpace(space.getName(), True, space.isData())
        if name.casefold() in _DATA_NAMES:
            return OcioColorSpace(name, True, True)
        studio_space = load_studio_config().getColorSpace(SPACES.get(name.casefold(), name))  # type: ignore[arg-type]
        if not studio_space:
            return None
        for alias in (studio_space.getName(), *studio_space.getAliases()):
            if space := self.spaces.getColorSpace(alias):
                return OcioColorSpace(space.getName(), True, space.isData())
        return self._find_equal_space(studio_space) or OcioColorSpace(
            studio_space.getName(), False, studio_space.isData()
        )

    def list_spaces(self) -> tuple[str, ...]:
        """The color spaces of the config that pictures can have."""
        api = load_ocio()
        kinds = (api.SEARCH_REFERENCE_SPACE_SCENE, api.SEARCH_REFERENCE_SPACE_DISPLAY)
        return tuple(name for kind in kinds for name in self.spaces.getColorSpaceNames(kind, api.COLORSPACE_ACTIVE))

    def suggest_space(self, name: str) -> str:
        """The rest of a sentence about an unknown space."""
        names = {word.casefold(): word for word in (*SPACES, *self.spaces.getRoleNames(), *self.list_spaces())}
        close_names = find_near_names(name.casefold(), names)
        start = f"did you mean '{names[close_names[0]]}'? It" if close_names else "it"
        return f": {start} must be a color space or role of {self.where}, such as {_shorten_list(self.list_spaces())}"

    def find_encoding(self, space: OcioColorSpace) -> str:
        """What the config says of the numbers of a space: `scene-linear`, `log`, `sdr-video`, ...; "" for nothing."""
        return str((self.spaces if space.own else load_studio_config()).getColorSpace(space.name).getEncoding())

    def make_processor(self, source: OcioColorSpace, target: OcioColorSpace) -> Any:
        """The processor from one space to another. Raises GraphError or UsageError if the config has no conversion."""
        if source.data or target.data or source == target:
            return self._run(lambda: load_ocio().Config.CreateRaw().getProcessor(load_ocio().MatrixTransform()))
        return self._run(lambda: self._make_processor(source, target))

    def find_header_name(self, space: OcioColorSpace) -> str:
        """The name of a space in a header: its interchange name if it has one."""
        config_space = (self.spaces if space.own else load_studio_config()).getColorSpace(space.name)
        interop_name = str(getattr(config_space, "getInteropID", str)() or "") if config_space else ""
        return interop_name or space.name

    def bridge_to_views(self) -> tuple[Any, str]:
        """The transform from the working space to the config of the views, and the space there."""
        group, working = load_ocio().GroupTransform(), self.working
        if space := self.config.getColorSpace(working.name) if working.own or not self.is_chosen else None:
            return group, space.getName()
        anchor = self.config.getColorSpace("scene_linear") or self.config.getColorSpace("aces_interchange")
        inside = OcioColorSpace(anchor.getName(), True)
        group.appendTransform(self.make_processor(working, inside).createGroupTransform())
        return group, inside.name

    def attempt(self, make: Any) -> Any:
        """The result of a call of OpenColorIO; its complaint about the config is raised as a sentence."""
        return self._run(make)

    # --- parts -------------------------------------------------------------------------------------------------------

    def _make_processor(self, source: OcioColorSpace, target: OcioColorSpace) -> Any:
        if source.own == target.own:
            return (self.spaces if source.own else load_studio_config()).getProcessor(source.name, target.name)
        first, second = (self.spaces if space.own else load_studio_config() for space in (source, target))
        return load_ocio().Config.GetProcessorFromConfigs(first, source.name, second, target.name)

    def _find_equal_space(self, studio_space: Any) -> OcioColorSpace | None:
        """A space of the config that computes the same under another name, if OpenColorIO finds one."""
        if not self.is_chosen or studio_space.isData():
            return None
        try:
            name = load_ocio().Config.IdentifyBuiltinColorSpace(
                self.spaces, load_studio_config(), studio_space.getName()
            )
        except ocio_errors():
            return None
        return OcioColorSpace(name, True) if name else None

    def _check_bridge(self, space: OcioColorSpace) -> None:
        names = self.list_spaces()
        try:
            self._make_processor(space, OcioColorSpace(names[0], True))
        except (*ocio_errors(), IndexError):
            raise self._error(
                f"{self.where}: has neither '{space.name}' nor the role aces_interchange that would lead to it: set "
                f"settings.color.working to a space or role of this config, such as {_shorten_list(names)}"
            ) from None

    def _run(self, make: Any) -> Any:
        try:
            return make()
        except ocio_errors() as error:
            faults: list[str] = self._files.faults if self._files else []
            raise self._error(f"{self.where}: {faults[-1] if faults else describe_ocio_error(error)}") from error

    def _read_config(self, source: str) -> Any:
        """Read a config file or a built-in config. A config of a graph is read inside of the sandbox; that of `$OCIO`
        is the user's own and may read all files.
        """
        if not source.startswith("ocio://") and (reason := self._sandbox.find_read_fault(source)):
            raise self._error(f"{self._describe_source(source)}: {reason}")
        if not source.startswith("ocio://") and not (path := Path(source)).is_file():
            if path.exists() and (kind := find_special_kind(path.stat().st_mode)):
                raise self._error(f"{self._describe_source(source)}: is {kind}, not a file: name a regular file")
            folder = path.parent
            near = find_near_names(path.name, _list_names(folder))
            raise self._error(f"{self._describe_source(source)}: there is no such color config{_suggest(near)}")
        if not is_utf8(source):  # its tables lie beside it, so links must be resolved first
            raise self._error(f"{self._describe_source(source)}: no color config can have such a name: it is not UTF-8")
        try:
            if source.startswith("ocio://"):
                return load_builtin_config(source)
            if self._error is UsageError:  # the config of $OCIO, which the user trusts
                config = load_ocio().Config.CreateFromFile(source)
                if not Path(source).read_bytes().isascii():
                    config.serialize()  # names that are not UTF-8 are found here, not on first use
                return config
            config, self._files = open_config(load_ocio(), source, self._sandbox)
            if self._files and (reason := find_config_fault(config, self._sandbox)):
                raise self._error(f"{self._describe_source(source)}: {reason}")
            return config
        except InputError as error:
            raise self._error(f"{self._describe_source(source)}: {str(error).removeprefix(f'{source}: ')}") from None
        except ocio_errors() as error:
            reason = f"is no color config that can be read: {describe_ocio_error(error)}"
            if source.startswith("ocio://"):
                near = find_near_names(source, list_builtin_configs())
                reason = f"there is no such built-in config{_suggest(near)}"
            raise self._error(f"{self._describe_source(source)}: {reason}") from None

    def _describe_source(self, source: str) -> str:
        return f"$OCIO: {source}" if self._error is UsageError else f"settings.color.config: {source}"


def get_color_manager(color: ColorSettings, sandbox: Sandbox) -> ColorManager:
    """The color manager for these settings, in which the config is a resolved path. It is the same one as long as the
    file does not change.

    A config that $OCIO names is the user's and may lie outside of the sandbox.
    """
    environment_config = os.environ.get("OCIO", "").strip()
    source = color.config or environment_config or BUILT_IN
    fault = GraphError if color.config or not environment_config else UsageError
    reach = sandbox if color.config else UNRESTRICTED
    is_chosen = bool(color.config or environment_config)
    return _make_manager(source, _config_version(source, reach), is_chosen, fault, color.working, reach)


def get_default_color_manager() -> ColorManager:
    """The color manager for graphs without color settings: for the config that $OCIO names, else the built-in one."""
    return get_color_manager(ColorSettings(), UNRESTRICTED)


@lru_cache(maxsize=16)
def _make_manager(
    source: str, version: str, chosen: bool, fault: type[HalationError], working: str, sandbox: Sandbox
) -> ColorManager:
    return ColorManager(source, version, chosen, fault, working, sandbox)


def _config_version(source: str, sandbox: Sandbox) -> str:
    if source.startswith("ocio://"):
        return ""
    if sandbox.find_read_fault(source):
        return "outside"
    try:
        status = Path(source).stat()
    except (OSError, ValueError):
        return "gone"
    return f"{status.st_mtime_ns}:{status.st_size}"


@cache
def load_ocio() -> Any:
    """The module of OpenColorIO, which has no types. It is quiet: errors become sentences of Halation."""
    import PyOpenColorIO

    api: Any = PyOpenColorIO
    if not os.environ.get("OCIO_LOGGING_LEVEL"):
        api.SetLoggingLevel(api.LOGGING_LEVEL_NONE)
    return api


def ocio_errors() -> tuple[type[Exception], ...]:
    """The exception that OpenColorIO raises."""
    return load_ocio().Exception, load_ocio().ExceptionMissingFile, UnicodeDecodeError


@cache
def load_builtin_config(name: str) -> Any:
    """A config that comes with OpenColorIO, such as `ocio://default`."""
    return load_ocio().Config.CreateFromBuiltinConfig(name)


def load_studio_config() -> Any:
    """The config whose names are used for color changes: it has the spaces of cameras."""
    return load_builtin_config(_STUDIO)


def list_builtin_configs() -> tuple[str, ...]:
    """The configs that come with OpenColorIO, the default first."""
    names = [f"ocio://{name}" for name, *_ in load_ocio().BuiltinConfigRegistry().getBuiltinConfigs()]
    return (BUILT_IN, "ocio://cg-config-latest", _STUDIO, *names)


def describe_ocio_error(error: Exception) -> str:
    """The first line of a complaint of OpenColorIO, without its period."""
    is_quoting = isinstance(error, UnicodeDecodeError)  # the complaint quotes a file that is not UTF-8
    text = error.object.decode("utf-8", "replace") if is_quoting else str(error)
    lines = text.strip().splitlines()
    return lines[0].rstrip(".") if lines else "OpenColorIO gave no reason"


def _shorten_list(names: Iterable[str]) -> str:
    listed = list(names)
    return ", ".join(listed[:_MOST_LISTED]) + (
        f" and {len(listed) - _MOST_LISTED} more" if len(listed) > _MOST_LISTED else ""
    )


def _suggest(near: list[str]) -> str:
    return f"; did you mean '{near[0]}'?" if near else ": check the name"


def _list_names(folder: Path) -> list[str]:
    try:
        return [item.name for item in folder.iterdir()]
    except OSError:
        return []
