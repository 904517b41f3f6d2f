"""The files that OpenColorIO reads: tables, and what tables and configs name. It is given bytes, and no paths to open.

A table in Academy Common LUT Format can refer to other files (`<Reference path="...">`), and a config names tables
through search paths and variables. So whatever such a file names is opened by `SandboxedFiles`, which OpenColorIO asks
in place of the disk. It checks the sandbox, and refuses what is no regular file: OpenColorIO would wait for a FIFO.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

from ..errors import InputError
from ..resources.input_files import check_file, fingerprint, open_file, read_bytes
from ..resources.sandbox import Sandbox

_ARCHIVE = b"PK"
"""How a zip file begins (PKWARE APPNOTE): OpenColorIO reads what an archive names from the archive alone."""

_PROLOG = 4096
"""Bytes in which the first "<" of an XML file is looked for: before it there may be white space only."""

_BLANK = b"\x00\t\n\r \xef\xbb\xbf\xfe\xff"
"""White space and marks of byte order (XML 1.0, section 2.3 and appendix F), with the zeros of UTF-16 and UTF-32."""

_NO_TABLE = b"no table"
"""What OpenColorIO is given in place of a file that it may not read."""

_NO_TEXT = "\ufffd"
"""What Python decodes bytes to that are not UTF-8."""


def open_config(api: Any, source: str, sandbox: Sandbox) -> tuple[Any, Any]:
    """The config in a file, and what opens its tables: keep that for as long as the config, which does not.

    Without the second, None for an archive, OpenColorIO opens files itself. Raises InputError for a file that cannot be
    read, OpenColorIO's Exception for no config.
    """
    check_file(source, sandbox)
    content = read_bytes(source, sandbox)
    if content.startswith(_ARCHIVE):
        return api.Config.CreateFromFile(source), None
    text = content.decode(errors="replace")
    config = api.Config.CreateFromStream(text)
    if _NO_TEXT in text and _NO_TEXT in config.serialize():  # which leaves out comments
        raise InputError(f"{source}: has names that are not UTF-8: save it as UTF-8")
    config.setWorkingDir(str(Path(source).parent))
    files = make_sandboxed_files(sandbox)
    config.setConfigIOProxy(files)
    return config, files


def find_config_fault(config: Any, sandbox: Sandbox) -> str:
    """Why a config may not be used, as the rest of a sentence about it; "" if it may be."""
    for table in _find_tables(config) if sandbox.root else ():
        if reason := sandbox.fault(table):
            return f"its table {table} {reason}"
    return ""


def may_name_files(path: str, sandbox: Sandbox) -> bool:
    """True for a table that may refer to other files, whatever its name is: one that begins like XML.

    Raises InputError for what is no regular file; OSError.
    """
    with open_file(path, sandbox) as file:
        return file.read(_PROLOG).lstrip(_BLANK)[:1] in (b"<", b"")


def make_sandboxed_files(sandbox: Sandbox) -> Any:
    """The files of the disk as OpenColorIO may read them. `faults` are sentences about those that it may not."""
    return _define_sandboxed_files()(sandbox)


@cache
def _define_sandboxed_files() -> type[Any]:
    """The class, which needs OpenColorIO to be loaded."""
    import PyOpenColorIO

    api: Any = PyOpenColorIO

    class SandboxedFiles(api.PyConfigIOProxy):
        """What OpenColorIO asks in place of the disk."""

        def __init__(self, sandbox: Sandbox) -> None:
            super().__init__()
            self._sandbox = sandbox
            self.faults: list[str] = []

        def getConfigData(self) -> str:
            """The text of a config, which is given as it is."""
            return ""

        def getFastLutFileHash(self, path: str) -> str:
            """A mark of the version of a file; "" for one that is not there or may not be read."""
            try:
                is_file = bool(self._sandbox.fault(path)) or (Path(path).exists() and not Path(path).is_dir())
                return fingerprint(path, self._sandbox) if is_file else ""
            except (OSError, ValueError):
                return ""
            except InputError as fault:
                self.faults.append(str(fault))
                return ""

        def getLutData(self, path: str) -> list[int]:
            """The bytes of a file; never none, and nothing is raised: OpenColorIO 2.6 would open the file itself."""
            try:
                return list(read_bytes(path, self._sandbox) or _NO_TABLE)
            except InputError as fault:
                self.faults.append(str(fault))
                return list(_NO_TABLE)

    return SandboxedFiles


def _find_tables(config: Any) -> Iterator[str]:
    """The tables that its color spaces, looks, views and named transforms name, where they would be found."""
    import PyOpenColorIO

    api: Any = PyOpenColorIO
    both, context = (api.COLORSPACE_DIR_TO_REFERENCE, api.COLORSPACE_DIR_FROM_REFERENCE), config.getCurrentContext()
    spaces = config.getColorSpaces(api.SEARCH_REFERENCE_SPACE_ALL, api.COLORSPACE_ALL)
    named_transforms = config.getNamedTransforms(api.NAMEDTRANSFORM_ALL)
    ways = (api.TRANSFORM_DIR_FORWARD, api.TRANSFORM_DIR_INVERSE)
    views = (api.VIEWTRANSFORM_DIR_TO_REFERENCE, api.VIEWTRANSFORM_DIR_FROM_REFERENCE)
    transforms = [space.getTransform(way) for space in spaces for way in both]
    transforms += [look.getTransform() for look in config.getLooks()]
    transforms += [look.getInverseTransform() for look in config.getLooks()]
    transforms += [view.getTransform(way) for view in config.getViewTransforms() for way in views]
    transforms += [transform.getTransform(way) for transform in named_transforms for way in ways]
    for source in dict.fromkeys(source for one in transforms for source in _find_sources(api, one)):
        try:
            yield context.resolveFileLocation(source)
        except (api.Exception, api.ExceptionMissingFile):
            yield str(Path(config.getWorkingDir(), context.resolveStringVar(source)))


def _find_sources(api: Any, transform: Any) -> Iterator[str]:
    """The names of files in a transform, groups looked into."""
    if isinstance(transform, api.FileTransform):
        yield transform.getSrc()
    elif isinstance(transform, api.GroupTransform):
        for part in transform:
            yield from _find_sources(api, part)
