"""Render jobs as JSON: nothing is lost between two processes."""

from __future__ import annotations

import os
from typing import Any, get_type_hints

import pytest
from halation.errors import UsageError
from halation.renderer.jobs.render_entry import RenderEntry
from halation.renderer.jobs.render_job import RenderJob
from halation.resources.sandbox import UNRESTRICTED, Sandbox
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import fields

TEXT = st.text(max_size=12)
ENTRIES = st.builds(
    RenderEntry,
    TEXT,
    st.dictionaries(TEXT, TEXT, max_size=2),
    st.dictionaries(TEXT, TEXT, max_size=2),
    st.lists(st.tuples(TEXT, TEXT), max_size=2).map(tuple),
)
VALUES: dict[str, st.SearchStrategy[Any]] = {
    "sandbox": st.builds(Sandbox, TEXT),
    "inputs": st.dictionaries(TEXT, TEXT, max_size=3),
    "sets": st.dictionaries(TEXT, TEXT, max_size=3),
    "size": st.none() | st.tuples(st.integers(1, 9999), st.integers(1, 9999)),
    "frames": st.lists(st.integers(-99, 9999), max_size=5).map(tuple),
    "destinations": st.lists(st.tuples(TEXT, TEXT), max_size=3).map(tuple),
    "entries": st.lists(ENTRIES, max_size=2).map(tuple),
    "precision": st.sampled_from([None, "half", "float"]),
    "form": st.sampled_from([None, "fragment", "compute"]),
    "dither": st.sampled_from(["blue", "none"]),
}
HINTS = get_type_hints(RenderJob)
BY_TYPE: dict[Any, st.SearchStrategy[Any]] = {
    str: TEXT,
    bool: st.booleans(),
    int: st.integers(0, 2**62),
    float: st.floats(allow_nan=False, allow_infinity=False),
}
JOBS = st.builds(
    RenderJob,
    **{
        item.name: VALUES[item.name] if item.name in VALUES else BY_TYPE[HINTS[item.name]] for item in fields(RenderJob)
    },
)


@given(JOBS)
def test_a_job_comes_back_as_it_was_sent(job: RenderJob) -> None:
    assert RenderJob.from_json(job.to_json()) == job


def test_names_of_files_in_any_encoding_are_sent() -> None:
    name = os.fsdecode(b"sh\xf6t.exr")
    job = RenderJob(graph=name, destinations=(("", name),), sandbox=UNRESTRICTED)
    assert RenderJob.from_json(job.to_json()) == job and job.to_json().isascii()


@pytest.mark.parametrize("text", ["", "[1]", "{}", '{"graf": "a"}', '{"form": "tesselated"}', '{"size": [1]}'])
def test_what_is_no_job_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="standard input is not a render job"):
        RenderJob.from_json(text)
