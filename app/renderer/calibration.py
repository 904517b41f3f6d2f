"""Measures which form of passes is faster on a device that is in no table, at the first start, and stores the result.

The file is in the user's cache folder, one for each renderer and version of its driver. All processes use it, so that
frames which several processes render, today and tomorrow, have the same form.
"""

from __future__ import annotations

import json
import math
from hashlib import blake2b
from pathlib import Path
from typing import get_args

from halation.nodes import Size, catalogue
from msgspec.structs import asdict, replace

from ..compiler import Form, Request, compile_graph
from ..compiler.devices import FormTimings
from ..document.disk import read_text
from ..errors import HalationError
from ..graph import Graph, Port, Settings
from ..inputs.provider import MediaProvider
from ..resources.atomic_write import write_text_atomically
from ..resources.sandbox import UNRESTRICTED, Sandbox
from .device import Device
from .execution.runner import Runner

SIZE = (1024, 1024)
"""Large enough that a pass takes longer than to start it: a megapixel."""
TURNS = 5
"""How often each form is measured at most, in turn; the quickest counts. Chosen by judgement."""
ENOUGH_SECONDS = 0.1
"""Seconds of passes after which no further turn is taken: times of a slow device vary less. Chosen by judgement; a
start of the program should not take noticeably longer for it."""

VERSION = 1
"""Increased when other passes are measured, or when the compiler emits them differently."""

_PREFIX = f"{VERSION}-"
"""How the names of files begin that this version reads."""


def load_or_measure(device: Device, folder: Path | None = None, *, sandbox: Sandbox) -> FormTimings | None:
    """The stored times of a device, else new ones, which are stored. None where they cannot be stored.

    `folder` is by default that of the user.
    """
    path = (folder or timings_folder()) / f"{_PREFIX}{_hash_device(device)}.json"
    if sandbox.find_write_fault(path):
        return None
    if (stored := _read_timings(path, sandbox=sandbox)) is not None:
        return stored
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        measured = measure_forms(device)
        stored = _read_timings(path, sandbox=sandbox)  # another process may have been quicker
        if stored is None:
            record = {"renderer": device.target.renderer, "driver": device.driver, **asdict(measured)}
            write_text_atomically(path, json.dumps(record, indent=1) + "\n", sandbox=sandbox)
            _remove_others(path.parent)
    except (OSError, HalationError):
        return None
    return stored or measured


def measure_forms(device: Device, size: Size = SIZE, turns: int = TURNS) -> FormTimings:
    """Seconds that noise, which is arithmetic, and its blur, which is reading, take in either form.

    Both forms take turns. The first turn does not count: it compiles, and the device may still run at a low clock.
    """
    nodes = catalogue()
    graph = Graph(settings=Settings(size)).add("noise", nodes["noise"]()).add("blur", nodes["gaussian_blur"]())
    graph = graph.connect(Port("noise", "out"), Port("blur", "image"))
    request, pictures = Request({"out": Port("blur", "out")}), MediaProvider(sandbox=UNRESTRICTED)
    fastest, spent = dict.fromkeys(get_args(Form), math.inf), 0.0
    runners = {
        form: Runner(device.with_target(replace(device.target, form=form)), pictures.load_pixels, 0) for form in fastest
    }
    try:
        for turn in range(turns + 1):
            for form, runner in list(runners.items()):
                plan = compile_graph(graph, request, pictures, target=runner.device.target)
                try:
                    seconds = sum(pass_seconds for _, pass_seconds in runner.measure(plan))
                except HalationError:  # the driver refuses these passes: only the others are measured
                    fastest[form] = math.inf
                    runners.pop(form).close()
                    continue
                if turn:
                    fastest[form], spent = min(fastest[form], seconds), spent + seconds
            if spent > ENOUGH_SECONDS:
                break
    finally:
        for runner in runners.values():
            runner.close()
    return FormTimings(**fastest)


def timings_folder() -> Path:
    """The user's folder of measured times."""
    import platformdirs

    return platformdirs.user_cache_path("halation", appauthor=False) / "passes"


def _remove_others(folder: Path) -> None:
    """Delete the files of other versions of Halation, which no version uses for long."""
    for path in folder.glob("*.json"):
        if not path.name.startswith(_PREFIX):
            path.unlink(missing_ok=True)


def _hash_device(device: Device) -> str:
    identity = f"{VERSION}\0{device.target.renderer}\0{device.driver}"
    return blake2b(identity.encode(), digest_size=12).hexdigest()


def _read_timings(path: Path, sandbox: Sandbox) -> FormTimings | None:
    try:
        record = json.loads(read_text(path, sandbox=sandbox))
        return FormTimings(float(record["compute"]), float(record["fragment"]))
    except (HalationError, ValueError, KeyError, TypeError):  # it is not there, or nobody can read it: measure again
        return None
