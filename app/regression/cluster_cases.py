"""Runs cases on the workers of a cluster. Graphs and goldens go by path: all machines see the same folders."""

from __future__ import annotations

import json
import os
from collections.abc import Generator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast
from uuid import uuid4

import msgspec
from msgspec.structs import replace

from ..cluster.connection import iterate_finished
from ..cluster.render_process import ProcessLimits, share_cores
from ..cluster.worker_task import find_worker, make_cancel_check, open_pool, read_memory_limit, read_version
from ..cluster.workers import WorkerRoster
from ..errors import RenderError
from ..resources.typed_data import convert_data
from .case_runner import RunOptions
from .cases import Case
from .parallel import run_in_worker
from .results import CaseResult, Outcome

if TYPE_CHECKING:
    from ..cluster.connection import Client

_TRIES = 3
"""How often a case may end its process: as often as a frame."""


def share_cases(
    client: Client, address: str, cases: Sequence[Case], options: RunOptions, timeout: float
) -> Generator[CaseResult, None, None]:
    """Run cases on the workers of a cluster; the results as they come. Raises RenderError if no worker can.

    `timeout` is how many seconds a pass of a code node may take, 0 for no limit.
    """
    roster = WorkerRoster(wants_gpu=False)
    roster.update(cast("Mapping[str, Mapping[str, Any]]", client.scheduler_info(n_workers=-1)["workers"]))
    versions = client.run(read_version, on_error="return")
    list(roster.check_versions(cast("Mapping[str, object]", versions)))
    if not roster.usable:
        reasons = "; ".join(f"{worker}: {reason}" for worker, reason in roster.refusals.items())
        raise RenderError(f"--cluster {address}: no worker can run the cases: {reasons or 'there is none'}")
    slots, places = roster.count_slots_by_machine(), roster.choose(())
    texts = [_write_case(_make_absolute(case), options, slots, timeout) for case in cases]
    names = [f"halation-case-{uuid4().hex[:8]}-{number}" for number in range(len(cases))]
    futures = client.map(run_suite_case, texts, key=names, pure=False, workers=places)
    cases_by_name = dict(zip(names, cases, strict=True))
    try:
        for future in iterate_finished(client, futures):
            yield _read_result(cases_by_name[str(future.key)], future.result())
    finally:
        client.cancel(futures, force=True)


def run_suite_case(text: str) -> str:
    """Run one case in a warm process beside this worker. Text and result are JSON."""
    worker = find_worker()
    facts: Mapping[str, Any] = json.loads(text)
    kind = (bool(facts["options"]["deterministic"]), "cases", 0, str(facts["options"]["sandbox"]["root"]))
    death = ""
    for _ in range(_TRIES):
        with open_pool().lend_process(kind, share_cores(facts["slots"], worker.address)) as process:
            limits = ProcessLimits(facts["timeout"], resident=read_memory_limit(worker))
            answer = process.ask(text, lambda event: None, make_cancel_check(worker), limits)
        death = answer.death
        if not death:
            return json.dumps(answer.facts)
    return json.dumps({"death": death})


def run_case_text(line: str) -> dict[str, Any]:
    """Run the case in a line of `run_suite_case`, in this process; its result, ready for JSON."""
    facts = json.loads(line)
    case = convert_data(facts["case"], Case, hook=_read_path)
    options = convert_data(facts["options"], RunOptions, hook=_read_path)
    return cast("dict[str, Any]", msgspec.to_builtins(run_in_worker(case, options), enc_hook=str))


def _write_case(case: Case, options: RunOptions, slots: Mapping[str, int], timeout: float) -> str:
    options = replace(options, out=None if options.out is None else options.out.absolute())
    return json.dumps({"case": _plain(case), "options": _plain(options), "slots": slots, "timeout": timeout})


def _plain(item: object) -> object:
    return msgspec.to_builtins(item, enc_hook=str)


def _read_result(case: Case, text: str) -> CaseResult:
    facts = json.loads(text)
    if "death" in facts:
        return CaseResult(Outcome(case, "failed", f"on {_TRIES} tries: {facts['death']}"), "", True)
    loaded = convert_data(facts, CaseResult, hook=_read_path)
    return replace(loaded, outcome=replace(loaded.outcome, case=case))


def _read_path(kind: type, text: object) -> object:
    return kind(text)


def _make_absolute(case: Case) -> Case:
    """The case for a process that works in another folder."""
    return replace(
        case,
        graph=case.graph.absolute(),
        goldens=tuple(replace(golden, path=golden.path.absolute()) for golden in case.goldens),
        inputs={
            name: os.path.abspath(file) if isinstance(file, str | Path) else file  # noqa: PTH100 - links stay
            for name, file in case.inputs.items()
        },
    )
