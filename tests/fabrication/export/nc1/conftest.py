"""A small reader of NC1 files that shares nothing with the writer."""

import re
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

HEADER = [
    *("order", "drawing", "phase", "mark", "steel", "quantity", "profile", "code", "length"),
    *("height", "flange", "flange_thickness", "thickness", "radius", "mass", "surface"),
    *("web_start", "web_end", "flange_start", "flange_end", "text1", "text2", "text3", "text4"),
]


def read(path):
    lines = path.read_bytes().decode("ascii").split("\r\n")
    assert lines[0] == "ST"
    assert lines[-2:] == ["EN", ""]
    lines = [line for line in lines[1:-2] if not line.startswith("**")]
    assert all(line.startswith("  ") or re.fullmatch("[A-Z]{2}", line) for line in lines)
    found = SimpleNamespace(outer=[], inner=[], holes=[], marks=[], blocks=[])
    for name, line in zip(HEADER, lines, strict=False):
        setattr(found, name, line[2:].strip())
    block = None
    for line in lines[len(HEADER) :]:
        if not line.startswith(" "):
            block = line
            found.blocks.append(block)
            if block in ("AK", "IK"):
                {"AK": found.outer, "IK": found.inner}[block].append([])
            continue
        if block == "SI":
            place, text = re.fullmatch(r"  v((?:\s*[-\d.]+u?){4})\s(.*)", line).groups()
            found.marks.append(([float(n.rstrip("u")) for n in place.split()], text))
            continue
        assert line[2] == ("v" if block == "BO" else line[2])
        numbers = [float(n.rstrip("u")) for n in line[3:].split()]
        if block == "BO":
            found.holes.append(numbers)
        else:
            assert numbers[3:] == [0.0] * 4
            {"AK": found.outer, "IK": found.inner}[block][-1].append(numbers[:3])
    found.holes = np.array(found.holes).reshape(-1, 3)
    return found


def area(points):
    """Signed area of a closed contour of points x, y, radius; arcs are less than half circles."""
    assert points[0][:2] == points[-1][:2]
    total = 0.0
    for (x0, y0, radius), (x1, y1, _) in pairwise(points):
        total += (x0 * y1 - x1 * y0) / 2.0
        if radius:
            half = np.hypot(x1 - x0, y1 - y0) / 2.0
            sweep = 2.0 * np.arcsin(half / abs(radius))
            total += np.sign(radius) * radius**2 / 2.0 * (sweep - np.sin(sweep))
    return total


def around(points):
    """Length of a closed contour's corners, mm."""
    corners = np.array(points)[:, :2]
    return np.linalg.norm(np.diff(corners, axis=0), axis=1).sum()


@pytest.fixture(scope="session")
def nc1():
    return SimpleNamespace(read=read, area=area, around=around)
