"""Large arrays behave as all others, and give their pages back."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from halation.resources import large_arrays
from halation.resources.large_arrays import LARGE, MAX_SPARE, create_array, reuse_pages
from resident import count_resident, needs_proc


@pytest.mark.parametrize("shape", [(3, 5, 4), (LARGE // 64, 8, 4), (0, 4)])
def test_an_array_has_its_shape_and_can_be_written(shape: tuple[int, ...]) -> None:
    array = create_array(shape, np.float16)
    assert array.shape == shape and array.dtype == np.float16 and array.flags.c_contiguous and array.flags.writeable
    array[...] = np.arange(array.size).reshape(shape) % 2000
    np.testing.assert_array_equal(array.ravel(), np.arange(array.size) % 2000)


@needs_proc
def test_pages_go_back_to_the_system_with_the_last_view() -> None:
    before = count_resident()
    arrays = [create_array((LARGE,), np.uint8) for _ in range(32)]
    for array in arrays:
        array.fill(1)
    views = [array[::2] for array in arrays]
    assert count_resident() - before > 31 * LARGE
    del array, arrays
    assert count_resident() - before > 31 * LARGE
    del views
    assert count_resident() - before < LARGE


def test_what_no_machine_has_is_a_memory_error() -> None:
    with pytest.raises(MemoryError):
        create_array((2**30, 2**30), np.float32)


def find_address(array: np.ndarray) -> int:
    return array.__array_interface__["data"][0]


@pytest.mark.parametrize("platform", ["linux", "win32", "darwin"])
def test_pages_are_used_again_when_no_view_needs_them(monkeypatch: pytest.MonkeyPatch, platform: str) -> None:
    if platform != sys.platform:
        monkeypatch.setattr(sys, "platform", platform)
    with reuse_pages():
        first = create_array((LARGE, 2), np.uint8)
        address, view = find_address(first), first[::2, :1].T
        first.fill(7)
        del first
        other = create_array((LARGE * 2,), np.uint8)
        other.fill(1)
        assert (view == 7).all() and find_address(other) != address
        del view
        smaller = create_array((LARGE,), np.uint8)
        again = create_array((LARGE // 4, 4), np.float16)
        assert find_address(again) == address != find_address(smaller)


@needs_proc
def test_pages_of_a_few_arrays_are_kept_until_the_end() -> None:
    before = count_resident()
    with reuse_pages():
        with reuse_pages():
            arrays = [create_array((LARGE,), np.uint8) for _ in range(2 * MAX_SPARE)]
            for array in arrays:
                array.fill(1)
            del array, arrays
        assert (MAX_SPARE - 0.5) * LARGE < count_resident() - before < (MAX_SPARE + 0.5) * LARGE
    assert count_resident() - before < LARGE / 2
    array = create_array((LARGE,), np.uint8)
    array.fill(1)
    del array
    assert count_resident() - before < LARGE / 2


def test_arrays_that_outlive_the_work_are_not_kept() -> None:
    with reuse_pages():
        array = create_array((LARGE,), np.uint8)
    address = find_address(array)
    array.fill(3)
    with reuse_pages():
        other = create_array((LARGE,), np.uint8)
        assert find_address(other) != address and (array == 3).all()


def test_only_so_many_bytes_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(large_arrays, "MAX_SPARE_BYTES", 3 * LARGE)
    created, create = list[int](), large_arrays._create_pages
    monkeypatch.setattr(large_arrays, "_create_pages", lambda nbytes: created.append(nbytes) or create(nbytes))
    with reuse_pages():
        for nbytes in (LARGE, 2 * LARGE, LARGE, 4 * LARGE, 2 * LARGE, LARGE, 3 * LARGE, LARGE):
            create_array((nbytes,), np.uint8)
    # Both sizes are kept together. More than all is not kept at all, and as much as all in place of the others.
    assert created == [size * LARGE for size in (1, 2, 4, 3, 1)]
