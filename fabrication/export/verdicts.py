"""The verdict on a design in words, and its findings as people read them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from fabrication.finding import Severity
from fabrication.words import finite, plural, raised

_GRADES = [grade.value for grade in (Severity.ERROR, Severity.WARNING, Severity.INFO)]


def verdict(findings: Sequence[Mapping[str, Any]] | None) -> tuple[str, str]:
    """The worst severity, or "good" or "unknown", and the line that says so.

    Parameters
    ----------
    findings : of ``report.json``; None where the design was not checked.
    """
    if findings is None:
        return "unknown", "Not checked"
    if not findings:
        return "good", "Good: no findings"
    grades = [_GRADES[_gravity(finding)] for finding in findings]
    counts = ", ".join(plural(grades.count(g), g) for g in _GRADES if g in grades)
    text = f"{plural(len(findings), 'finding')} ({counts})"
    worst = _GRADES[min(map(_gravity, findings))]
    return ("good", f"Good, with {text}") if worst == Severity.INFO.value else (worst, text)


def finding_groups(findings: Sequence[Mapping[str, Any]]) -> list[list[dict[str, Any]]]:
    """The findings as people read them, those of one severity and code together, gravest first."""
    groups: dict[tuple[int, Any], list[dict[str, Any]]] = {}
    for finding in sorted(findings, key=_gravity):
        key = _gravity(finding), finding.get("code")
        groups.setdefault(key, []).append(_readable(finding))
    return list(groups.values())


def _gravity(finding: Mapping[str, Any]) -> int:
    """0 for an error, and for what is no known severity."""
    grade = finding.get("severity")
    return _GRADES.index(grade) if grade in _GRADES else 0


def _readable(finding: Mapping[str, Any]) -> dict[str, Any]:
    """*finding* with twist in degrees per metre, as its message says it, and raised exponents."""
    shown = {key: raised(text) if isinstance(text, str) else text for key, text in finding.items()}
    if finding.get("unit") == "rad/mm":
        values = {key: finding[key] for key in ("value", "limit") if finite(finding.get(key))}
        shown |= {key: float(np.degrees(v)) * 1000.0 for key, v in values.items()}
        shown["unit"] = "degrees/m"
    return shown
