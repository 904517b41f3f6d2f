"""Bills of materials of a release keep to the schema of CycloneDX and name what NOTICE names."""

from __future__ import annotations

import json
import re
import sys
import sysconfig
from importlib.metadata import distributions
from pathlib import Path

import pytest
from application.build import SystemPart, list_system_parts
from bill_of_materials import check_bill, write_application_bill, write_environment_bill
from release import write_notice

pytestmark = [
    pytest.mark.skipif(sys.platform != "linux", reason="only Linux keeps to it"),
    pytest.mark.nightly,  # each release writes and checks its bills itself; to check one takes 20 seconds
]


@pytest.fixture(scope="module")
def environment_bill(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The bill of the environment that runs the tests."""
    pytest.importorskip("cyclonedx_py", reason="cyclonedx-bom is not installed")
    target = tmp_path_factory.mktemp("bill") / "halation.cdx.json"
    write_environment_bill(Path(sys.executable), target)
    return target


def test_the_bill_names_the_packages_of_notice(environment_bill: Path) -> None:
    packages = list(distributions(path=[sysconfig.get_path("purelib")]))
    noticed = set(re.findall(r"^={80}\n(\S+ \S+)$", write_notice(packages), re.M))
    bill = json.loads(environment_bill.read_text(encoding="utf-8"))
    everything = [bill["metadata"]["component"], *bill["components"]]
    assert {f"{part['name']} {part['version']}" for part in everything if "version" in part} >= noticed - {
        f"{package.name} {package.version}" for package in packages if package.name == "halation"
    }


def test_the_bill_of_an_application_adds_what_comes_from_the_machine(environment_bill: Path, tmp_path: Path) -> None:
    parts = [
        SystemPart("Python", "3.11.7", "pkg:generic/python@3.11.7", "text", "Python-2.0"),
        SystemPart("libxft2", "2.3.6-1", "pkg:deb/debian/libxft2@2.3.6-1?arch=amd64", "text"),
    ]
    write_application_bill(environment_bill, parts, tmp_path / "application.cdx.json")
    before, after = (
        json.loads(path.read_text(encoding="utf-8")) for path in (environment_bill, tmp_path / "application.cdx.json")
    )
    added = {part["name"] for part in after["components"]} - {part["name"] for part in before["components"]}
    assert added == {"Python", "libxft2"}
    assert {entry["ref"] for entry in after["dependencies"]} >= added
    assert "serialNumber" not in after and "timestamp" not in after["metadata"]


def test_an_invalid_bill_stops_the_release(environment_bill: Path) -> None:
    bill = json.loads(environment_bill.read_text(encoding="utf-8"))
    bill["components"][0]["typo"] = 1
    with pytest.raises(SystemExit, match="invalid"):
        check_bill(json.dumps(bill))


def test_parts_of_the_machine_have_a_version_and_a_license(tmp_path: Path) -> None:
    (tmp_path / "lib").mkdir()
    for folder in ("/lib/x86_64-linux-gnu", "/usr/lib/x86_64-linux-gnu"):
        for path in Path(folder).glob("libz.so.1"):
            (tmp_path / "lib" / path.name).touch()
    python, *debian = list_system_parts(tmp_path)
    assert python.version == ".".join(map(str, sys.version_info[:3]))
    for part in debian:
        assert re.match(r"pkg:deb/\w+/zlib1g@", part.purl) and part.version and "zlib" in part.notice
