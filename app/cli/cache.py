"""`halation cache`: carries the programs that the driver has compiled to another machine."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import UsageError
from ..resources.sandbox import read_process_sandbox
from .options import AsJson
from .outcome import print_json, write_count

_Export = Annotated[
    Path | None, typer.Option("--export", metavar="FILE.zip", help="Write the cache of the driver into this file.")
]
_Import = Annotated[
    Path | None, typer.Option("--import", metavar="FILE.zip", help="Add what --export has written to the cache.")
]


def cache(export_path: _Export = None, import_path: _Import = None, as_json: AsJson = False) -> int:
    """Save or restore compiled shader programs.

    They are those of Mesa's software rasterizer. With a full cache, first frames take half the time or less. A file
    fits the driver and the processor on which it was made. It holds machine code: import only what you have exported
    yourself.
    """
    from ..renderer import open_device
    from ..renderer.opengl.cache_archive import export_cache, import_cache

    path = export_path or import_path
    if path is None or (export_path and import_path):
        raise UsageError("give either --export FILE.zip or --import FILE.zip")
    sandbox = read_process_sandbox()
    count = (export_cache if export_path else import_cache)(path, open_device(sandbox=sandbox), sandbox=sandbox)
    if as_json:
        print_json({"exported" if export_path else "imported": count, "path": str(path)})
    else:
        print(f"{path}  {write_count(count, 'file')} {'exported' if export_path else 'imported'}")
    return 0
