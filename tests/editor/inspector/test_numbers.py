"""Number fields without a window: what is typed, dragged, stepped and shown."""

from __future__ import annotations

import ast

import pytest
from halation.editor.fields.arithmetic import evaluate
from halation.editor.fields.numbers import (
    Drag,
    bar,
    describe_value,
    drop_digit,
    edit_text,
    find_step,
    format_number,
    parse_number,
    step_digit,
)
from halation.errors import UsageError
from halation.nodes import Value
from hypothesis import given
from hypothesis import strategies as st

GAIN = Value("gain", "float", 1.0, low=0.0, high=4.0, minimum=0.0, maximum=16.0, unit="ratio")
STOPS = Value("stops", "float", 0.0, low=-10.0, high=10.0, unit="EV", doc="Brightness.")
ANGLE = Value("angle", "float", 0.0, low=0.0, high=360.0, unit="deg")
SEED = Value("seed", "int", 0, low=0, high=1000, minimum=0, unit="count")
WEIGHT = Value("weight", "float", 0.0)


class TestTyping:
    @pytest.mark.parametrize(
        ("text", "number"),
        [
            ("0.5", 0.5),
            (" .5 ", 0.5),
            ("-2", -2.0),
            ("1e-3", 0.001),
            ("0.5+1", 1.5),
            ("(2-3)*4**2", -16.0),
            ("-2**2", -4.0),
            ("2**-1", 0.5),
            ("2^3^0", 2.0),
            ("7/2-1", 2.5),
            ("--3", 3.0),
            ("+1", 11.0),
            ("*2", 20.0),
            ("/4", 2.5),
            ("**2", 100.0),
            ("*2+1", 21.0),
            ("-=4", 6.0),
            ("+= 2", 12.0),
            ("+-3", 7.0),
            ("*=3", 30.0),
            ("*(1+1)", 20.0),
        ],
    )
    def test_arithmetic(self, text, number):
        assert evaluate(text, 10.0) == number

    @pytest.mark.parametrize(
        ("text", "declaration", "number"),
        [
            ("2EV", STOPS, 2.0),
            ("-1.5 stops", STOPS, -1.5),
            ("30deg", ANGLE, 30.0),
            ("0.5turn", ANGLE, 180.0),
            ("90°+1", ANGLE, 91.0),
            ("50%", GAIN, 0.5),
            ("2x", GAIN, 2.0),
            ("7", SEED, 7),
            ("16", GAIN, 16.0),
        ],
    )
    def test_units(self, text, declaration, number):
        assert parse_number(text, 0.0, declaration) == number

    @pytest.mark.parametrize(
        ("text", "declaration", "reason"),
        [
            ("", GAIN, "type a number"),
            ("1+", GAIN, "missing at the end"),
            ("(1", GAIN, r"a '\)' is missing"),
            ("1)", GAIN, r"a '\(' is missing"),
            ("1 2", GAIN, "not expected"),
            ("1/0", GAIN, "divides by zero"),
            ("9**9**9", WEIGHT, "too large"),
            ("1e999", WEIGHT, "too large"),
            ("(-2)**0.5", WEIGHT, "is not a number"),
            ("2px", STOPS, r"'px' does not fit this value: its unit is stops \(EV\)"),
            ("3 foo", GAIN, "'foo' is not a known unit"),
            ("50%", STOPS, "% does not fit"),
            ("17", GAIN, "17 is too large: type a number from 0 to 16"),
            ("-1", GAIN, "-1 is too small"),
            ("1.5", SEED, "1.5 is not a whole number"),
            ("__import__('os')", GAIN, "is not valid in a number"),
            ("a", GAIN, "is not valid in a number"),
            ("1" * 201, GAIN, "too long"),
            ("*", GAIN, "missing"),
            ("1 = 1", GAIN, "'=' is not valid"),
        ],
    )
    def test_mistakes_are_named(self, text, declaration, reason):
        with pytest.raises(UsageError, match=reason):
            parse_number(text, 1.0, declaration)

    @given(
        st.recursive(
            st.floats(0.0, 100.0).map(lambda x: f"{x:.3f}"),
            lambda part: st.tuples(st.sampled_from(["({}+{})", "{}*{}", "({}-{})", "-{}-{}"]), part, part).map(
                lambda found: found[0].format(*found[1:])
            ),
            max_leaves=12,
        )
    )
    def test_it_agrees_with_python(self, text):
        if len(text) <= 200:
            wanted = eval(compile(ast.parse(text, mode="eval"), "", "eval"))
            assert evaluate(text) == pytest.approx(wanted, rel=1e-12, abs=1e-9)

    @given(st.text(max_size=40))
    def test_anything_else_is_a_sentence(self, text):
        try:
            assert isinstance(evaluate(text, 2.0), float)
        except UsageError as error:
            assert str(error)


class TestDragging:
    def test_the_width_of_the_field_is_the_soft_range(self):
        assert Drag(0.0).move(100.0, 100.0, GAIN).number(GAIN) == 4.0
        assert Drag(1.0).move(10.0, 100.0, GAIN).number(GAIN) == 1.4
        assert Drag(1.0).move(10.0, 100.0, GAIN, fine=True).number(GAIN, fine=True) == 1.04

    def test_it_stays_in_the_soft_range_or_where_it_started(self):
        assert Drag(1.0).move(900.0, 100.0, GAIN).number(GAIN) == 4.0
        assert Drag(9.0).move(900.0, 100.0, GAIN).number(GAIN) == 9.0
        assert Drag(9.0).move(-25.0, 100.0, GAIN).number(GAIN) == 8.0

    def test_coming_back_gives_the_old_number_exactly(self):
        there = Drag(0.123456789).move(30.0, 200.0, GAIN)
        assert there.number(GAIN) == 0.72
        assert there.move(-30.0, 200.0, GAIN).number(GAIN) == 0.123456789

    def test_snapping_and_whole_numbers(self):
        assert Drag(0.0).move(33.0, 100.0, GAIN).number(GAIN, snap=True) == 1.4
        assert Drag(3).move(10.0, 200.0, SEED).number(SEED) == 53
        assert isinstance(Drag(3).move(1.0, 200.0, SEED).number(SEED), int)

    def test_steps_are_round(self):
        assert [find_step(item) for item in (GAIN, STOPS, ANGLE, SEED)] == [pytest.approx(0.2), 1.0, 20.0, 50.0]


@pytest.mark.parametrize(
    ("text", "caret", "direction", "wanted"),
    [
        ("1.25", 4, 1, ("1.26", 4)),
        ("1.25", 3, 1, ("1.35", 3)),
        ("1.25", 1, -1, ("0.25", 1)),
        ("1.25", 2, 1, ("2.25", 1)),
        ("0.99", 4, 1, ("1.00", 4)),
        ("9", 1, 1, ("10", 2)),
        ("10", 2, -1, ("9", 1)),
        ("100", 1, 1, ("200", 1)),
        ("-1", 2, 1, ("0", 1)),
        ("0.0", 3, -1, ("-0.1", 4)),
        ("-5", 0, -1, ("-6", 2)),
        ("1+1", 3, 1, ("1+1", 3)),
        ("", 0, 1, ("", 0)),
        (".", 1, 1, (".", 1)),
        (".5", 2, 1, ("0.6", 3)),
    ],
)
def test_arrow_keys_change_the_digit_at_the_caret(text, caret, direction, wanted):
    assert step_digit(text, caret, direction) == wanted


def test_what_is_shown():
    assert [format_number(number, GAIN) for number in (1.0, 0.5, -0.0001, 0.001234, 12.3456)] == [
        "1.00",
        "0.50",
        "-0.0001",
        "0.00123",
        "12.35",
    ]
    assert format_number(-0.0, GAIN) == "0.00"
    assert format_number(7, SEED) == "7"
    assert [edit_text(number) for number in (64.0, 1 / 3, 7)] == ["64", repr(1 / 3), "7"]


def test_a_narrow_field_shows_fewer_digits():
    assert [drop_digit(text) for text in ("0.185", "1.5", "-0.4", "7", "1.2e-05", "-0.0", "—")] == [
        "0.18",
        "2",
        "0",
        "7",
        "1.2e-05",
        "0",
        "—",
    ]


def test_the_bar_starts_at_zero():
    assert bar(1.0, GAIN) == (0.0, 0.25)
    assert bar(5.0, STOPS) == (0.5, 0.75)
    assert bar(-5.0, STOPS) == (0.25, 0.5)
    assert bar(99.0, STOPS) == (0.5, 1.0)
    assert bar(1.0, WEIGHT) is None


def test_the_tooltip():
    assert describe_value(GAIN, "1.00") == "A plain factor; usually 0 to 4; from 0 to 16\nDefault: 1.00"
    assert describe_value(STOPS, "0").splitlines()[0] == "Brightness."
