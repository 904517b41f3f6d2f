"""What the forms of passes take on a device: measured once, then kept."""

from __future__ import annotations

import json

import pytest
from halation.compiler.devices import FormTimings
from halation.errors import ShaderError
from halation.renderer import calibration, open_device
from halation.renderer.calibration import load_or_measure, measure_forms
from halation.renderer.execution.runner import Runner
from halation.resources.sandbox import UNRESTRICTED
from msgspec.structs import replace

SMALL = (64, 48)


@pytest.fixture(scope="module")
def device():
    made = open_device(sandbox=UNRESTRICTED)
    yield made
    made.close()


@pytest.fixture
def counted(monkeypatch):
    """Numbers instead of a clock, a new pair each time; how often it was looked at."""
    seen = []

    def fake(device):
        seen.append(device.target.renderer)
        return FormTimings(1.0 / len(seen), 0.25)

    monkeypatch.setattr(calibration, "measure_forms", fake)
    return seen


def test_both_forms_run_and_take_time(device):
    found = measure_forms(device, SMALL, 2)
    assert found.is_usable and 0.0 < found.compute < 60.0 and 0.0 < found.fragment < 60.0


def test_a_form_that_the_driver_refuses_takes_forever(device, monkeypatch):
    run = Runner.measure

    def refusing(self, plan):
        if self.device.target.form == "compute":
            raise ShaderError("noise", "noise.glsl", 1, "no")
        return run(self, plan)

    monkeypatch.setattr(Runner, "measure", refusing)
    found = measure_forms(device, SMALL, 1)
    assert found.compute == float("inf") and found.is_usable


def test_a_device_is_measured_once(device, counted, tmp_path):
    first = load_or_measure(device, tmp_path / "new", sandbox=UNRESTRICTED)
    assert first == FormTimings(1.0, 0.25) == load_or_measure(device, tmp_path / "new", sandbox=UNRESTRICTED)
    other = device.with_target(replace(device.target, renderer="another card"))
    assert load_or_measure(other, tmp_path / "new", sandbox=UNRESTRICTED) == FormTimings(0.5, 0.25)
    assert counted == [device.target.renderer, "another card"]
    files = list((tmp_path / "new").iterdir())
    assert {json.loads(file.read_text())["renderer"] for file in files} == set(counted)


@pytest.mark.parametrize("text", ["", "{", "[]", '{"compute": 1}', '{"compute": "x", "fragment": 1}'])
def test_a_file_that_makes_no_sense_is_measured_again(device, counted, tmp_path, text):
    load_or_measure(device, tmp_path, sandbox=UNRESTRICTED)
    file = next(tmp_path.iterdir())
    file.write_text(text)
    assert (
        load_or_measure(device, tmp_path, sandbox=UNRESTRICTED)
        == FormTimings(0.5, 0.25)
        == load_or_measure(device, tmp_path, sandbox=UNRESTRICTED)
    )


def test_what_cannot_be_kept_is_not_measured(device, counted, tmp_path):
    (tmp_path / "file").write_text("")
    (tmp_path / "inside").mkdir()
    assert load_or_measure(device, tmp_path / "file" / "below", sandbox=UNRESTRICTED) is None
    inside = UNRESTRICTED.narrow(tmp_path / "inside")
    assert load_or_measure(device, tmp_path / "outside", sandbox=inside) is None
    assert not counted


def test_the_software_rasterizer_is_never_measured(counted):
    made = open_device(sandbox=UNRESTRICTED)
    made.close()
    assert made.target.software and made.target.why.startswith("by the table") and not counted


def test_times_of_other_versions_are_removed(device, counted, tmp_path, monkeypatch):
    """Those of other drivers stay; so does what is no file of ours."""
    load_or_measure(device, tmp_path, sandbox=UNRESTRICTED)
    load_or_measure(device.with_target(replace(device.target, renderer="another")), tmp_path, sandbox=UNRESTRICTED)
    before = set(tmp_path.iterdir())
    assert len(before) == 2
    (tmp_path / "notes.txt").write_text("mine")
    monkeypatch.setattr(calibration, "_PREFIX", "later-")
    load_or_measure(device, tmp_path, sandbox=UNRESTRICTED)
    after = set(tmp_path.iterdir())
    assert len(counted) == 3 and not after & before and len(after) == 2 and tmp_path / "notes.txt" in after
