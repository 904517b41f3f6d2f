"""The files that OpenColorIO reads: tables, and files that tables and configs name. OpenColorIO gets their bytes, not
their paths.

A table in Academy Common LUT Format can refer to other files (`<Reference path="...">`), and a config names tables
through search paths and variables. OpenColorIO asks `SandboxedFiles` for these files, instead of the disk. It checks
the sandbox and refuses special files, since OpenColorIO would wait for a FIFO.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Any

from ..errors import InputError
from ..resources.input_files import check_file, fingerprint, read_bytes
from ..resources.sandbox import Sandbox

_ARCHIVE = b"PK"
"""How a zip file begins (PKWARE APPNOTE). OpenColorIO reads the files that an archive names from the archive only."""

_PROLOG = 4096
"""Bytes in which the first "<" of an XML file is searched. Chosen by judgement: only white space may precede it."""

_BLANK = b"\x00\t\n\r \xef\xbb\xbf\xfe\xff"
"""White space and marks of byte order (XML 1.0, section 2.3 and appendix F), with the zeros of UTF-16 and UTF-32."""

_CINESPACE, _METADATA, _METADATA_END = b"CSPLUT", b"BEGIN METADATA", b"END METADATA"
"""How a Cinespace table begins, and the lines around its metadata (its reader in OpenColorIO 2.6)."""

MAX_NAMES = 2000
"""Names in a config, and thousands of letters. The largest public one, for ACES 1.0.3, has a fifth of both. Reading
takes time by the square of their number: 2,000 views half a second, 16,000 more than 25 s (OpenColorIO 2.6)."""

_NAMED = re.compile(r"!<(?:ColorSpace|View|Views|Look|NamedTransform|ViewTransform|Rule)>|^\s*- [^!\s]", re.MULTILINE)
_ALIASES = re.compile(r"aliases:\s*\[([^\]]*+)")
"""What has a name in a config: tagged entries, entries of lists that are words, and lists of aliases."""

_NO_TABLE = b"no table"
"""The text that OpenColorIO gets instead of a file that it may not read."""

_NO_TEXT = "\ufffd"
"""What Python decodes bytes to that are not UTF-8."""


def open_config(api: Any, source: str, sandbox: Sandbox) -> tuple[Any, Any]:
    """The config in a file, and the object that opens its tables. Keep that object as long as the config.

    The object is None for an archive, whose files OpenColorIO opens itself. Raises InputError for a file that cannot be
    read, OpenColorIO's Exception for a file that is no config.
    """
    check_file(source, sandbox)
    content = read_bytes(source, sandbox)
    if content.startswith(_ARCHIVE):
        _check_archive(source, content)
        return api.Config.CreateFromFile(source), None
    text = content.decode(errors="replace")
    _check_length(source, text)
    config = api.Config.CreateFromStream(text)
    if _NO_TEXT in text and _NO_TEXT in config.serialize():  # which leaves out comments
        raise InputError(f"{source}: has names that are not UTF-8: save it as UTF-8")
    config.setWorkingDir(str(Path(source).parent))
    files = make_sandboxed_files(sandbox)
    config.setConfigIOProxy(files)
    return config, files


def _check_length(source: str, text: str) -> None:
    """Raise InputError for a config with so many names that OpenColorIO, which compares each with all, never ends."""
    count = len(_NAMED.findall(text)) + sum(aliases.count(",") for aliases in _ALIASES.findall(text))
    if max(count, len(text) // 1000) > MAX_NAMES:
        raise InputError(f"{source}: has more than {MAX_NAMES:,} color spaces, views and looks: remove some")


def _check_archive(source: str, content: bytes) -> None:
    """Raise InputError for an archive with a config or a table that OpenColorIO would read for ever."""
    from zipfile import ZipFile  # slow to import, and few configs are archives

    from ..resources.archives import DAMAGED_ARCHIVE

    try:
        with ZipFile(BytesIO(content)) as archive:
            for entry in archive.infolist():
                with archive.open(entry) as file:
                    head = file.read(_PROLOG)
                    if entry.filename.endswith(".ocio"):
                        _check_length(source, (head + file.read(1000 * MAX_NAMES + 1)).decode(errors="replace"))
                    elif _is_cinespace(head) and (fault := find_table_fault(head + file.read())):
                        raise InputError(f"{source}: its table {entry.filename} {fault}")
    except DAMAGED_ARCHIVE as error:
        raise InputError(f"{source}: is no archive that can be read: {error}") from None


def check_table(path: str, sandbox: Sandbox) -> None:
    """Raise InputError for a table that OpenColorIO would read for ever, or that cannot be read."""
    is_cinespace = _is_cinespace(read_bytes(path, sandbox, _PROLOG))
    if is_cinespace and (fault := find_table_fault(read_bytes(path, sandbox))):
        raise InputError(f"{path}: {fault}")


def find_table_fault(content: bytes) -> str:
    """Why a table must not be given to OpenColorIO, as the rest of a sentence; "" if it may be given.

    OpenColorIO 2.6 waits for the end of the metadata of a Cinespace table, also behind the end of the file.
    """
    if not _is_cinespace(content):
        return ""
    begin = content.upper().find(_METADATA)
    ends = (line.removesuffix(b"\r") for line in content[begin:].split(b"\n"))
    return "has metadata without an end: add the line END METADATA" if begin >= 0 and _METADATA_END not in ends else ""


def _is_cinespace(head: bytes) -> bool:
    return head.lstrip().upper().startswith(_CINESPACE)


def find_config_fault(config: Any, sandbox: Sandbox) -> str:
    """Why a config may not be used, as the rest of a sentence; "" if it may be used."""
    for table in _find_tables(config) if sandbox.root else ():
        if reason := sandbox.find_read_fault(table):
            return f"its table {table} {reason}"
    return ""


def may_name_files(path: str, sandbox: Sandbox) -> bool:
    """True for a table that may refer to other files: one that begins like XML, whatever its name is.

    Raises InputError.
    """
    return read_bytes(path, sandbox, _PROLOG).lstrip(_BLANK)[:1] in (b"<", b"")


def make_sandboxed_files(sandbox: Sandbox) -> Any:
    """Opens files for OpenColorIO. `faults` are sentences about files that it may not read."""
    return _define_sandboxed_files()(sandbox)


@cache
def _define_sandboxed_files() -> type[Any]:
    """The class, which can be made only when OpenColorIO is loaded.

    OpenColorIO asks it for all files of a config, so that a config cannot name one outside of the sandbox. What it
    could not read is kept in `faults`, because an exception would not pass through the C++ code.
    """
    import PyOpenColorIO

    api: Any = PyOpenColorIO

    class SandboxedFiles(api.PyConfigIOProxy):
        """The interface by which OpenColorIO asks for files."""

        def __init__(self, sandbox: Sandbox) -> None:
            super().__init__()
            self._sandbox = sandbox
            self.faults: list[str] = []

        def getConfigData(self) -> str:
            """The text of a config, unchanged."""
            return ""

        def getFastLutFileHash(self, path: str) -> str:
            """A mark of the version of a file; "" for one that is not there or may not be read."""
            try:
                is_file = bool(self._sandbox.find_read_fault(path)) or (Path(path).exists() and not Path(path).is_dir())
                return fingerprint(path, self._sandbox) if is_file else ""
            except (OSError, ValueError):
                return ""
            except InputError as fault:
                self.faults.append(str(fault))
                return ""

        def getLutData(self, path: str) -> list[int]:
            """The bytes of a file. It never returns None and raises nothing, since OpenColorIO 2.6 would then open the
            file itself."""
            try:
                content = read_bytes(path, self._sandbox)
                if fault := find_table_fault(content):
                    raise InputError(f"{path}: {fault}")
                return list(content or _NO_TABLE)
            except InputError as fault:
                self.faults.append(str(fault))
                return list(_NO_TABLE)

    return SandboxedFiles


def _find_tables(config: Any) -> Iterator[str]:
    """The paths of the tables that color spaces, looks, views and named transforms of a config name."""
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
    for source in dict.fromkeys(source for transform in transforms for source in _find_sources(api, transform)):
        try:
            yield context.resolveFileLocation(source)
        except (api.Exception, api.ExceptionMissingFile):
            yield str(Path(config.getWorkingDir(), context.resolveStringVar(source)))


def _find_sources(api: Any, transform: Any) -> Iterator[str]:
    """The file names in a transform, also inside groups."""
    if isinstance(transform, api.FileTransform):
        yield transform.getSrc()
    elif isinstance(transform, api.GroupTransform):
        for part in transform:
            yield from _find_sources(api, part)
