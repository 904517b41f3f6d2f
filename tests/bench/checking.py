"""What `halation check` takes for large files, whatever is in them. It prints JSON.

Each file is checked by a process of its own: `seconds` of processor time, `memory` in MiB at its peak, and the exit
`code`. A chain is a valid graph; the other files are what a hostile one may hold (`crowded_graphs`), and most are
refused. Names as arguments choose some of them: `checking.py keys lights`.
"""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from bench.programs import halation_command
from bench.started import run_process
from crowded_graphs import CROWDED

CHAINS = (20_000, 99_000)
"""Nodes; a file may hold 100,000."""


def write_chain(count: int) -> str:
    """A valid graph of so many nodes, one after the other."""
    nodes: dict[str, object] = {"n0": {"type": "noise"}}
    nodes |= {f"n{number}": {"type": "exposure", "values": {"stops": 0.01}} for number in range(1, count)}
    links = {f"n{number}.image": f"n{number - 1}.out" for number in range(1, count)}
    return write_graph(nodes=nodes, links={**links, "outputs.image": f"n{count - 1}.out"})


def write_graph(**sections: object) -> str:
    """A small graph with other sections."""
    graph: dict[str, object] = {
        "halation": 1,
        "settings": {"size": [64, 64]},
        "outputs": {"image": {"type": "Image"}},
        "nodes": {"n0": {"type": "noise"}},
        "links": {"outputs.image": "n0.out"},
    }
    return json.dumps({**graph, **sections}, indent=1)


def write_files(names: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Names and texts of all files, or of those of `CROWDED` with these names; chains come last.

    The peak of a process counts what this one held at its start.
    """
    for name, (build, count) in CROWDED.items():
        if name in names or not names:
            yield f"{count:,} {name}", json.dumps(build(count))
    if names:
        return
    yield "a key of 1 MB", write_graph(ui={"k" * 10**6: 1})
    yield "a string of 20 MB", write_graph(ui={"note": "x" * (20 << 20)})
    yield "40,000 brackets", write_graph(ui=[]).replace("[]", "[" * 40_000 + "]" * 40_000)
    yield "100,000 faults", write_graph(nodes={f"n{number}": {"type": f"t{number}"} for number in range(99_000)})
    for count in CHAINS:
        yield f"{count:,} nodes", write_chain(count)


def measure_check(path: Path) -> dict[str, object]:
    """What checking one file takes."""
    process = run_process([*halation_command(), "check", str(path)])
    return {"seconds": process.cpu, "memory": process.memory, "code": process.code}


def main() -> None:
    """Print what each file took."""
    checks: list[dict[str, object]] = []
    with tempfile.TemporaryDirectory() as folder:
        for name, text in write_files(sys.argv[1:]):
            path = Path(folder, "graph.json")
            path.write_text(text)
            checks.append({"name": name, **measure_check(path)})
    print(json.dumps({"checks": checks}))


if __name__ == "__main__":
    main()
