"""Shops: what a process can cut, and how a shop wants its files.

Limits are those of one thickness. The presets follow what shops publish for drawings they are sent
(holes at least 0.5-1.5 times the thickness, webs and slots 0.7-1 times, features one thickness from
an edge; kerfs of fibre lasers 0.1-0.3 mm, of abrasive waterjets 0.8-1.2 mm); a shop's own numbers
go over them. Lengths mm.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from enum import Enum
from functools import cached_property
from string import Formatter

from fabrication.cut import SQUARE, Floor, Relief
from fabrication.sizes import require_distance, require_positive
from gridshell import SettingError

_FORBIDDEN = re.compile(r'[<>/\\":;?*|=`,\x00-\x1f]')
"""What neither a layer's name nor that of a file may hold."""

_PLAIN = re.compile(r"[A-Za-z0-9$_-]{1,31}")
"""Names of layers in the oldest format."""


STRIPS = "sheet"
"""Prefix of sheets that hold strips."""


class DxfVersion(Enum):
    """The DXF formats a sheet can be written in."""

    R12 = "R12"
    R2000 = "R2000"
    R2010 = "R2010"
    R2013 = "R2013"


@dataclass(frozen=True)
class Layers:
    """How a shop calls the layers.

    Parameters
    ----------
    cut, mark, text, sheet : outlines, strokes to engrave, texts for people, the raw sheet.
    drill : of round holes; None where they lie with the outlines.

    Raises
    ------
    SettingError
        For a name no DXF file can hold, or one name for two of them. Only holes may lie with the
        outlines.
    """

    cut: str = "CUT"
    mark: str = "MARK"
    text: str = "TEXT"
    sheet: str = "SHEET"
    drill: str | None = None

    def __post_init__(self) -> None:
        names = {key: name for key, name in self.named.items() if key != "drill"}
        for key, name in self.named.items():
            if not name.strip() or _FORBIDDEN.search(name) or name != name.strip():
                raise SettingError(
                    "A layer cannot have this name",
                    where=f"layers.{key.upper()}",
                    value=repr(name),
                    limit='not empty, without < > / \\ " : ; ? * | = , `',
                )
        if len({name.casefold() for name in names.values()}) < len(names):
            raise SettingError(
                "Two kinds of lines would lie on one layer",
                where="layers",
                value=", ".join(f"{key.upper()} = {name}" for key, name in names.items()),
                advice="a name of its own for each; only holes may lie on the layer of the cuts",
            )

    @property
    def named(self) -> Mapping[str, str]:
        """Name of every layer by its key; that of the cuts for holes without one of their own."""
        found = {each.name: getattr(self, each.name) for each in fields(self)}
        return {key: self.cut if name is None else name for key, name in found.items()}

    def key(self, name: str) -> str | None:
        """What lies on the layer *name*, upper and lower case alike; None for others' layers."""
        return self._keys.get(name.casefold())

    @cached_property
    def _keys(self) -> dict[str, str]:
        found = {name.casefold(): key for key, name in self.named.items()}
        return found | {self.cut.casefold(): "cut"}


@dataclass(frozen=True)
class FileNames:
    """A template for the names of sheets, without the ending.

    Parameters
    ----------
    template : text with ``{name}``, ``{material}``, ``{thickness}``, ``{prefix}`` (what the sheets
        hold), ``{number}``.

    Raises
    ------
    SettingError
        For a key that is not among these, or a template without the number: its files would
        replace each other.
    """

    template: str = "{prefix}-{number}"

    KEYS = ("name", "material", "thickness", "prefix", "number")

    def __post_init__(self) -> None:
        try:
            pieces = list(Formatter().parse(self.template))
        except ValueError as error:
            raise self._refused(str(error)) from None
        keys = [key for _, key, _, _ in pieces if key is not None]
        if extra := [key for key in keys if key not in self.KEYS]:
            raise self._refused(f"{{{extra[0]}}} is not known")
        if any(spec or conversion for _, _, spec, conversion in pieces):
            raise self._refused("keys stand alone in their braces")
        if "number" not in keys:
            raise self._refused("without {number} the sheets would replace each other")
        if found := _FORBIDDEN.search("".join(text for text, _, _, _ in pieces)):
            raise self._refused(f"{found.group()!r} cannot be part of a file's name")

    def _refused(self, why: str) -> SettingError:
        return SettingError(
            f"The template for file names cannot be used: {why}",
            where="files",
            value=repr(self.template),
            limit=", ".join(f"{{{key}}}" for key in self.KEYS),
            advice='"{prefix}-{number}"',
        )

    def named(self, **values: str) -> str:
        """The name of one sheet; what no file's name can hold is left out of *values*.

        A template without ``{prefix}`` is for the strips' sheets: others get theirs in front, so
        that they do not replace these.
        """
        plain = {key: _plain(values.get(key, "")) for key in self.KEYS}
        found = self.template.format(**plain).strip(" .")
        told = "{prefix}" in self.template or plain["prefix"] in ("", STRIPS)
        return found if told else f"{plain['prefix']}-{found}"


def _plain(text: str) -> str:
    return "_".join(_FORBIDDEN.sub(" ", text).split())


@dataclass(frozen=True)
class Process:
    """One way of cutting, at one thickness, in one shop.

    Parameters
    ----------
    name : "laser", "waterjet", "router", "saw", or a shop's own.
    min_web : material between two cuts of a part, mm.
    min_hole : diameter, mm.
    min_edge : material between a hole and a cut beside it, mm.
    min_slot : width: what the tool fits into, mm.
    relief : the floors of slots this tool can cut.
    kerf : width of the cut, mm.
    compensate : whether outlines are drawn half a kerf outside, for shops that cut on the line.
    bevels : whether ends can be cut at an angle to the sheet.
    bed : length and width of the machine, mm.
    layers, files, version : how the shop wants its files.

    Raises
    ------
    SettingError
        For a limit that is negative or a bed without a size.
    """

    name: str = "drawing"
    min_web: float = 0.0
    min_hole: float = 0.0
    min_edge: float = 0.0
    min_slot: float = 0.0
    relief: Relief = SQUARE
    kerf: float = 0.0
    compensate: bool = False
    bevels: bool = False
    bed: tuple[float, float] | None = None
    layers: Layers = field(default_factory=Layers)
    files: FileNames = field(default_factory=FileNames)
    version: DxfVersion = DxfVersion.R2010

    def __post_init__(self) -> None:
        for key in ("min_web", "min_hole", "min_edge", "min_slot", "kerf"):
            require_distance(key, getattr(self, key))
        for size in self.bed or ():
            require_positive("bed", size)
        if self.version is DxfVersion.R12:
            for name in self.layers.named.values():
                if not _PLAIN.fullmatch(name):
                    raise SettingError(
                        "R12 has no layers with this name",
                        where="layers",
                        value=repr(name),
                        limit="31 letters, digits, $, _ and -",
                        advice="another name or R2000",
                    )

    @property
    def offset(self) -> float:
        """How far outside its part a line is drawn, mm."""
        return self.kerf / 2.0 if self.compensate else 0.0


class Cutting(Enum):
    """Processes whose limits are known."""

    LASER = "laser"
    WATERJET = "waterjet"
    ROUTER = "router"
    SAW = "saw"


@dataclass(frozen=True)
class _Preset:
    """Limits over the thickness, and what they cannot fall below: the tool or the jet, mm."""

    web: float
    hole: float
    edge: float
    slot: float
    tool: float
    kerf: float
    floor: Floor = Floor.SQUARE
    bevels: bool = False


_PRESETS = {
    Cutting.LASER: _Preset(1.0, 1.0, 1.0, 0.7, tool=0.5, kerf=0.2),
    Cutting.WATERJET: _Preset(1.0, 1.0, 1.0, 0.7, tool=1.5, kerf=1.0, bevels=True),
    Cutting.ROUTER: _Preset(1.0, 1.0, 1.0, 0.0, tool=6.0, kerf=6.0, floor=Floor.DOGBONE),
    Cutting.SAW: _Preset(1.0, 1.0, 1.0, 0.0, tool=3.0, kerf=3.0, bevels=True),
}
"""Laser and waterjet: shops' guides. Router: a 6 mm cutter. Saw: a 3 mm blade, holes drilled."""


def preset(cutting: Cutting, thickness: float = 0.0, *, tool: float | None = None) -> Process:
    """The limits of a process as shops publish them.

    Parameters
    ----------
    thickness : of the sheet, mm; without it only what the tool itself cannot cut is limited.
    tool : diameter of the cutter or the jet, mm; 0.5, 1.5, 6 and 3 unless said otherwise.
    """
    require_distance("thickness", thickness)
    if tool is not None:
        require_positive("tool", tool)
    known = _PRESETS[cutting]
    own = known.tool if tool is None else tool
    least = own if cutting is not Cutting.SAW else 0.0
    rotates = known.floor is Floor.DOGBONE
    return Process(
        name=cutting.value,
        min_web=known.web * thickness,
        min_hole=max(known.hole * thickness, least),
        min_edge=known.edge * thickness,
        min_slot=max(known.slot * thickness, own),
        relief=Relief(known.floor, own / 2.0) if rotates else SQUARE,
        kerf=own if tool is not None and (rotates or cutting is Cutting.SAW) else known.kerf,
        bevels=known.bevels,
    )
