"""How a picture that was made again is compared with the old one, and what has changed around it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from halation.renderer import RenderRequest
from halation.renderer.bench import identify_passes
from halation.renderer.provenance import reproduction
from halation.renderer.provenance.reproduction import LayerDifference, Reproduction, compare_layers
from halation.version import VERSION

ONES = np.ones((2, 3, 4), np.float32)


def farthest(actual: np.ndarray, expected: np.ndarray) -> float:
    (layer,) = compare_layers({"": actual}, {"": expected})
    assert not layer.compared.fault
    return layer.farthest


@pytest.mark.parametrize(
    ("actual", "expected", "distance"),
    [(1.0, 1.0, 0.0), (1.5, 1.0, 0.5), (0.25, 0.5, 0.25), (6.0, 4.0, 0.5), (-6.0, -4.0, 0.5), (np.nan, np.nan, 0.0),
     (np.inf, np.inf, 0.0), (np.nan, 1.0, np.inf), (np.inf, 1.0, np.inf), (1.0, np.inf, np.inf),
     (-np.inf, np.inf, np.inf)],
)  # fmt: skip
def test_distances_are_parts_of_what_is_brighter_than_white(actual: float, expected: float, distance: float) -> None:
    """Below 1 they are absolute; what is no number differs infinitely from any other one."""
    first, second = ONES.copy(), ONES.copy()
    first[1, 2, 0], second[1, 2, 0] = actual, expected
    found = reproduction._measure_distance(first, second)  # pyright: ignore[reportPrivateUsage]
    assert found == pytest.approx(distance)


@pytest.mark.parametrize(("dtype", "most"), [(np.uint8, 255), (np.uint16, 65535)])
def test_codes_are_parts_of_the_largest(dtype: Any, most: int) -> None:
    first = np.zeros((2, 3, 3), dtype)
    second = first.copy()
    second[0, 0, 0] = 5
    assert farthest(first, second) == pytest.approx(5 / most) == farthest(second, first)


def test_layers_that_one_file_lacks_or_that_have_another_type_or_size_differ_infinitely() -> None:
    layers = compare_layers({"a": ONES, "new": ONES, "half": ONES, "wide": ONES[:, :2]},
                            {"a": ONES, "old": ONES, "half": ONES.astype(np.float16), "wide": ONES})  # fmt: skip
    assert [(layer.name, layer.farthest) for layer in layers] == [
        ("a", 0.0), ("old", np.inf), ("half", np.inf), ("wide", np.inf), ("new", np.inf),
    ]  # fmt: skip
    faults = {layer.name: layer.compared.fault for layer in layers}
    assert not faults["a"] and "not made again" in faults["old"] and "not there before" in faults["new"]
    assert faults["half"] == "it is float32 now, and was float16" and faults["wide"]


@pytest.mark.parametrize(("farthest", "tolerance", "same"), [(0.0, 0.0, True), (0.1, 0.1, True), (0.11, 0.1, False)])
def test_it_is_the_same_within_the_tolerance(farthest: float, tolerance: float, same: bool) -> None:
    difference: Any = None
    layers = (LayerDifference("a", 0.0, difference), LayerDifference("b", farthest, difference))
    assert Reproduction((), layers, tolerance, ()).is_same is same


def test_what_has_changed_around_it() -> None:
    device: Any = SimpleNamespace(target=SimpleNamespace(renderer="llvmpipe", form="compute"), driver="Mesa 22")

    def list_changes(**facts: Any) -> dict[str, tuple[str, str]]:
        recorded = {
            "version": VERSION,
            "renderer": "llvmpipe",
            "driver": "Mesa 22",
            "color": "digest",
            "form": "compute",
        }
        recorded |= facts
        settings = SimpleNamespace(form=recorded.pop("form"))
        recipe: Any = SimpleNamespace(**recorded, settings=settings)
        found = reproduction._find_differences(recipe, device, "digest")  # pyright: ignore[reportPrivateUsage]
        return {item.name: (item.recorded, item.current) for item in found}

    assert list_changes() == {}
    assert list_changes(version="0.0.1", driver="") == {"version": ("0.0.1", VERSION)}
    assert list_changes(renderer="H200", form="fragment") == {
        "renderer": ("H200", "llvmpipe"), "passes": ("fragment", "compute"),
    }  # fmt: skip
    assert list_changes(form=None) == {} and [*list_changes(color="other")] == ["color"]


def test_passes_of_the_same_nodes_are_counted() -> None:
    def make(*nodes: str) -> Any:
        return SimpleNamespace(nodes=nodes, functions=("f",))

    passes = [make("a"), make("b"), make("a"), make("a", "b"), make("a")]
    assert identify_passes(passes) == [
        (("a",), ("f",), 0), (("b",), ("f",), 0), (("a",), ("f",), 1), (("a", "b"), ("f",), 0), (("a",), ("f",), 2),
    ]  # fmt: skip


def test_a_request_that_says_nothing_is_the_first_frame_at_full_size() -> None:
    request = RenderRequest()
    assert (request.frame, request.scale, request.size, request.region) == (1, 1.0, None, None)
