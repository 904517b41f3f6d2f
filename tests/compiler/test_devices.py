"""Which form of passes a device is given, and what is said of it."""

from __future__ import annotations

from math import inf

import pytest
from halation.compiler.devices import FormTimings, choose_form, is_software
from halation.errors import DeviceError

LLVMPIPE = "llvmpipe (LLVM 15.0.6, 256 bits)"
CARDS = (
    "NVIDIA GeForce RTX 4090/PCIe/SSE2",
    "AMD Radeon RX 7900 XTX (radeonsi, navi31, LLVM 17.0.6, DRM 3.54, 6.5.0)",
    "Mesa Intel(R) UHD Graphics 620 (KBL GT2)",
    "NVIDIA A100-SXM4-80GB/PCIe/SSE2",
)


def chosen(renderer, version=460, asked=None, found=None):
    return choose_form(renderer, version, asked, lambda: found)


def never():
    raise AssertionError("this device is not to be measured")


@pytest.mark.parametrize(
    ("renderer", "version", "form"),
    [
        (LLVMPIPE, 450, "compute"),
        ("softpipe", 430, "compute"),
        ("Google SwiftShader", 450, "compute"),
        ("Microsoft Basic Render Driver", 460, "compute"),
        ("Apple M2", 410, "fragment"),
        (LLVMPIPE, 410, "fragment"),
        ("Intel Iris Pro OpenGL Engine", 410, "fragment"),
        ("NVIDIA H200/PCIe/SSE2", 460, "compute"),
        ("NVIDIA H100 80GB HBM3/PCIe/SSE2", 460, "compute"),
    ],
)
def test_what_the_table_knows_is_not_measured(renderer, version, form):
    made = choose_form(renderer, version, None, never)
    assert made.form == form and made.why.startswith("by the table: ")


def test_only_those_without_a_gpu_are_software():
    assert is_software(LLVMPIPE) and not any(map(is_software, CARDS))


@pytest.mark.parametrize("renderer", [*CARDS, LLVMPIPE, "Apple M2"])
def test_what_is_asked_for_is_taken(renderer):
    assert choose_form(renderer, 460, "fragment", never).why == "asked for"
    assert choose_form(renderer, 460, "compute", never).form == "compute"


def test_compute_passes_cannot_be_asked_of_an_old_opengl():
    with pytest.raises(DeviceError, match=r"Apple M2 offers OpenGL 4\.1, but compute passes need 4\.3: use fragment"):
        choose_form("Apple M2", 410, "compute", never)


@pytest.mark.parametrize(
    ("found", "form", "why"),
    [
        (FormTimings(4.0e-3, 3.1e-3), "fragment", "measured: 3.10 ms against 4.00 in compute passes"),
        (FormTimings(3.1e-3, 4.0e-3), "compute", "measured: 3.10 ms against 4.00 in fragment passes"),
        (FormTimings(1.0, 1.0), "compute", "measured: 1000.00 ms against 1000.00 in fragment passes"),
        (FormTimings(inf, 0.25), "fragment", "measured: the driver refuses compute passes"),
        (FormTimings(0.25, inf), "compute", "measured: the driver refuses fragment passes"),
    ],
)
@pytest.mark.parametrize("renderer", CARDS)
def test_other_devices_are_given_what_was_faster(renderer, found, form, why):
    made = chosen(renderer, found=found)
    assert (made.form, made.why) == (form, why)


@pytest.mark.parametrize("found", [None, FormTimings(0.0, 0.0), FormTimings(0.0, 1.0), FormTimings(inf, inf)])
def test_what_says_nothing_decides_nothing(found):
    made = chosen(CARDS[0], found=found)
    assert made.form == "compute" and "nothing could be measured" in made.why
