"""What either form of passes takes on a device that no table knows: measured at the first start, then kept in a file.

The file is in the cache folder of the user, one for each renderer and version of its driver. All processes go by it, so
that frames which several of them render, today and tomorrow, are of one form.
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
TURNS = 5
ENOUGH_SECONDS = 0.1
"""Seconds of passes after which no further turn is taken: what is slow can be told apart sooner."""

VERSION = 1
"""Goes up when other passes are measured, or the compiler makes something else of them."""


def load_or_measure(device: Device, folder: Path | None = None, *, sandbox: Sandbox) -> FormTimings | None:
    """What is kept of the device; else it is measured and kept. None where it cannot be kept.

    `folder` is by default that of the user.
    """
    path = (folder or _find_folder()) / f"{_hash_device(device)}.json"
    if sandbox.fault(path):
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
    except (OSError, HalationError):
        return None
    return stored or measured


def measure_forms(device: Device, size: Size = SIZE, turns: int = TURNS) -> FormTimings:
    """Seconds that noise, which is arithmetic, and its blur, which is reading, take in either form.

    Both forms take turns, after a first one that counts for nothing: it compiles, and wakes the device up.
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
                except HalationError:  # the driver refuses these passes: the others are left
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


def _find_folder() -> Path:
    import platformdirs

    return platformdirs.user_cache_path("halation", appauthor=False) / "passes"


def _hash_device(device: Device) -> str:
    identity = f"{VERSION}\0{device.target.renderer}\0{device.driver}"
    return blake2b(identity.encode(), digest_size=12).hexdigest()


def _read_timings(path: Path, sandbox: Sandbox) -> FormTimings | None:
    try:
        record = json.loads(read_text(path, sandbox=sandbox))
        return FormTimings(float(record["compute"]), float(record["fragment"]))
    except (HalationError, ValueError, KeyError, TypeError):  # it is not there, or nobody can read it: measure again
        return None
