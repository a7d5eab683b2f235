"""Project files to begin with, each commented; ``gridshell new`` writes one of them."""

from __future__ import annotations

from importlib.resources import files

from gridshell import SettingError

STARTING_POINTS = {
    "strips": "slotted steel strips on a minimal surface, one angle at every node",
    "ring": "strips around a surface of revolution",
    "surface": "strips on a surface of your own, from a file",
    "mesh": "strips along a quad mesh drawn elsewhere",
    "panels": "flat glass panels on a surface of your own, with support plates",
    "canopy": "equal segments around an axis, angles that change",
    "umbrella": "hinged tubes that open",
}
"""By name, each in a line."""


def starting_point(name: str, *, title: str) -> str:
    """The text of a project file.

    Parameters
    ----------
    name : one of :data:`STARTING_POINTS`.
    title : the project's name in it.

    Raises
    ------
    SettingError
        For another name, with the nearest one.
    """
    import difflib

    if name not in STARTING_POINTS:
        near = difflib.get_close_matches(name, STARTING_POINTS, n=1, cutoff=0.4)
        raise SettingError(
            "There is no such starting point",
            where="START",
            value=repr(name),
            limit=", ".join(STARTING_POINTS),
            advice=near[0] if near else None,
        )
    text = files(__package__).joinpath(f"{name}.toml").read_text(encoding="utf-8")
    quoted = title.replace("\\", "\\\\").replace('"', '\\"')
    return f"# {STARTING_POINTS[name][0].upper()}{STARTING_POINTS[name][1:]}.\n" + text.replace(
        'name = "NAME"', f'name = "{quoted}"'
    )
