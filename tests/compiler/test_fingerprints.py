"""What is hashed for the key of a picture decides its program and all numbers in it, and nothing else does."""

from __future__ import annotations

from random import Random

from edited_graphs import edit_randomly
from halation.compiler import NULL, Library, Request, load_library
from halation.compiler.codegen.emit import emit
from halation.compiler.fusion.fuse import fuse
from halation.compiler.fusion.rewrites import rewrite_passes
from halation.compiler.ir import ExternalProgram, HostCall, Raster
from halation.compiler.lowering.lower import lower
from halation.compiler.scheduling.fingerprints import PassFingerprints
from halation.compiler.scheduling.schedule import choose_formats
from halation.errors import HalationError
from halation.glsl import parse
from halation.graph import Graph, Input, Output, Port
from halation.nodes import Kind
from halation.nodes.color.exposure import Exposure
from halation.nodes.color.vignette import Vignette
from halation.resources.picture import Picture
from headers import Headers
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace
from random_graphs import random_graph

SIZE = (37, 23)
FORMS = (NULL, replace(NULL, form="fragment"), replace(NULL, software=False))


def told(graph: Graph, target=NULL, library: Library | None = None, frame: int = 1, scale: float = 1.0) -> dict:
    """By mark, the programs of all that passes make, each as if it were alone, and what they are set to."""
    library, found = library or load_library(), dict[str, set]()
    bindings = {
        name: Picture(name, "", item.kind, item.socket().channels, in_memory=True)
        for name, item in graph.inputs.items()
        if item.default is None or not item.socket().single
    }
    try:
        program = lower(graph, Request(bindings=bindings, frame=frame, scale=scale), library, Headers(SIZE)).program
    except HalationError:
        return {}
    passes = rewrite_passes(program, fuse(program, target), target, library)
    texels = choose_formats(program, passes, target, "half", frozenset())
    fingerprints = PassFingerprints(program, library, target, texels)
    for fused in passes:
        whole = emit(program, fused, library, target, texels)
        for one, mark in fingerprints.of(fused):
            root = program.ops[one.root]
            alone = whole if one is fused else emit(program, one, library, target, texels)
            drawn: object = ""
            if isinstance(root, Raster):
                drawn = root.mesh.digest
            elif isinstance(root, ExternalProgram):
                drawn = root.text
            elif isinstance(root, HostCall):  # its text does not say which picture is which, and how large
                drawn = [(one.reads.index(ref), program.shape(ref)) for ref in root.reads()]
            stored = tuple(texels[ref] for ref in (*one.reads, *one.writes))
            found.setdefault(mark, set()).add(repr((alone.shader, alone.uniforms, alone.weights, drawn, stored)))
    return found


def check(*some: dict) -> None:
    """Among all that was told, one mark is one program, and one program one mark."""
    both: dict[str, set] = {}
    for found in some:
        for mark, programs in found.items():
            both.setdefault(mark, set()).update(programs)
    assert all(len(programs) == 1 for programs in both.values())
    everything = [program for programs in both.values() for program in programs]
    assert len(everything) == len({*everything})


@settings(max_examples=60)
@given(st.integers(0, 10**6), st.sampled_from(FORMS))
def test_marks_are_equal_where_programs_and_numbers_are(seed, target):
    graph, rng = random_graph(seed), Random(seed)
    graphs = [graph]
    for _ in range(4):
        graphs.append(edit_randomly(rng, graphs[-1]))
    check(*(told(one, target) for one in graphs))
    check(told(graph, target), told(graph, target, frame=7), told(graph, target, scale=0.5))


@settings(max_examples=30)
@given(st.integers(0, 10**6))
def test_marks_know_nothing_of_other_graphs(seed):
    check(told(random_graph(seed)), told(random_graph(seed + 1)), told(random_graph(seed, 3)))


def test_a_shader_that_is_written_again_changes_what_it_makes_and_nothing_else():
    graph = Graph().add_input("image", Input(Kind.IMAGE))
    for name, node in (("exposure", Exposure(stops=1.0)), ("vignette", Vignette())):
        graph = graph.add(name, node).connect(Port("inputs", "image"), Port(name, "image"))
        graph = graph.add_output(name, Output(Kind.IMAGE)).connect(Port(name, "out"), Port("outputs", name))
    library, name = load_library(), Exposure().shader
    source = f"{library.texts[name].body}\n".replace("exp2(", "exp(")
    other = library.with_replacement(parse(name, source), "another")
    before, after = told(graph), told(graph, library=other)
    check(before, after)
    assert len(before) == len(after) == 2 and len(before.keys() & after.keys()) == 1
