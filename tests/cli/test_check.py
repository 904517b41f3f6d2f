"""`halation check`, `halation schema`: what they find, where, how it is told and how they end."""

from __future__ import annotations

import importlib
import io
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from halation import document
from halation.document.schema import schema
from halation.lint.checking import RULES
from halation.nodes import catalogue
from halation.resources.sandbox import UNRESTRICTED
from json_schemas import make_validator

ROOT = Path(__file__).parents[2]


@pytest.fixture
def tidy(graphs):
    """`tidy(...)` is `graphs(...)` in the canonical layout."""

    def made(name="graph.json", **parts):
        path = graphs(name, **parts)
        document.save(document.load(path, sandbox=UNRESTRICTED), path, sandbox=UNRESTRICTED)
        return path

    return made


def lines(result):
    """(file, line, severity, rule) of what was printed."""
    found = []
    for line in result.out.splitlines():
        if not line.endswith(": ok"):
            place, severity, rest = line.split(": ", 2)
            file, _, number = place.rpartition(":")
            found.append((Path(file).name, int(number), severity, rest.rpartition(" [")[2].removesuffix("]")))
    return found


def line_of(path: Path, words: str) -> int:
    return next(number for number, line in enumerate(path.read_text().splitlines(), 1) if words in line)


def test_a_good_graph(cli, tidy):
    path = tidy()
    result = cli("check", path)
    assert (result.code, result.out, result.err) == (0, f"{path}: ok\n", "")
    assert cli("check", path, "--json").json == {"graphs": [{"graph": str(path), "exit_code": 0, "problems": []}]}


def test_every_problem_of_every_file_and_the_worst_code(cli, tidy, graphs, tmp_path):
    good = tidy("good.json")
    bad = graphs("bad.json", nodes={"a": {"type": "nonsense"}, "vig": {"type": "vignette", "values": {"amount": 7.0}}})
    missing = tidy("missing.json", inputs={"beauty": {"type": "Image", "file": "no.exr"}})
    broken = tmp_path / "broken.json"
    broken.write_text('{\n"halation": 1,\n')
    result = cli("check", good, bad, missing, broken)
    assert result.code == 4 and result.out.startswith(f"{good}: ok\n")
    assert lines(result) == [
        ("bad.json", 1, "error", "bad-value"),
        ("bad.json", 1, "error", "unknown-type"),
        ("bad.json", 1, "warning", "not-canonical"),
        ("bad.json", 1, "warning", "unfinished-node"),
        ("missing.json", line_of(missing, "no.exr"), "error", "unreadable-file"),
        ("broken.json", 2, "error", "syntax"),
    ]
    assert result.err == "4 graphs: 4 errors, 2 warnings\n"
    told = cli("check", good, bad, missing, broken, "--json").json["graphs"]
    assert [item["exit_code"] for item in told] == [0, 3, 4, 3]
    (problem,) = [item for item in told[1]["problems"] if item["node"] == "vig" and item["socket"] == "amount"]
    assert problem["severity"] == "error" and "7.0" in problem["sentence"] and problem["line"] == 1


def test_pictures_and_layers_that_are_missing(cli, tidy, shot, tmp_path):
    path = tidy(
        inputs={
            "beauty": {"type": "Image", "file": "no.exr"},
            "depth": {"type": "Field", "file": "shot.exr", "layer": "Depht"},
        },
        nodes={"read": {"type": "read_image", "values": {"path": "gone.png"}}},
        outputs={"far": {"type": "Field"}, "more": {"type": "Image"}},
        links={"outputs.far": "inputs.depth", "outputs.more": "read.out"},
    )
    result = cli("check", path)
    assert result.code == 4
    for words, near in (
        (f"{tmp_path / 'no.exr'}: there is no such file", '"no.exr"'),
        (f"{tmp_path / 'gone.png'}: ", '"gone.png"'),
        (f"{shot}: ", '"Depht"'),
    ):
        assert f"{path}:{line_of(path, near)}: error: {words}" in result.out
    assert [rule for *_, rule in lines(result)] == ["unreadable-file"] * 3
    assert cli("check", path, "--off", "unreadable-file").code == 0


def test_inputs_to_be_bound_are_a_warning(cli, tidy):
    path = tidy(
        inputs={"beauty": {"type": "Image"}, "mask": {"type": "Field", "file": "no.exr"}},
        nodes={"merge": {"type": "merge"}},
        links={
            "merge.a": "light.out",
            "merge.b": "inputs.beauty",
            "merge.mask": "inputs.mask",
            "outputs.image": "merge.out",
        },
    )
    result = cli("check", path)
    assert result.code == 4 and sorted(rule for *_, rule in lines(result)) == ["unbound-input", "unreadable-file"]


TWICE = {
    "nodes": {
        "turn": {"type": "transform", "values": {"rotation": 9.0}},
        "move": {"type": "transform", "values": {"rotation": 1.0}},
    },
    "links": {
        "turn.image": "inputs.beauty",
        "light.image": "turn.out",
        "move.image": "light.out",
        "outputs.image": "move.out",
    },
}


def test_warnings_fail_only_where_they_are_asked_to(cli, tidy):
    path = tidy(**TWICE)
    for words, code, rules in (
        ((), 0, ["filtering-twice"]),
        (("--strict",), 3, ["filtering-twice"]),
        (("--strict", "--off", "filtering-twice"), 0, []),
        (("--off", "loop", "--off", "filtering-twice"), 0, []),
    ):
        result = cli("check", path, *words)
        assert (result.code, [rule for *_, rule in lines(result)]) == (code, rules)
        assert cli("check", path, *words, "--json").json["graphs"][0]["exit_code"] == code
    assert lines(cli("check", path))[0][1] == line_of(path, '"move": {')


def test_a_file_says_what_is_meant(cli, tidy):
    def rules(**allow):
        path = tidy(**TWICE, settings={"allow": {name.replace("_", "-"): why for name, why in allow.items()}})
        assert document.load(path, sandbox=UNRESTRICTED).settings.allow and '"allow"' in path.read_text()
        return sorted(rule for *_, rule in lines(cli("check", path)))

    assert rules(filtering_twice="soft is the look") == rules(**{"filtering_twice:move": "soft is the look"}) == []
    assert rules(**{"filtering_twice:turn": "not this one"}) == ["filtering-twice", "stale-allow"]
    for name in ("filtring_twice", "loop", "unused_branch"):
        assert rules(**{"filtering_twice": "meant", name: "?"}) == ["stale-allow"]
    # Whether a file is there differs from place to place, so nothing is said of what is allowed for that.
    assert rules(filtering_twice="meant", unbound_input="bound by the farm", outside_repository="by a script") == []


def test_what_is_allowed_in_vain_is_named_at_its_line(cli, tidy):
    path = tidy(**TWICE, settings={"allow": {"filtering-twice": "meant", "loop": "?"}})
    ((_, line, *_, rule),) = lines(cli("check", path))
    assert (line, rule) == (line_of(path, '"loop": '), "stale-allow")


def test_folders_patterns_and_names(cli, tidy, tmp_path, monkeypatch):
    (tmp_path / "deep" / "er").mkdir(parents=True)
    (tmp_path / ".git").mkdir()
    for name in ("a.json", "deep/b.json", "deep/er/c with ü.JSON", ".git/d.json"):
        tidy(name, inputs={"beauty": {"type": "Image", "file": os.path.relpath("shot.exr", Path(name).parent)}})
    for name, text in (
        ("deep/package.json", '{"dependencies": {"halation": "1"}}'),
        ("deep/list.json", "[1]"),
        ("deep/notes.txt", "{"),
        ("deep/bad.json", "{]"),
        ("deep/odd.json", "\xff"),
    ):
        (tmp_path / name).write_text(text, "latin-1")
    monkeypatch.chdir(tmp_path)

    def files(*words):
        return [item["graph"] for item in cli("check", *words, "--json").json["graphs"]]

    assert files(".") == ["a.json", "deep/b.json", "deep/er/c with ü.JSON"]
    assert files("deep", "a.json", "deep/b.json", tmp_path) == ["deep/b.json", "deep/er/c with ü.JSON", "a.json"]
    assert files("**/?.json") == ["a.json", "deep/b.json"]
    assert files("deep/*") == [
        "deep/b.json",
        "deep/bad.json",
        "deep/er/c with ü.JSON",
        "deep/list.json",
        "deep/notes.txt",
        "deep/odd.json",
        "deep/package.json",
    ]
    result = cli("check", ".")
    assert (result.code, result.out, result.err) == (0, "", "3 graphs: 0 errors, 0 warnings\n")
    assert cli("check", "no.json").code == cli("check", "deep/list.json").code == cli("check", "no*.json").code == 3
    (tmp_path / "empty").mkdir()
    assert (cli("check", "empty").code, cli("check", "empty").err) == (0, "no graphs were found\n")
    (tmp_path / "deep" / "cut.json").write_text('{"halation": 1, "nodes": {')
    assert cli("check", "deep").code == 3


def test_damage_that_git_does(cli, tidy, tmp_path):
    path = tidy()
    text = path.read_text()
    path.write_text(text.replace('  "links"', '<<<<<<< ours\n  "links"').replace("\n}\n", "\n>>>>>>> theirs\n}\n"))
    assert lines(cli("check", path)) == [(path.name, line_of(path, "<<<<"), "error", "conflict-markers")]
    path.write_text(text.replace('  "nodes": {', '  "links": {},\n  "nodes": {'))
    assert lines(cli("check", path)) == [(path.name, line_of(path, '"links": {}'), "error", "double-key")]
    path.write_text(text.replace("\n", "\r\n"), newline="")
    assert lines(cli("check", path)) == []
    path.write_text(text.replace('"stops": 1.0', '"stops":  1.0'))
    assert lines(cli("check", path)) == [(path.name, line_of(path, '"stops"'), "warning", "not-canonical")]
    path.write_text(text)
    (tmp_path / "shot.exr").write_text("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n")
    result = cli("check", path)
    assert lines(result) == [(path.name, line_of(path, "shot.exr"), "error", "lfs-pointer")] and result.code == 4


def test_what_lies_outside_of_the_root_is_not_looked_into(cli, graphs, tmp_path):
    """Whether a file there is a pointer of git LFS must not show."""
    (tmp_path / "root").mkdir()
    outside = tmp_path / "secret.exr"
    path = graphs("root/graph.json", inputs={"beauty": {"type": "Image", "file": "../secret.exr"}})
    sentences: list[str] = []
    for text in ("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n", "no pointer", ""):
        outside.write_text(text)
        sentences.append(cli("check", path, "--root", path.parent).out)
    assert len({*sentences}) == 1 and "lies outside of" in sentences[0] and "lfs" not in sentences[0]


def test_paths_that_a_clone_does_not_have(cli, tidy, shot, tmp_path):
    repository = tmp_path / "repository"
    (repository / ".git").mkdir(parents=True)
    (repository / "Shots").mkdir()
    (repository / "Shots" / "One.exr").write_bytes(shot.read_bytes())

    def rules(file):
        path = tidy("repository/graph.json", inputs={"beauty": {"type": "Image", "file": file, "layer": "Combined"}})
        result = cli("check", path)
        assert all(line == line_of(path, '"file"') for _, line, _, _ in lines(result))
        return sorted({rule for *_, rule in lines(result)}), result.out

    assert rules("Shots/One.exr")[0] == rules("../repository/Shots/One.exr")[0] == []
    assert rules("../shot.exr")[0] == ["outside-repository"]
    found, said = rules("shots/one.exr")
    assert "path-case" in found and "'Shots/One.exr'" in said
    found, said = rules("shots/one.####.exr")
    assert "path-case" in found and "'Shots/one.####.exr'" in said
    assert rules(str(shot))[0] == ["absolute-path"]


def test_groups_in_the_file_and_beside_it(cli, tidy):
    body = {
        "inputs": {"a": {"type": "Image"}},
        "outputs": {"b": {"type": "Image"}},
        "nodes": {"dim": {"type": "vignette", "values": {"amount": 99.0}}},
        "links": {"dim.image": "inputs.a", "outputs.b": "dim.out"},
    }
    tidy(
        "inner.json",
        **{
            **body,
            "links": {
                "light.image": "inputs.a",
                "dim.image": "inputs.a",
                "outputs.b": "dim.out",
                "outputs.image": "light.out",
            },
        },
    )
    links = {"in.a": "inputs.beauty", "outputs.image": "in.b", "light.image": "inputs.beauty"}
    here = tidy("here.json", nodes={"in": {"type": "group", "graph": body}}, links=links)
    there = tidy("there.json", nodes={"in": {"type": "group", "path": "inner.json"}}, links=links)
    assert ("here.json", line_of(here, "99.0"), "error", "bad-value") in lines(cli("check", here))
    assert ("there.json", line_of(there, "inner.json"), "error", "bad-value") in lines(cli("check", there))
    (there.parent / "inner.json").unlink()
    assert lines(cli("check", there)) == [("there.json", line_of(there, "inner.json"), "error", "missing-group")]


def test_the_key_for_editors_of_text_is_kept_without_a_word(cli, tidy):
    path = tidy()
    path.write_text(path.read_text().replace("{\n", '{\n  "$schema": "./graph.schema.json",\n', 1))
    assert cli("check", path).out == f"{path}: ok\n"
    document.save(document.load(path, sandbox=UNRESTRICTED), path, sandbox=UNRESTRICTED)
    assert json.loads(path.read_text())["$schema"] == "./graph.schema.json" and cli("check", path).code == 0


def test_rules_are_listed(cli):
    assert [line.split(" (")[0] for line in cli("check", "--rules").out.splitlines()] == [*RULES]
    assert [rule["rule"] for rule in cli("check", "--rules", "--json").json["rules"]] == [*RULES]


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ((), "no graph is given"),
        (("x.json", "--off", "filtering"), "did you mean 'filtering-twice'"),
        (("x.json", "--json", "--sarif", "-"), "choose one"),
    ],
)
def test_a_command_line_that_makes_no_sense(cli, words, says):
    result = cli("check", *words)
    assert result.code == 2 and says in result.err and "Traceback" not in result.err


def test_sarif(cli, tidy, tmp_path, monkeypatch):
    """What the standard requires (2.1.0, sections 3.13 to 3.52), and what code hosts need on top."""
    (tmp_path / ".git").mkdir()
    (tmp_path / "a b").mkdir()
    tidy("a b/ü.json", **TWICE, inputs={"beauty": {"type": "Image", "file": "no.exr"}})
    monkeypatch.chdir(tmp_path / "a b")
    assert cli("check", ".", "--sarif", "log.sarif").code == 4
    log = json.loads(Path("log.sarif").read_text())
    assert log["version"] == "2.1.0" and log["$schema"].endswith("sarif-2.1.0.json")
    (run,) = log["runs"]
    rules = run["tool"]["driver"]["rules"]
    assert run["tool"]["driver"]["name"] and [rule["id"] for rule in rules] == [*RULES]
    for rule in rules:
        assert rule["help"]["text"] and rule["fullDescription"]["text"] and rule["shortDescription"]["text"]
        assert rule["defaultConfiguration"]["level"] in ("error", "warning")
    told = {(item["ruleId"], item["level"]) for item in run["results"]}
    assert told == {("filtering-twice", "warning"), ("unreadable-file", "error")}
    for item in run["results"]:
        assert rules[item["ruleIndex"]]["id"] == item["ruleId"] and item["message"]["text"]
        (location,) = item["locations"]
        place = location["physicalLocation"]
        assert place["artifactLocation"]["uri"] == "a%20b/%C3%BC.json" and place["region"]["startLine"] > 1
    prints = {item["ruleId"]: item["partialFingerprints"] for item in run["results"]}
    Path("ü.json").write_text("\n\n" + Path("ü.json").read_text())
    again = cli("check", ".", "--sarif", "-", "--off", "not-canonical").json["runs"][0]["results"]
    assert {item["ruleId"]: item["partialFingerprints"] for item in again} == prints
    monkeypatch.chdir("/")
    (outside, _) = cli("check", tmp_path / "a b", "--sarif", "-", "--off", "not-canonical").json["runs"][0]["results"]
    uri = outside["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]
    assert uri == (tmp_path / "a b" / "ü.json").as_uri() or not uri.startswith("/")


def test_standard_input(cli, tidy, monkeypatch):
    path = tidy()
    text = path.read_text().replace('"exposure"', '"exposrue"')
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(text.encode())))
    result = cli("check", "-")
    assert result.code == 3 and lines(result) == [("-", line_of(path, '"exposure"'), "error", "unknown-type")]
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(b"\xff")))
    assert cli("check", "-").code == 3


def test_a_picture_is_looked_at_once_however_many_graphs_name_it(cli, tidy, shot, monkeypatch):
    headers, looked = importlib.import_module("halation.media.info"), []
    real = headers.read_info
    monkeypatch.setattr(headers, "read_info", lambda path, sandbox: looked.append(path) or real(path, sandbox))
    paths = [
        tidy(f"{number}.json", nodes={"light": {"type": "exposure", "values": {"stops": float(number)}}})
        for number in range(1, 6)
    ]
    assert cli("check", *paths).code == 0 and looked == [str(shot)]
    shot.unlink()
    result = cli("check", *paths)
    assert result.code == 4 and [rule for *_, rule in lines(result)] == ["unreadable-file"] * 5


def test_libraries_for_pictures_are_left_alone_where_there_is_none(tidy):
    """A pattern makes its own picture; what a whole folder costs is then reading and compiling."""
    path = tidy(inputs={"beauty": {"type": "Image", "default": [1.0, 1.0, 1.0, 1.0]}})
    code = (
        "import sys; from halation.cli.program import run; code = run(['check', sys.argv[1]]); "
        "print(code, [name for name in ('OpenImageIO', 'PyOpenColorIO', 'moderngl') if name in sys.modules])"
    )
    result = subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True)
    assert result.stdout.splitlines()[-1] == "0 []", result


def test_the_schema_is_printed(cli, tidy):
    for words in ((), ("--json",)):
        printed = json.loads(cli("schema", *words).out)
        assert printed == json.loads(json.dumps(schema(catalogue())))
        assert make_validator(printed).is_valid(json.loads(tidy().read_text()))
