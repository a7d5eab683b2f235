import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gridshell import SettingError
from gridshell.angle_formula import LONGEST, parsed, worked_out

X = np.array([-2.0, 0.5, 3.0])
Y = np.array([1.0, 4.0, 9.0])


def value(text):
    return worked_out(parsed(text, ("x", "y")), {"x": X, "y": Y})


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("60", np.full(3, 60.0)),
        ("-x + 2*y/4 - +3", -X + 2 * Y / 4 - 3),
        ("x**2 - y ** 0.5", X**2 - np.sqrt(Y)),
        ("min(x, y) + max(x, 1)", np.minimum(X, Y) + np.maximum(X, 1)),
        ("sin(pi*x) * cos(x) + tan(x/9)", np.sin(np.pi * X) * np.cos(X) + np.tan(X / 9)),
        ("clip(x, -1, 1) + abs(x) + hypot(x, y)", np.clip(X, -1, 1) + abs(X) + np.hypot(X, Y)),
        ("log(y) + exp(-y) + sqrt(y)", np.log(Y) + np.exp(-Y) + Y**0.5),
        ("asin(x/9) + acos(x/9) + atan(x)", np.pi / 2.0 + np.arctan(X)),
        ("atan2(y, x) + e", np.arctan2(Y, X) + np.e),
    ],
)  # fmt: skip
def test_arithmetic_and_functions(text, expected):
    np.testing.assert_allclose(value(text), expected, rtol=1e-14)


def test_what_has_no_value_is_not_finite():
    assert not np.isfinite(value("log(x - 10)")).any()
    assert not np.isfinite(value("1 / (x - x)")).any()
    assert not np.isfinite(value("9 ** 9 ** 9 ** 9")).any()


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("60 +", "does not parse"),
        ("", "does not parse"),
        ("60 60", "does not parse"),
        ("x\0", "does not parse"),
        ("(" * 300, "does not parse"),
        ("q", "unknown name at character 1"),
        ("60 + sine(x)", "unknown function at character 6"),
        ("__import__('os').system('true')", "no arithmetic"),
        ("().__class__", "no arithmetic"),
        ("x.real", "no arithmetic"),
        ("x[0]", "no arithmetic"),
        ("[x for x in y]", "no arithmetic"),
        ("lambda: 1", "no arithmetic"),
        ("'60'", "no arithmetic"),
        ("True", "no arithmetic"),
        ("x if y else 1", "no arithmetic"),
        ("x < 1", "no arithmetic"),
        ("x % 2", "no arithmetic"),
        ("min(x, y=1)", "no arithmetic"),
        ("min(x)", "another number of arguments"),
        ("1" * (LONGEST + 1), "too long"),
    ],
)
def test_anything_else_is_refused_with_its_place(text, what):
    with pytest.raises(SettingError, match=what) as info:
        parsed(text, ("x", "y"))
    assert info.value.where == "formula"


def test_the_nearest_name_is_offered():
    with pytest.raises(SettingError) as info:
        parsed("sqr(x)", ("x",))
    assert info.value.advice == "sqrt"


@given(st.text(max_size=80))
def test_any_text_is_worked_out_or_refused(text):
    try:
        tree = parsed(text, ("x", "y"))
    except SettingError:
        return
    assert worked_out(tree, {"x": X, "y": Y}).shape == (3,)
