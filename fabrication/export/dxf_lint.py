"""Look for what goes wrong with cutting files: any DXF, of any program.

About a third of the files that shops get have a fault; these are the ones their guides name. The
geometry is checked as lines within 0.01 mm of the arcs.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from fabrication.export.dxf_content import Content, Track, read_content
from fabrication.export.lint_contours import (
    Contour,
    cleaned,
    contours,
    open_findings,
    short_findings,
    without_doubles,
)
from fabrication.export.lint_entities import entity_findings, file_findings, layer_findings
from fabrication.export.lint_limits import limit_findings
from fabrication.export.lint_parts import part_findings
from fabrication.export.lint_pieces import crossing_findings, pieces_of
from fabrication.export.lint_shapes import drawn_parts, mark_findings, place_findings
from fabrication.finding import Finding, Severity
from fabrication.nesting import SheetPart
from fabrication.shop import Layers, Process


def lint_dxf(
    path: Path | str,
    process: Process | None = None,
    parts: Sequence[SheetPart] | None = None,
) -> tuple[Finding, ...]:
    """All faults of a cutting file.

    Parameters
    ----------
    process : whose layers and limits hold; without it, the usual layers and no limits.
    parts : what the file should hold.

    Returns
    -------
    Findings about the file, its layers and entities, its lines, its parts and its marks, in this
    order. In a file with nothing on the cutting layer, the unknown layer with the longest lines is
    looked at in its place.

    Raises
    ------
    FileError
        When the file is missing or is no DXF.
    SettingError
        When *parts* cannot be cut with the kerf of *process*.
    """
    process = Process() if process is None else process
    content = read_content(path)
    layers = _Roles(content, process.layers)
    found = [*file_findings(content), *layer_findings(content, process.layers)]
    found += entity_findings(content, process.layers, layers.role)
    found += _line_findings(layers, process, parts)
    return tuple(found)


class _Roles:
    """Which lines are cut and which are engraved."""

    def __init__(self, content: Content, layers: Layers) -> None:
        self._tracks = content.tracks
        names = {str(e.dxf.get("layer", "0")) for e in content.entities}
        self._keys = {name: layers.key(name) for name in names}
        if not {"cut", "drill"} & set(self._keys.values()):
            lengths = {name: 0.0 for name in names if self._keys[name] is None}
            for track in self._tracks:
                if track.layer in lengths:
                    lengths[track.layer] += float(np.hypot(*np.diff(track.points, axis=0).T).sum())
            if lengths:
                self._keys[max(lengths, key=lambda name: lengths[name])] = "cut"

    def role(self, layer: str) -> str | None:
        """Key of a layer by its name."""
        return self._keys.get(layer)

    def on(self, *keys: str) -> tuple[Track, ...]:
        return tuple(track for track in self._tracks if self.role(track.layer) in keys)


def _line_findings(
    layers: _Roles, process: Process, parts: Sequence[SheetPart] | None
) -> Iterator[Finding]:
    drawn = layers.on("cut", "drill")
    for track in drawn:
        yield from short_findings(track)
    clean = [each for track in drawn if (each := cleaned(track)) is not None]
    once, doubles = without_doubles(clean)
    for first, second in doubles:
        yield _twice(first, second)
    found: tuple[Contour, ...] = contours(once)
    yield from open_findings(found)
    pieces = pieces_of(found)
    yield from crossing_findings(found, pieces)
    shapes = drawn_parts(found)
    drilled = {track.name for track in layers.on("drill")}
    yield from place_findings(shapes, layers.on("sheet"), drilled)
    yield from limit_findings(shapes, process)
    strokes, engraved_twice = without_doubles(layers.on("mark"))
    yield from mark_findings(shapes, pieces, strokes, engraved_twice)
    if parts is not None:
        yield from part_findings(shapes, parts, process.offset)


def _twice(first: Track, second: Track) -> Finding:
    message = f"{first.name} and {second.name} are the same line: it is cut twice. Delete one."
    return Finding("duplicate-line", Severity.ERROR, first.name, 2.0, 1.0, "", message)
