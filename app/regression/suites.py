"""Reads suite files: the cases that they describe."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from ..errors import DocumentError, InputError, UsageError
from ..resources.folders import find_matches, walk_project
from ..resources.sandbox import Sandbox
from .cases import ENDING, METRICS, PER_PIXEL, Case
from .toml_tables import TomlTable, parse_toml, read_frames, read_goldens, read_inputs, read_size

_KEYS = (
    "graph",
    "inputs",
    "set",
    "frame",
    "frames",
    "size",
    "scale",
    "node",
    "golden",
    "metric",
    "tolerance",
    "failing",
    "precision",
    "view",
    "error",
    "allow",
    "skip",
)
_EXCEPTIONS = ("nonfinite", "black")


def find_suites(paths: Iterable[Path]) -> tuple[Path, ...]:
    """Suite files: those named, and those below folders. Raises UsageError where there is none."""
    suites: dict[Path, None] = {}
    for path in paths:
        if path.is_dir():
            files = sorted(item for item in walk_project(path) if item.name.endswith(ENDING))
            if not files:
                raise UsageError(f"{path}: there is no suite in this folder; the name of one ends in {ENDING}")
            suites.update(dict.fromkeys(files))
        elif not path.exists():
            raise UsageError(f"{path}: there is no such file or folder")
        elif not path.name.endswith(ENDING):
            raise UsageError(f"{path}: this is no suite: the name of one ends in {ENDING}")
        else:
            suites[path] = None
    return tuple(suites)


def load_suite(path: Path, sandbox: Sandbox) -> tuple[Case, ...]:
    """The cases of a file, in its order. Raises DocumentError that names the file and the key at fault."""
    tree = TomlTable(str(path), "", parse_toml(path, sandbox=sandbox))
    tree.refuse_other_keys(("defaults", "cases"))
    defaults = tree.read_table("defaults")
    defaults.refuse_other_keys(tuple(name for name in _KEYS if name not in ("error", "skip")))
    cases = tree.read_table("cases")
    if not cases.items:
        raise DocumentError(str(path), "cases", 'there is no case: begin one with [cases.NAME] and graph = "FILE"')
    cases_by_name: dict[str, Case] = {}
    for name in cases.items:
        for case in _read_cases(path, name, cases.read_table(name), defaults, sandbox):
            if case.name in cases_by_name:
                raise DocumentError(str(path), f"cases.{name}", f"there are two cases '{case.name}'; rename one")
            cases_by_name[case.name] = case
    _check_goldens(path, cases_by_name.values())
    return tuple(cases_by_name.values())


def _read_cases(path: Path, name: str, own: TomlTable, defaults: TomlTable, sandbox: Sandbox) -> Iterator[Case]:
    """The case of a table; several where the name of its graph has wildcards."""
    own.refuse_other_keys(_KEYS)
    merged = own.merge_over(defaults)
    pattern = merged.read_text("graph")
    if not pattern:
        raise merged.make_fault("graph", 'which graph? Write graph = "FILE", relative to this file')
    if not any(sign in pattern for sign in "*?["):
        yield _read_case(path, name, path.parent / pattern, own, merged)
        return
    try:
        graphs = [Path(item) for item in find_matches(str(path.parent / pattern), sandbox) if Path(item).is_file()]
    except InputError as fault:
        raise merged.make_fault("graph", str(fault)) from None
    if not graphs:
        raise merged.make_fault("graph", f"no file is called {pattern}")
    for graph in graphs:
        yield _read_case(path, f"{name}/{graph.stem}", graph, own, merged)


def _read_case(path: Path, name: str, graph: Path, own: TomlTable, merged: TomlTable) -> Case:
    """Read one case: `own` is its table, `merged` the same over the defaults of the suite.

    A case with a metric of its own does not take the suite's tolerance: that number belongs to the suite's metric.
    """
    if "metric" in own.items and "tolerance" not in own.items:
        merged = merged.drop_key("tolerance")
    metric = merged.read_choice("metric", tuple(METRICS), "max_rel")
    failing = merged.read_number("failing", 0.0, 0.0, 100.0)
    if failing and metric not in PER_PIXEL:
        raise merged.make_fault("failing", f"pixels may fail with the metrics max_rel and max_abs, not with {metric}")
    error = merged.read_text("error")
    if "error" in own.items and not error:
        raise merged.make_fault("error", "give some words of the sentence that rendering must fail with")
    if error and own.items.get("golden"):
        raise merged.make_fault("golden", "a case that must fail gives no picture: leave out golden or error")
    return Case(
        path,
        name,
        graph,
        read_inputs(merged, path.parent),
        merged.read_table("set").items,
        read_frames(merged),
        read_size(merged),
        merged.read_number("scale", 1.0, 0.0, 1.0),
        merged.read_text("node"),
        () if error else read_goldens(merged, path.parent, name, graph.stem),
        metric,
        merged.read_number("tolerance", METRICS[metric].tolerance, None, None),
        failing,
        merged.read_choice("precision", ("half", "float"), "half"),
        merged.read_text("view"),
        error,
        merged.read_choices("allow", _EXCEPTIONS),
        merged.read_text("skip"),
    )


def _check_goldens(path: Path, cases: Iterable[Case]) -> None:
    """A golden belongs to one case: `--update` would otherwise make one of two fail."""
    owner: dict[Path, str] = {}
    for case in cases:
        for golden in case.goldens:
            if owner.setdefault(golden.path, case.name) != case.name:
                raise DocumentError(
                    str(path),
                    f"cases.{case.name}",
                    f"golden {golden.path} is that of '{owner[golden.path]}' too: give each its own, with {{case}}",
                )


def load_suites(paths: Sequence[Path], sandbox: Sandbox) -> tuple[Case, ...]:
    """The cases of several files and folders. Raises UsageError, DocumentError."""
    return tuple(case for path in find_suites(paths) for case in load_suite(path, sandbox))
