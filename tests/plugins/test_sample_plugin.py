"""The sample plug-in of the documentation: built as a wheel, installed beside Halation, and used everywhere."""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

SAMPLE = Path(__file__).parents[2] / "docs" / "sample_plugin"
SEARCH = Path(__file__).parents[1] / "plugin_search.py"


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the plug-in as pip installs it from its wheel; nothing is downloaded."""
    folder = tmp_path_factory.mktemp("sample")
    source = shutil.copytree(SAMPLE, folder / "source", ignore=shutil.ignore_patterns("__pycache__"))
    pip = (sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check")
    build = ("wheel", "--no-deps", "--no-index", "--no-build-isolation", "--wheel-dir", folder, source)
    subprocess.run([*pip, *build], check=True, capture_output=True)
    (wheel,) = folder.glob("acme_glow-1.2.0-*.whl")
    target = folder / "site"
    subprocess.run([*pip, "install", "--no-deps", "--no-index", "--target", target, wheel], check=True)
    shutil.copytree(SAMPLE / "tests", folder / "tests")
    return target


def python(site: Path, *words: str | Path) -> subprocess.CompletedProcess[str]:
    """Run Python in an environment in which the plug-in is installed."""
    environment = {**os.environ, "PYTHONPATH": str(site), "PYTHONDONTWRITEBYTECODE": "1"}
    environment["HALATION_PLUGINS"] = "acme-glow"
    return subprocess.run(
        [sys.executable, *words], env=environment, cwd=site.parent, capture_output=True, text=True, timeout=300
    )


def halation(site: Path, *words: str | Path) -> subprocess.CompletedProcess[str]:
    return python(site, "-c", "from halation.cli import main; main()", *words)


def test_its_own_tests_pass(site: Path) -> None:
    result = python(site, "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests")
    assert result.returncode == 0 and "2 passed" in result.stdout, result.stdout + result.stderr


def test_commands_know_it(site: Path) -> None:
    listing = halation(site, "nodes")
    assert "  acme_glow.soft_glow " in listing.stdout and "(acme-glow 1.2.0)" in listing.stdout
    assert listing.stdout.count("\nglow\n") == 1
    page = halation(site, "nodes", "acme_glow.soft_glow")
    assert page.stdout.startswith("acme_glow.soft_glow  (glow, version 1, from acme-glow 1.2.0)"), page.stderr
    facts = json.loads(halation(site, "nodes", "acme_glow.soft_glow", "--json").stdout)
    assert facts["package"] == "acme-glow==1.2.0" and facts["plan"]["passes"]
    markdown = halation(site, "nodes", "--markdown").stdout
    assert "### acme_glow.soft_glow" in markdown and "(#acme_glowsoft_glow)" in markdown


def test_a_graph_with_it_renders(site: Path) -> None:
    preset = site / "acme_glow" / "presets" / "acme_dream.json"
    neon = Path(__file__).parents[2] / "presets" / "samples" / "neon.exr"
    picture = site.parent / "dream.png"
    assert halation(site, "check", "--off", "unbound-input", preset).stdout.strip().endswith(": ok")
    result = halation(site, "render", preset, "-i", f"beauty={neon}", "-o", picture, "--scale", "0.25")
    assert result.returncode == 0 and picture.stat().st_size > 1000, result.stderr


def list_commands(page: Path) -> list[list[str]]:
    """The commands of a page, each as its words."""
    blocks = re.findall(r"^```sh\n(.*?)^```", page.read_text("utf-8"), re.M | re.S)
    return [words for block in blocks for line in block.splitlines() if (words := shlex.split(line, comments=True))]


@pytest.mark.timeout(900)
def test_every_command_of_its_pages_works(site: Path) -> None:
    commands = [*list_commands(SAMPLE.parent / "plugins.md"), *list_commands(SAMPLE / "README.md")]
    assert len(commands) >= 9
    for words in map(list, {tuple(words): None for words in commands}):
        match words:
            case ["pip", "install", *packages]:
                assert {*packages} <= {".", "pytest", "--editable"}  # the fixture installs it, without a network
            case ["halation", "gallery", *options]:  # a picture of each node, which `tests/cli/test_gallery.py` draws
                assert halation(site, "gallery", *options, "--help").returncode == 0
            case ["halation", *rest]:
                result = halation(site, *rest)
                assert result.returncode == 0, (words, result.stdout, result.stderr)
            case _:
                assert words == ["python", "-m", "pytest", "tests"]  # see `test_its_own_tests_pass`
    assert (site.parent / "dream.png").stat().st_size > 1000


def test_the_editor_finds_it(site: Path) -> None:
    result = python(site, SEARCH)
    assert result.stdout.split("\n")[:5] == [
        "soft glow (acme glow)",
        "soft glow (acme glow)",
        "acme dream",
        "soft_glow",
        "acme_dream",
    ], result.stdout + result.stderr


def test_without_it_the_graph_names_the_package(site: Path, tmp_path: Path) -> None:
    preset = shutil.copy(site / "acme_glow" / "presets" / "acme_dream.json", tmp_path / "dream.json")
    result = halation(tmp_path, "check", preset)
    assert result.returncode == 3
    sentence = "the plug-in acme-glow 1.2.0, which is not installed: pip install acme-glow==1.2.0"
    assert sentence in result.stdout
    rendered = halation(tmp_path, "render", preset, "-o", "dream.png")
    assert rendered.returncode == 3 and sentence in rendered.stderr
    package = halation(tmp_path, "nodes", "--check", "acme-glow")
    assert package.returncode == 2 and "did you mean" not in package.stderr
    assert "by its package or import name; no plug-in is installed" in package.stderr
    before = Path(preset).read_bytes()
    assert halation(tmp_path, "fmt", preset).returncode == 0 and Path(preset).read_bytes() == before


def test_one_that_fails_to_import_is_named(site: Path, tmp_path: Path) -> None:
    broken = shutil.copytree(site, tmp_path / "site")
    (broken / "acme_glow" / "nodes" / "glow" / "soft_glow.py").write_text("import no_such_library\n")
    sentence = "the plug-in acme-glow 1.2.0 cannot be loaded: acme_glow/nodes/glow/soft_glow.py, line 1: "
    nodes = halation(broken, "nodes")
    assert nodes.returncode == 0 and "  bloom " in nodes.stdout and sentence in nodes.stderr
    page = halation(broken, "nodes", "acme_glow.soft_glow")
    assert page.returncode == 2 and sentence in page.stderr
    graph = tmp_path / "plain.json"
    graph.write_text('{"halation": 1}\n')
    for words in (("render", "acme_glow.acme_dusk", "-o", "x.png"), ("check", "acme_glow.acme_dusk")):
        dusk = halation(broken, *words)
        assert dusk.returncode == 3 and sentence in dusk.stderr
    names = halation(broken, "demo", "--list")
    assert names.returncode == 0 and "soft_bloom" in names.stdout and sentence in names.stderr
    doctor = [line.split()[:2] for line in halation(broken, "doctor").stdout.splitlines() if "plug-ins " in line]
    assert doctor == [["fault", "plug-ins"]]
    checked = halation(broken, "nodes", "--check")
    assert (checked.returncode, checked.stderr) == (1, "1 plug-in cannot be loaded\n")
    check = halation(broken, "check", graph)
    assert check.returncode == 0 and sentence in check.stderr
    report = json.loads(halation(broken, "check", graph, "--json").stdout)
    assert report["refused_plugins"][0]["package"] == "acme-glow"


def test_its_nodes_keep_what_nodes_promise(site: Path) -> None:
    result = halation(site, "nodes", "--check", "acme-glow")
    assert (result.returncode, result.stdout) == (0, "acme_glow.soft_glow: ok\n"), result
    assert halation(site, "nodes", "--check").stdout == result.stdout
    assert json.loads(halation(site, "nodes", "--check", "acme_glow", "--json").stdout) == {
        "faults": {"acme_glow.soft_glow": []}
    }


CLASS = """from typing import Annotated

from halation.nodes import Image, Pointwise, Slider


class SoftGlow(Pointwise):
    \"\"\"Glow.\"\"\"

    image = Image()
    amount: Annotated[float, Slider(0.0, 1.0, unit="ratio")] = 0.5
"""
SHADER = "vec4 acme_glow_soft_glow(vec4 image, float amount) { return BODY; }\n"
FAULTY = {
    "tooltip": (CLASS.replace('    """Glow."""\n\n', ""), SHADER, "its class has no docstring, which is the tooltip"),
    "sentence": (CLASS.replace("Glow.", "Glow"), SHADER, "is no sentence"),
    "range": (CLASS.replace("= 0.5", "= 0.5").replace("0.0, 1.0", "1.0, 0.0"), SHADER, "has a slider from 1 to 0"),
    "default": (
        CLASS.replace('"ratio"', '"ratio", maximum=1.0').replace("= 0.5", "= 7.0"),
        SHADER,
        "has the default 7.0",
    ),
    "signature": (CLASS, SHADER.replace("float", "vec4"), "vec4 acme_glow_soft_glow(vec4 image, float amount)"),
    "no shader": (CLASS, "", "there is no function 'acme_glow_soft_glow' in it"),
    "GLSL": (CLASS, SHADER.replace("BODY", "shade"), "soft_glow.glsl, line 1: error: `shade' undeclared"),
    "include": (CLASS, '#include "lib/colour.glsl"\n' + SHADER, "line 1: #include"),
    "NaN": (CLASS, SHADER.replace("BODY", "image * amount"), "use finite()"),
    "alpha": (
        CLASS,
        '#include "lib/finite.glsl"\n'
        + SHADER.replace("BODY", "vec4(finite(image).rgb * finite(image).rgb * finite(amount), finite(image).a)"),
        "use straight() and premultiplied() of lib/alpha.glsl",
    ),
    "overlap": (
        CLASS.replace("Pointwise", "Draw, Drawn, Filter").replace("SoftGlow(Draw, Drawn, Filter)", "SoftGlow(Filter)")
        + """
    def passes(self, draw: Draw) -> Drawn:
        return draw("acme_glow_soft_glow", self.image, overlap=1, amount=self.amount)
""",
        "vec4 acme_glow_soft_glow(float amount) { return image_at(pixel - ivec2(2, 0)); }\n",
        "the output 'out' reads farther than an `overlap` in passes() says",
    ),
    "a longer overlap": (
        CLASS.replace("Pointwise", "Draw, Drawn, Filter")
        .replace("SoftGlow(Draw, Drawn, Filter)", "SoftGlow(Filter)")
        .replace('1.0, unit="ratio"', '0.02, unit="height"')
        .replace("= 0.5", "= 0.004")
        + """
    def passes(self, draw: Draw) -> Drawn:
        return draw("acme_glow_soft_glow", self.image, overlap=1, amount=self.amount)
""",
        "vec4 acme_glow_soft_glow(float amount) { return image_at(pixel - ivec2(int(ceil(amount)), 0)); }\n",
        "the output 'out' reads farther than an `overlap` in passes() says",
    ),
    "a name without that of the package": (
        CLASS,
        "float half_of(float part) { return 0.5 * part; }\n" + SHADER.replace("BODY", "image"),
        "acme_glow.soft_glow: acme_glow/shaders/glow/soft_glow.glsl, line 1: the function 'half_of' of a plug-in must",
    ),
    "code that fails": (
        CLASS.replace("Pointwise", "Draw, Drawn, Filter").replace("SoftGlow(Draw, Drawn, Filter)", "SoftGlow(Filter)")
        + """
    def passes(self, draw: Draw) -> Drawn:
        return draw("acme_glow_soft_glow", self.image, overlap=0, amount=self.amuont)
""",
        "vec4 acme_glow_soft_glow(float amount) { return image_at(pixel) * amount; }\n",
        "acme_glow/nodes/glow/soft_glow.py, line 13: AttributeError: 'SoftGlow' object has no attribute 'amuont'",
    ),
    "a name of GLSL": (
        CLASS,
        "float acme_glow_sum(float half) { return half; }\n" + SHADER.replace("BODY", "image"),
        "line 1: the parameter 'half' has a name that GLSL or the pass reserves: choose another",
    ),
}


@pytest.mark.parametrize("case", FAULTY)
def test_what_a_node_does_not_keep_is_said(site: Path, tmp_path: Path, case: str) -> None:
    copy = shutil.copytree(site, tmp_path / "site")
    code, shader, sentence = FAULTY[case]
    (copy / "acme_glow" / "nodes" / "glow" / "soft_glow.py").write_text(code)
    (copy / "acme_glow" / "shaders" / "glow" / "soft_glow.glsl").write_text(shader)
    for words in ((), ("acme_glow.soft_glow",)) if case == "range" else ((),):
        result = halation(copy, "nodes", "--check", *words)
        assert result.returncode == 1 and sentence in result.stdout, result
        lines = result.stdout.splitlines()
        assert ": ok" not in result.stdout and len({*lines}) == len(lines), result
        assert all(line.startswith("acme_glow.soft_glow: ") for line in lines), result
        assert result.stderr.endswith("1 node: 1 to mend\n"), result


def test_a_plugin_that_cannot_be_loaded_keeps_nothing(site: Path, tmp_path: Path) -> None:
    copy = shutil.copytree(site, tmp_path / "site")
    (copy / "acme_glow" / "__init__.py").write_text("import no_such_library\n")
    result = halation(copy, "nodes", "--check", "acme-glow")
    assert result.returncode == 1
    assert result.stdout.startswith("acme-glow 1.2.0: it cannot be loaded: acme_glow/__init__.py, line 1: Module")
    misspelled = halation(copy, "nodes", "--check", "acme-glaw")
    assert misspelled.returncode == 2 and "did you mean 'acme-glow'?" in misspelled.stderr


def test_a_mask_of_its_own_is_mentioned(site: Path, tmp_path: Path) -> None:
    copy = shutil.copytree(site, tmp_path / "site")
    code = CLASS.replace("import Image", "import Field, Image").replace(
        "    amount", "    mask = Field(1.0)\n    amount"
    )
    body = "finite(finite(image) * clamp(finite(mask) * finite(amount), 0.0, 1.0))"
    shader = SHADER.replace("float", "float mask, float").replace("BODY", body)
    (copy / "acme_glow" / "nodes" / "glow" / "soft_glow.py").write_text(code)
    shader_file = copy / "acme_glow" / "shaders" / "glow" / "soft_glow.glsl"
    shader_file.write_text('#include "lib/finite.glsl"\n' + shader)
    result = halation(copy, "nodes", "--check", "acme_glow.soft_glow")
    assert (result.returncode, result.stdout) == (0, "acme_glow.soft_glow: ok\n"), result
    note = "it declares 'mask' itself, so that Halation adds only mix"
    assert f"acme_glow.soft_glow: {note}\n" in result.stderr
