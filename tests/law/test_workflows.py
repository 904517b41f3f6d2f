"""Workflows of the build server are valid, and what they call exists. Nobody can run them here."""

from __future__ import annotations

import plistlib
import re
import subprocess
import sys
from pathlib import Path

import pytest
from application.desktop_systems import list_system_options

ROOT = Path(__file__).parents[2]
WORKFLOWS = sorted((ROOT / ".github/workflows").glob("*.yml"))


def test_they_keep_to_the_schema_of_github() -> None:
    pytest.importorskip("check_jsonschema", reason="check-jsonschema is not installed")
    words = (Path(sys.executable).with_name("check-jsonschema"), "--builtin-schema", "vendor.github-workflows")
    checked = subprocess.run([*words, *WORKFLOWS], capture_output=True, text=True)
    assert WORKFLOWS and checked.returncode == 0, checked.stdout


@pytest.mark.parametrize("workflow", WORKFLOWS, ids=lambda workflow: workflow.name)
def test_what_they_name_exists(workflow: Path) -> None:
    text = workflow.read_text(encoding="utf-8")
    paths = set(re.findall(r"(?<![\w/])tests/[\w/.-]*\w|(?<= )presets$", text, re.M))
    paths |= {f"tests/{module.replace('.', '/')}.py" for module in re.findall(r"python -m (application\.\w+)", text)}
    assert len(paths) >= 2 and not {path for path in paths if not (ROOT / path).exists()}


@pytest.mark.parametrize("workflow", WORKFLOWS, ids=lambda workflow: workflow.name)
def test_actions_of_others_are_named_by_their_commit(workflow: Path) -> None:
    used = re.findall(r"uses: (\S+)(.*)", workflow.read_text(encoding="utf-8"))
    assert used and all(re.search(r"@[0-9a-f]{40}$", name) and version.startswith("  # v") for name, version in used)


def test_a_certificate_signs_the_bundle_of_macos() -> None:
    unsigned = list_system_options("darwin", {})
    signed = list_system_options("darwin", {"HALATION_SIGN": "Developer ID Application: A (B)"})
    assert "--windowed" in unsigned and "--codesign-identity" not in unsigned
    assert signed[len(unsigned) :: 2] == ["--codesign-identity", "--osx-entitlements-file"]
    assert plistlib.loads(Path(signed[-1]).read_bytes())["com.apple.security.cs.disable-library-validation"] is True
    assert Path(signed[signed.index("--icon") + 1]).is_file()


def test_linux_has_another_script() -> None:
    with pytest.raises(SystemExit, match="dev release"):
        list_system_options("linux", {})
