"""What others read: exit codes, JUnit XML, the page, and pytest with the plugin."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from halation.regression.cases import Case
from halation.regression.junit import write_junit
from halation.regression.report import make_page
from halation.regression.results import Outcome, PictureCheck, PictureViews, RegressionRun, as_json
from halation.resources.sandbox import UNRESTRICTED

CASES = """
[defaults]
graph = "graph.json"
[cases.good]
node = "light"
[cases.bad]
error = "no such thing"
[cases.later]
skip = "waits"
"""


def many(count: int, odd: str = "") -> RegressionRun:
    """Passed cases, and one failure in a hundred with pictures."""
    suite = Path("looks.suite.toml")
    outcomes: list[Outcome] = []
    for index in range(count):
        case = Case(suite, f"case {index}{odd}", Path("g.json"), goldens=())
        fails = index % 100 == 0
        check = PictureCheck(
            Path("g.exr"), 1, sentence=f"too far{odd}", views=PictureViews(b"a" * 30, b"b" * 30, b"c" * 30)
        )
        status = "failed" if fails else "passed"
        outcomes.append(Outcome(case, status, f"too far{odd}" if fails else "", 0.1, (check,) if fails else ()))
    return RegressionRun(outcomes, f"llvmpipe{odd}", 1.0, True, version="0.1.0")


def test_exit_codes(cli, suite, tmp_path) -> None:
    nothing = cli()
    assert nothing.code == 2 and "there is no suite in this folder" in nothing.err
    suite(CASES)
    assert cli("-k", "good").code == 0 and cli("-k", "later").code == 0 and cli().code == 1
    unknown = cli("-k", "gone")
    assert unknown.code == 2 and "none of 3 cases" in unknown.err
    assert cli("--report", "nowhere/r.html").code == 2 and cli("--junit", ".").code == 2
    suite("[cases.a]\ngrph = 1")
    broken = cli("--json")
    assert broken.code == 3 and "did you mean 'graph'?" in broken.json["error"]["message"]


def test_listing_renders_nothing(cli, suite) -> None:
    suite(CASES.replace("graph.json", "gone.json"))
    listed = cli("--list")
    assert listed.code == 0 and len(listed.out.splitlines()) == 3 and "(skipped: waits)" in listed.out
    assert cli("--list", "--json").json["cases"][0]["id"] == "looks.suite.toml::good"


def test_junit_is_what_servers_read(cli, suite, tmp_path) -> None:
    suite(CASES)
    cli("--junit", "junit.xml")
    root = ET.parse(tmp_path / "junit.xml").getroot()
    assert root.tag == "testsuites"
    assert [root.get(name) for name in ("tests", "failures", "errors", "skipped")] == ["3", "1", "0", "1"]
    cases = root.findall("testsuite/testcase")
    assert [case.get("name") for case in cases] == ["good", "bad", "later"]
    assert all(case.get("classname") == "looks" and float(case.get("time", "x")) >= 0.0 for case in cases)
    failure = cases[1].find("failure")
    assert failure is not None and "but it renders" in (failure.get("message") or "")
    skipped = cases[2].find("skipped")
    assert skipped is not None and skipped.get("message") == "waits"
    assert root.find("testsuite/properties/property[@name='device']") is not None


@pytest.mark.parametrize("odd", ["", " <b>&amp;\"'</script><!--", "\x00\x1b\ud800\ufffe", "\u2028größe ☃"])
def test_any_text_goes_into_xml_and_html(tmp_path: Path, odd: str) -> None:
    session = many(3, odd)
    write_junit(session, tmp_path / "j.xml", sandbox=UNRESTRICTED)
    names = [case.get("name") for case in ET.parse(tmp_path / "j.xml").getroot().iter("testcase")]
    kept = re.sub("[\x00-\x08\x0b-\x1f\ud800\ufffe]", "?", odd)
    assert names == [f"case {index}{kept}" for index in range(3)]
    data = data_of(make_page(session))
    assert [case["name"] for case in data["cases"]] == [f"case {index}{odd}" for index in range(3)]


class Outline(HTMLParser):
    """Scripts and what a page would fetch."""

    def __init__(self) -> None:
        super().__init__()
        self.scripts: list[str] = []
        self.fetched: list[str] = []
        self._inside = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._inside = tag == "script"
        self.fetched += [value or "" for name, value in attrs if name in ("src", "href", "srcset")]
        if tag == "script":
            self.scripts.append("")

    def handle_endtag(self, tag: str) -> None:
        self._inside = False

    def handle_data(self, data: str) -> None:
        if self._inside:
            self.scripts[-1] += data


def data_of(text: str) -> dict:
    """What the one script of a page is given."""
    outline = Outline()
    outline.feed(text)
    assert len(outline.scripts) == 1 and outline.fetched == []
    line = next(line for line in outline.scripts[0].split("\n") if line.startswith("const data = "))
    return json.loads(line.removeprefix("const data = ").removesuffix(";"))


def test_a_page_of_a_thousand_cases_holds_pictures_of_failures_only() -> None:
    text = make_page(many(1000))
    data = data_of(text)
    checks = [check for case in data["cases"] for check in case["checks"]]
    assert len(data["cases"]) == 1000 and sum("views" in check for check in checks) == 10
    assert "http" not in text.replace("http-equiv", "") and len(text) < 400_000


def test_json_has_no_numbers_that_json_lacks(cli, suite, tmp_path) -> None:
    suite('[cases.a]\ngraph = "graph.json"\ngolden = {image = "a.exr"}\n')
    cli("--update")
    text = cli("--json").out
    check = json.loads(text, parse_constant=pytest.fail)["cases"][0]["checks"][0]
    assert check["psnr"] is None and check["max_abs"] == 0.0
    assert as_json(many(1))["failed"] == 1


# --- pytest ----------------------------------------------------------------------------------------------------------


def pytest_in(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "pytest", "-p", "no:hypothesispytest", *words]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)


def test_pytest_runs_suites(suite, graph, tmp_path) -> None:
    suite(CASES + '[cases.picture]\ngolden = {image = "goldens/picture.exr"}\n')
    (tmp_path / "test_other.py").write_text("def test_other():\n    assert True\n")
    first = pytest_in(tmp_path, "--halation-update")
    assert "3 passed" in first.stdout and "1 failed" in first.stdout and "1 skipped" in first.stdout, first.stdout
    assert "it should fail with 'no such thing', but it renders" in first.stdout and "Traceback" not in first.stdout
    graph(stops=1.1)
    second = pytest_in(tmp_path, "-k", "picture or good", "-n", "2")
    assert second.returncode == 1 and "1 passed" in second.stdout and "1 failed" in second.stdout, second.stdout
    assert "max_rel 0.0" in second.stdout and "pictures: " in second.stdout
    where = Path(re.findall(r"pictures: (.*)", second.stdout)[0].strip())
    assert sorted(path.name for path in where.iterdir())[0] == "picture.actual.exr"
    assert pytest_in(tmp_path, "--halation-update", "-x", "-k", "picture").returncode == 0
    suite("[cases.a]\ngrph = 1\n")
    broken = pytest_in(tmp_path)
    assert broken.returncode == 2 and "did you mean 'graph'?" in broken.stdout and "Traceback" not in broken.stdout


def test_the_plugin_loads_nothing_where_there_is_no_suite(tmp_path: Path) -> None:
    (tmp_path / "test_other.py").write_text(
        "import sys\n\ndef test_other():\n"
        "    heavy = ('numpy', 'moderngl', 'OpenImageIO', 'msgspec', 'halation.nodes', 'halation.graph')\n"
        "    assert 'halation.regression.plugin' in sys.modules\n"
        "    assert [name for name in heavy if name in sys.modules] == []\n"
    )
    result = pytest_in(tmp_path, "-p", "no:cacheprovider")
    assert result.returncode == 0, result.stdout


@pytest.mark.parametrize("frames", ["", 'frames = "3"'])
def test_a_case_without_goldens_renders_its_first_frame(cli, suite, graph, frames: str) -> None:
    graph()
    suite(f'[cases.look]\ngraph = "graph.json"\n{frames}')
    ended = cli()
    assert ended.code == 0 and "pass  looks.suite.toml::look" in ended.out and "1 passed" in ended.err
    suite(f'[cases.look]\ngraph = "graph.json"\nerror = "no such file"\n{frames}')
    ended = cli()
    assert ended.code == 1 and "it should fail with 'no such file', but it renders" in ended.out


def test_the_first_frame_of_a_case_without_goldens_is_that_of_its_graph(cli, suite, graph, tmp_path: Path) -> None:
    """The only one that is there."""
    text = graph().read_text().replace("shot.exr", "shot.####.exr")
    (tmp_path / "graph.json").write_text(json.dumps({**json.loads(text), "settings": {"frames": [3, 9]}}))
    (tmp_path / "shot.exr").rename(tmp_path / "shot.0003.exr")
    suite('[cases.look]\ngraph = "graph.json"')
    ended = cli()
    assert ended.code == 0 and "1 passed" in ended.err, ended
