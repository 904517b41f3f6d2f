"""Large arrays behave as all others, and give their pages back."""

from __future__ import annotations

import numpy as np
import pytest
from halation.resources.large_arrays import LARGE, create_array
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
