"""Bills of materials of a release, in the form of CycloneDX: of the wheel's environment, and of the application.

The tool of CycloneDX writes the first and checks it. The second is the first with what an application holds besides
Python packages, and is checked by the same library against the same schema.
"""

from __future__ import annotations

import importlib
import json
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from application.build import SystemPart

ROOT = Path(__file__).parents[1]


def write_environment_bill(python: Path, target: Path) -> None:
    """Write what an environment has installed."""
    command = [sys.executable, "-m", "cyclonedx_py", "environment", "--pyproject", ROOT / "pyproject.toml"]
    command += ["--spec-version", "1.6", "--validate", "--output-reproducible", "--output-file", target, python]
    subprocess.run(command, check=True)


def write_application_bill(environment_bill: Path, parts: Iterable[SystemPart], target: Path) -> None:
    """Write the bill of an application: the packages of its environment, and the parts that come from the machine."""
    bill = json.loads(environment_bill.read_text(encoding="utf-8"))
    added = [describe_part(part) for part in parts]
    bill["components"] = sorted([*bill["components"], *added], key=lambda component: component["bom-ref"])
    bill["dependencies"] += [{"ref": component["bom-ref"]} for component in added]
    for entry in bill["dependencies"]:
        if entry["ref"] == bill["metadata"]["component"]["bom-ref"]:
            entry["dependsOn"] = sorted({*entry.get("dependsOn", ()), *(component["bom-ref"] for component in added)})
    bill["dependencies"].sort(key=lambda entry: entry["ref"])
    text = json.dumps(bill, indent=2, ensure_ascii=False) + "\n"
    check_bill(text)
    target.write_text(text, encoding="utf-8", newline="\n")


def describe_part(part: SystemPart) -> dict[str, Any]:
    """A component of CycloneDX."""
    return {
        "bom-ref": part.name,
        "name": part.name,
        "version": part.version,
        "type": "library",
        "purl": part.purl,
        **({"licenses": [{"license": {"id": part.license}}]} if part.license else {}),
    }


def check_bill(text: str) -> None:
    """Stop with the fault if a bill does not keep to the schema of CycloneDX 1.6, unknown keys included."""
    validation: Any = importlib.import_module("cyclonedx.validation.json")  # only `./dev release` has it installed
    schema: Any = importlib.import_module("cyclonedx.schema")
    fault = validation.JsonStrictValidator(schema.SchemaVersion.V1_6).validate_str(text)
    if fault:
        sys.exit(f"release: the bill of materials is invalid; this is a fault of tests/bill_of_materials.py: {fault}")
