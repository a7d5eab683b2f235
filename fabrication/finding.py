"""Findings: what a person should know about a design, as data and not as exceptions."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Severity(Enum):
    """How much a finding matters; an error makes the command end with 1."""

    INFO = "info"
    WARNING = "warning"
    ERROR = "error"


@dataclass(frozen=True)
class Finding:
    """One remark.

    Parameters
    ----------
    code : short and stable, e.g. "bend-radius".
    severity : info, warning or error.
    where : mark of the part or name of the node.
    value, limit : what was found and what is allowed.
    unit : of both.
    message : one sentence, with advice.
    """

    code: str
    severity: Severity
    where: str
    value: float
    limit: float
    unit: str
    message: str
