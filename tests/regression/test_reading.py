"""What suite files say, what they must not say, and which cases -k means."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest
from halation.errors import DocumentError, HalationError, UsageError
from halation.regression.selection import parse_expression
from halation.regression.suites import find_suites, load_suite
from halation.resources.sandbox import UNRESTRICTED, Sandbox
from hypothesis import given
from hypothesis import strategies as st


@pytest.mark.parametrize(
    ("text", "path", "said"),
    [
        ("", "cases", "there is no case"),
        ("[cases", "", "not valid TOML"),
        ("[cases.a]\ngraph='g.json'\n[cases.a]\ngraph='g.json'", "", "not valid TOML"),
        ("cases = 3", "cases", "a table is needed"),
        ("[case.a]\ngraph='g.json'", "case", "did you mean 'cases'?"),
        ("[cases.a]\n", "cases.a.graph", "which graph?"),
        ("[cases.a]\ngraph = 3", "cases.a.graph", "text in quotes is needed; this is the number 3"),
        ("[cases.a]\ngraph='g.json'\ntolerence=1", "cases.a.tolerence", "did you mean 'tolerance'?"),
        ("[cases.a]\ngraph='g.json'\ntolerance='x'", "cases.a.tolerance", "a number is needed; this is the text 'x'"),
        ("[cases.a]\ngraph='g.json'\ntolerance=nan", "cases.a.tolerance", "a number is needed"),
        ("[cases.a]\ngraph='g.json'\ntolerance=true", "cases.a.tolerance", "this is true"),
        ("[cases.a]\ngraph='g.json'\nmetric='sim'", "cases.a.metric", "did you mean 'ssim'?"),
        ("[cases.a]\ngraph='g.json'\nfailing=200", "cases.a.failing", "200 is not within 0 and 100"),
        ("[cases.a]\ngraph='g.json'\nfailing=2\nmetric='flip'", "cases.a.failing", "not with flip"),
        ("[cases.a]\ngraph='g.json'\nscale=0", "cases.a.scale", "0 is not within 0 and 1"),
        ("[cases.a]\ngraph='g.json'\nsize='12'", "cases.a.size", "WIDTHxHEIGHT"),
        ("[cases.a]\ngraph='g.json'\nframe=1.5", "cases.a.frame", "a whole number is needed"),
        ("[cases.a]\ngraph='g.json'\nframe=1\nframes='1-2'", "cases.a.frames", "not both"),
        ("[cases.a]\ngraph='g.json'\nframes=[]", "cases.a.frames", "whole numbers are needed"),
        ("[cases.a]\ngraph='g.json'\nframes='x'", "cases.a.frames", "x"),
        ("[cases.a]\ngraph='g.json'\ninputs={a=true}", "cases.a.inputs.a", "a file, a number"),
        ("[cases.a]\ngraph='g.json'\ninputs=1", "cases.a.inputs", "a table is needed"),
        ("[cases.a]\ngraph='g.json'\nallow=['blak']", "cases.a.allow", "did you mean 'black'?"),
        ("[cases.a]\ngraph='g.json'\nallow='black'", "cases.a.allow", "a list is needed"),
        ("[cases.a]\ngraph='g.json'\nerror=''", "cases.a.error", "give some words"),
        ("[cases.a]\ngraph='g.json'\nerror='x'\ngolden='a.exr'", "cases.a.golden", "gives no picture"),
        ("[cases.a]\ngraph='g.json'\ngolden={a='x.exr', b='x.exr'}", "cases.a.golden", "a file of its own"),
        ("[cases.a]\ngraph='g-*.json'", "cases.a.graph", "no file is called g-*.json"),
        ("[cases.a]\ngraph='/no/such/folder/*.json'", "cases.a.graph", "no file is called /no/such/folder/*.json"),
        ("[cases.a]\ngraph='a***.json'", "cases.a.graph", "no file is called a***.json"),
        ("[defaults]\nskip='x'\n[cases.a]\ngraph='g.json'", "defaults.skip", "there is no such key"),
        ("[defaults]\ngolden='x.exr'\n[cases.a]\ngraph='g.json'\n[cases.b]\ngraph='g.json'", "cases.b", "{case}"),
    ],
)
def test_a_fault_names_file_and_key(tmp_path: Path, text: str, path: str, said: str) -> None:
    file = tmp_path / "a.suite.toml"
    file.write_text(text)
    with pytest.raises(DocumentError) as found:
        load_suite(file, sandbox=UNRESTRICTED)
    assert found.value.file == str(file) and found.value.path == path and said in found.value.fault


@pytest.mark.parametrize("pattern", ["../secret/*.json", "{above}/*/*.json"])
def test_wildcards_tell_nothing_of_what_lies_outside_of_the_root(tmp_path: Path, pattern: str) -> None:
    """The graphs there could not be read, but each was a case of its name."""
    (tmp_path / "secret").mkdir()
    (tmp_path / "secret" / "plan.json").touch()
    file = tmp_path / "jail" / "a.suite.toml"
    file.parent.mkdir()
    file.write_text(f"[cases.a]\ngraph='{pattern.format(above=tmp_path.as_posix())}'")
    with pytest.raises(DocumentError, match="lies outside of") as refused:
        load_suite(file, sandbox=Sandbox(str(file.parent)))
    assert refused.value.path == "cases.a.graph" and "plan" not in str(refused.value)


def test_defaults_are_mixed_in(tmp_path: Path) -> None:
    file = tmp_path / "a.suite.toml"
    file.write_text("""
[defaults]
graph = "sub/g.json"
golden = "goldens/{case}-{graph}.exr"
metric = "psnr"
tolerance = 30
size = [64, 32]
set = {"a.x" = 1, "a.y" = 2}
[cases.one]
set = {"a.y" = 3}
[cases.two]
metric = "ssim"
frames = [3, 1, 3]
[cases.three]
golden = ""
inputs = {beauty = "x.exr:Depth", amount = 2, tint = [1, 0.5, 0]}
""")
    one, two, three = load_suite(file, sandbox=UNRESTRICTED)
    assert one.graph == tmp_path / "sub/g.json" and one.goldens[0].path == tmp_path / "goldens/one-g.exr"
    assert (one.metric, one.tolerance, one.size, one.values) == ("psnr", 30.0, (64, 32), {"a.x": 1, "a.y": 3})
    assert (two.metric, two.tolerance, two.frames) == ("ssim", 0.99, (3, 1))
    assert three.goldens == () and three.inputs == {
        "beauty": str(tmp_path / "x.exr:Depth"),
        "amount": 2.0,
        "tint": (1.0, 0.5, 0.0),
    }
    assert one.id == f"{file.as_posix()}::one"


def test_suites_are_found_below_folders(tmp_path: Path) -> None:
    for name in ("b.suite.toml", "sub/a.suite.toml", ".git/no.suite.toml", "sub/other.toml"):
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text("")
    assert find_suites([tmp_path]) == (tmp_path / "b.suite.toml", tmp_path / "sub/a.suite.toml")
    for wrong in (tmp_path / "sub/other.toml", tmp_path / "gone.suite.toml", tmp_path / ".git/none"):
        with pytest.raises(UsageError, match=wrong.name):
            find_suites([wrong])
    (tmp_path / "empty").mkdir()
    with pytest.raises(UsageError, match="there is no suite in this folder"):
        find_suites([tmp_path / "empty"])


TREES = st.recursive(
    st.sampled_from(["ab", "b", "c"]),
    lambda inner: st.one_of(st.tuples(st.just("not"), inner), st.tuples(st.sampled_from(["and", "or"]), inner, inner)),
    max_leaves=6,
)


def spelled(tree: object) -> str:
    match tree:
        case ("not", inner):
            return f"not {spelled(inner)}"
        case (str() as word, left, right):
            return f"({spelled(left)} {word} {spelled(right)})"
        case _:
            return str(tree)


def meant(tree: object, name: str) -> bool:
    match tree:
        case ("not", inner):
            return not meant(inner, name)
        case ("and", left, right):
            return meant(left, name) and meant(right, name)
        case ("or", left, right):
            return meant(left, name) or meant(right, name)
        case _:
            return str(tree) in name


@given(TREES)
def test_selection_is_logic(tree: object) -> None:
    chooses = parse_expression(spelled(tree))
    for letters in itertools.product(("", "a"), ("", "b"), ("", "c")):
        assert chooses("".join(letters)) == meant(tree, "".join(letters))


@pytest.mark.parametrize(
    ("text", "name", "expected"),
    [
        ("not a and b", "b", True),
        ("a or b and c", "a", True),
        ("a or b and c", "b", False),
        ("A", "xax", True),
    ],
)
def test_and_binds_tighter_than_or(text: str, name: str, expected: bool) -> None:
    assert parse_expression(text)(name) is expected


@given(st.text(alphabet="ab ()andort", max_size=14))
def test_any_expression_is_understood_or_refused(text: str) -> None:
    try:
        assert parse_expression(text)("ab") in (True, False)
    except UsageError as fault:
        assert "parentheses" in str(fault)


@given(st.text(max_size=60))
def test_any_text_is_read_or_refused(tmp_path_factory: pytest.TempPathFactory, text: str) -> None:
    path = tmp_path_factory.getbasetemp() / "any.suite.toml"
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    with pytest.raises(HalationError):
        load_suite(path, sandbox=UNRESTRICTED)
