"""Every figure of the paper, each with its numbers, its conditions and a picture.

A figure is one module with a function ``figure()`` that makes nets and parts with the public names
of both packages, as any script would. ``build`` makes all of them, one PNG and one JSON report
each, and a table.
"""

from fabrication.gallery.building import FIGURES, Row, build
from fabrication.gallery.figure import Condition, Figure

__all__ = ["FIGURES", "Condition", "Figure", "Row", "build"]
