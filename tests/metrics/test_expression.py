"""Formulas: what they mean, and that nothing else is understood."""

import pickle

import numpy as np
import pytest

from metrics import Expression, MetricError, tensor

POINTS = np.random.default_rng(0).uniform(-1, 1, (50, 2))
X, Y = POINTS.T


def sizes(formula):
    return tensor.sizes(Expression(formula)(POINTS))[:, 0]


@pytest.mark.parametrize(
    ("formula", "wanted"),
    [
        ("0.1", 0.1 + 0 * X),
        ("  2\n", 2 + 0 * X),
        ("0.01 + 0.1*sqrt(x**2+y**2)", 0.01 + 0.1 * np.hypot(X, Y)),
        ("2 - -x", 2 + X),
        ("+x**2 / 2 + 1", X**2 / 2 + 1),
        ("2**-x**2", 2.0 ** (-(X**2))),
        ("where(x < 0, 0.1, 0.2)", np.where(X < 0, 0.1, 0.2)),
        ("where(1 < 2, 0.5, 1/0)", 0.5 + 0 * X),
        ("where(-0.5 < x <= y, 1, 2)", np.where((X > -0.5) & (X <= Y), 1, 2)),
        ("where(x < 0 and not y < 0 or x == y, 1, 2)", np.where((X < 0) & (Y >= 0), 1, 2)),
        ("2 + (x > 0)*2 - (y > 0)", 2 + (X > 0) * 2.0 - (Y > 0)),
        ("1.5 + -(x > 0)", 1.5 - (X > 0)),
        ("min(x + 2, y + 2, 2)", np.minimum(np.minimum(X + 2, Y + 2), 2)),
        ("max(x, y) + 2", np.maximum(X, Y) + 2),
        ("atan2(y, x) + 4", np.arctan2(Y, X) + 4),
        ("exp(log(e)*x) + pi", np.exp(X) + np.pi),
        (
            "abs(sin(x)) + cos(y)**2 + tanh(y + 2)",
            np.abs(np.sin(X)) + np.cos(Y) ** 2 + np.tanh(Y + 2),
        ),
        ("hypot(x, y) + floor(x) + ceil(y) + 3", np.hypot(X, Y) + np.floor(X) + np.ceil(Y) + 3),
    ],
)
def test_value(formula, wanted):
    np.testing.assert_allclose(sizes(formula), wanted, rtol=1e-12)


def test_three_formulas_are_a_tensor():
    wanted = np.stack([2 + X, 0.1 * Y, 3 + 0 * X], 1)
    np.testing.assert_allclose(Expression("2 + x", "0.1*y", "3")(POINTS), wanted)
    np.testing.assert_allclose(Expression("2 + x, 0.1*y, 3")(POINTS), wanted)


@pytest.mark.parametrize(
    ("formula", "message"),
    [
        ("0.01 + 0.1*z", r"'z' at column 12 .* the variables are x, y, .*hypot"),
        ("größe + 1", "'größe' at column 1 "),
        ("'é' + w", r"at column 1 "),
        ("foo(x)", "'foo' at column 1 .* the functions abs"),
        ("sin + 1", "it is a function"),
        ("x^2", r"\*\* for powers"),
        ("x % 2", "the operators are"),
        ("x if y > 0 else 1", r"where\(condition, a, b\)"),
        ("x.real", "'x.real' at column 1"),
        ("x[0]", "not understood"),
        ("[x]", "not understood"),
        ("lambda: x", "not understood"),
        ("(x := 1)", "not understood"),
        ("__import__('os').system('true')", "not understood"),
        ("f'{x}'", "not understood"),
        ("x is y", "the comparisons are"),
        ("True", "only real numbers"),
        ("1j", "only real numbers"),
        ("min(x)", "min takes 2 to 50 arguments, got 1"),
        ("sqrt(x, y)", "sqrt takes 1 argument, got 2"),
        ("max(x, y, key=1)", "no keywords"),
        ("min(*x)", "min takes 2 to 50 arguments, got 1"),
        ("min(*x, y)", "not understood"),
        ("(x + 1", "not valid at column 1"),
        ("x +", "not valid"),
        ("import os", "not valid"),
        ("x = 1", "not valid"),
        ("", "empty"),
        (" \n", "empty"),
        ("\0", "null bytes"),
        ("9" * 400, "too large"),
        ("9" * 5000, "not valid|cannot be parsed"),
        ("1, 2", "not 2"),
        ("1, 2, 3, 4", "not 4"),
        ("(" * 150 + "-" * 150 + "x" + ")" * 150 + "+1" * 120, "nested deeper than 200"),
        ("-" * 5000 + "x", "nested deeper than 200"),
        ("+".join(["x"] * 4000), "nested deeper than 200"),
        ("(" * 2000 + "x" + ")" * 2000, "nested|not valid"),
        ("x + 1 " * 10_000, "60000 characters|59999 characters"),
    ],
)
def test_refused(formula, message):
    with pytest.raises(MetricError, match=message):
        Expression(formula)


@pytest.mark.parametrize(
    ("formula", "message"),
    [
        ("9**9**9**9", "not finite: inf"),
        ("1e400", "not finite: inf"),
        ("x", r"at point \d+ .* is not positive"),
        ("sqrt(x - 5)", "not finite: nan"),
        ("where(x > 0, 1, 1/0*0 + 2)", "not finite: nan"),
        ("x < 5 and x > 4", "not positive: h = 0.0"),
    ],
)
def test_values_that_are_no_sizes_are_refused_where_they_are(formula, message):
    field = Expression(formula)
    with pytest.raises(MetricError, match=message):
        field(POINTS)


@pytest.mark.parametrize("formulas", [(), ("1", "2"), (0.1,), ("1", None, "1")])
def test_one_or_three_strings(formulas):
    with pytest.raises(MetricError, match="formula"):
        Expression(*formulas)


def test_it_can_be_pickled():
    field = Expression("0.1 + x**2")
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(field))(POINTS), field(POINTS))
