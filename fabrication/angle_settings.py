"""What the angle of ``[net]`` stands for, and whether it can be used."""

from __future__ import annotations

import csv
from math import radians
from pathlib import Path

import numpy as np

import gridshell as gs
from fabrication.angle_sections import (
    AngleAlongSection,
    FieldSection,
    FormulaAngleSection,
    RadialAngleSection,
    SampledAngleSection,
)
from fabrication.placing import keyed, placed
from fabrication.remesh_settings import require_file
from fabrication.sections import NetSection, Project
from gridshell.arrays import Floats

Choice = float | str | FieldSection | None


def angle_of(choice: Choice, folder: Path) -> gs.Angle | None:
    """The angle of ``[net]``; a file of samples is looked for in *folder*.

    Raises
    ------
    SettingError, FileError
        For a formula that is none, distances that do not grow, or a file that cannot be used.
    """
    match choice:
        case None:
            return None
        case str():
            return gs.FormulaAngle(choice)
        case RadialAngleSection():
            first, last = map(radians, choice.angles)
            return gs.RadialAngle(choice.centre, choice.radii, (first, last))
        case AngleAlongSection():
            angles = tuple(map(radians, choice.angles))
            return gs.AngleAlong(choice.direction, choice.stations, angles)
        case FormulaAngleSection():
            return gs.FormulaAngle(choice.formula, choice.centre)
        case SampledAngleSection():
            places, values = _samples(folder / choice.file)
            return gs.SampledAngle(places * gs.Unit.named(choice.unit).value, values)
    return radians(choice)


def conditions_of(net: NetSection) -> tuple[gs.Condition, ...]:
    """The conditions of ``[net]`` on an asymptotic net besides its angle."""
    found: list[gs.Condition] = []
    if net.angle_between is not None:
        low, high = map(radians, net.angle_between)
        found.append(gs.AngleBetween(low, high))
    if net.near_rhombi:
        found.append(gs.NearRhombi())
    if net.mirror is not None:
        point, normal = np.array(net.mirror.point), np.array(net.mirror.normal)
        with keyed("mirror"):
            found.append(gs.MirrorPlane(point, normal))
    return tuple(found)


def require_angle(project: Project, path: Path) -> None:
    """Refuse an angle that can be told to fail before a net is made.

    Raises
    ------
    ProjectError
        Naming the file *path* and the key.
    """
    net = project.net
    if isinstance(net.angle, SampledAngleSection):
        require_file(net.angle.file, "file of samples", path, "net.angle.file")
    else:
        with placed(path, "net.angle"):
            angle_of(net.angle, path.parent)
    with placed(path, "net"):
        conditions_of(net)


def _samples(path: Path) -> tuple[Floats, Floats]:
    """(k, 3) places in the file's unit and (k,) radians; a first line of names is passed over."""
    try:
        rows = list(csv.reader(path.read_text(encoding="utf-8-sig").splitlines()))
    except (OSError, UnicodeDecodeError) as error:
        raise gs.FileError("The file of samples cannot be read", where=f"{path}: {error}") from None
    values = []
    for number, row in enumerate(rows, start=1):
        try:
            values.append([float(cell) for cell in row if cell.strip()])
            wrong = len(values[-1]) not in (0, 4)
        except ValueError:
            if number == 1:
                continue
            wrong = True
        if wrong:
            raise gs.FileError(
                "A sample needs x, y, z and degrees",
                where=f"{path}, line {number}",
                value=", ".join(row)[:60],
                limit="four numbers apart by commas",
            )
    table = np.array([row for row in values if row], dtype=np.float64).reshape(-1, 4)
    return table[:, :3], np.radians(table[:, 3])
