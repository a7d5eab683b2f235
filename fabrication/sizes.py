"""Refusing sizes and distances that cannot be."""

from __future__ import annotations

import numpy as np

from gridshell import SettingError


def require_positive(key: str, value: float) -> None:
    """Raise SettingError unless *value* is a positive, finite number."""
    if not (np.isfinite(value) and value > 0.0):
        raise SettingError(
            "A size must be positive",
            where=key,
            value=f"{value:g}",
            limit="> 0",
            advice="check the sign and the unit",
        )


def require_distance(key: str, value: float) -> None:
    """Raise SettingError unless *value* is nought or more, and finite."""
    if not (np.isfinite(value) and value >= 0.0):
        raise SettingError(
            "A distance cannot be negative",
            where=key,
            value=f"{value:g} mm",
            limit=">= 0",
            advice="check the sign",
        )
