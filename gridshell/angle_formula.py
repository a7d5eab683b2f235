"""A formula in a text, worked out over arrays: arithmetic and a few functions, nothing else.

The text is parsed, never run: only numbers, the names that are given, + - * / **, and the functions
listed here are known; whatever else it holds is named with its place.
"""

from __future__ import annotations

import ast
import difflib
from collections.abc import Callable, Mapping
from math import e, pi
from typing import Any

import numpy as np

from gridshell.arrays import Floats
from gridshell.errors import SettingError

LONGEST = 500
"""Characters of a formula at most."""

_CONSTANTS = {"pi": pi, "e": e}
_UNARY: dict[type[ast.unaryop], Callable[[Any], Any]] = {
    ast.UAdd: np.positive,
    ast.USub: np.negative,
}
_BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: np.add,
    ast.Sub: np.subtract,
    ast.Mult: np.multiply,
    ast.Div: np.divide,
    ast.Pow: np.float_power,
}
_FUNCTIONS: dict[str, tuple[Callable[..., Any], int]] = {
    **{name: (getattr(np, name), 1) for name in ("sin", "cos", "tan", "exp", "log", "sqrt")},
    "asin": (np.arcsin, 1),
    "acos": (np.arccos, 1),
    "atan": (np.arctan, 1),
    "abs": (np.abs, 1),
    "atan2": (np.arctan2, 2),
    "hypot": (np.hypot, 2),
    "min": (np.minimum, 2),
    "max": (np.maximum, 2),
    "clip": (np.clip, 3),
}
"""By name, with the number of arguments."""


def parsed(text: str, names: tuple[str, ...]) -> ast.expr:
    """The tree of *text*, whose every node is allowed.

    Raises
    ------
    SettingError
        For a text that is too long, does not parse, or holds anything but numbers, *names*,
        arithmetic and the functions of this module; the place is named.
    """
    if len(text) > LONGEST:
        raise _refused("The formula is too long", text[:40], f"{LONGEST} characters")
    try:
        tree = ast.parse(text.strip(), mode="eval").body
    except SyntaxError as error:
        place = f"character {error.offset or 1}"
        raise _refused(f"The formula does not parse at {place}", text, "arithmetic") from None
    except (RecursionError, MemoryError, ValueError):
        raise _refused("The formula does not parse", text[:40], "arithmetic") from None
    _check(tree, names)
    return tree


def worked_out(tree: ast.expr, values: Mapping[str, Floats]) -> Floats:
    """*tree* over the arrays *values*, all of one shape; inf or nan where it has no value."""
    with np.errstate(all="ignore"):
        found = np.asarray(_value(tree, {**_CONSTANTS, **values}), dtype=np.float64)
    shape = next(iter(values.values())).shape
    return np.array(np.broadcast_to(found, shape))


def _check(node: ast.expr, names: tuple[str, ...]) -> None:
    match node:
        case ast.Constant(value=value) if type(value) in (int, float):
            return
        case ast.Name(id=name):
            if name not in names and name not in _CONSTANTS:
                raise _unknown("name", name, node, [*names, *_CONSTANTS])
        case ast.UnaryOp(op=sign, operand=operand) if type(sign) in _UNARY:
            _check(operand, names)
        case ast.BinOp(left=left, op=sign, right=right) if type(sign) in _BINARY:
            _check(left, names)
            _check(right, names)
        case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]):
            if name not in _FUNCTIONS:
                raise _unknown("function", name, node, list(_FUNCTIONS))
            count = _FUNCTIONS[name][1]
            if len(arguments) != count:
                what = f"The function {name} takes another number of arguments"
                raise _refused(what, str(len(arguments)), str(count))
            for argument in arguments:
                _check(argument, names)
        case _:
            what = f"The formula holds what is no arithmetic, at character {node.col_offset + 1}"
            raise _refused(what, ast.unparse(node)[:40], f"numbers, {', '.join(names)}, functions")


def _value(node: ast.expr, values: Mapping[str, Any]) -> Any:
    match node:
        case ast.Constant(value=value):
            return float(value)  # type: ignore[arg-type]
        case ast.Name(id=name):
            return values[name]
        case ast.UnaryOp(op=sign, operand=operand):
            return _UNARY[type(sign)](_value(operand, values))
        case ast.BinOp(left=left, op=operator, right=right):
            return _BINARY[type(operator)](_value(left, values), _value(right, values))
        case ast.Call(func=ast.Name(id=name), args=arguments):
            return _FUNCTIONS[name][0](*(_value(argument, values) for argument in arguments))
    raise AssertionError("the tree was checked")


def _unknown(kind: str, name: str, node: ast.expr, known: list[str]) -> SettingError:
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    return _refused(
        f"The formula holds an unknown {kind} at character {node.col_offset + 1}",
        name,
        ", ".join(known),
        near[0] if near else None,
    )


def _refused(what: str, value: str, limit: str, advice: str | None = None) -> SettingError:
    return SettingError(what, where="formula", value=repr(value), limit=limit, advice=advice)
