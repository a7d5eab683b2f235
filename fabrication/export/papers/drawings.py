"""The set of drawings of a shell: index, bill, plans, joints, strips, nodes, assembly."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from fabrication.assembling import Assembly
from fabrication.export.papers.assembly_pages import assembly_pages, flat_pages
from fabrication.export.papers.index_page import bill_pages, finding_pages, index_page
from fabrication.export.papers.joint_detail import joint_pages
from fabrication.export.papers.key_plan import key_plan_pages
from fabrication.export.papers.node_schedule import node_pages
from fabrication.export.papers.part_sheets import part_pages
from fabrication.export.papers.sheet_frame import Titles, today, write_pages
from fabrication.finding import Finding
from fabrication.flat_state import FlatState
from fabrication.jointed import Jointed
from fabrication.parts import FlatPart


def write_drawings(
    path: Path | str,
    jointed: Jointed,
    parts: Sequence[FlatPart],
    *,
    name: str,
    paper: str = "A3",
    revision: str = "",
    findings: Sequence[Finding] = (),
    assembly: Assembly | None = None,
    flat: FlatState | None = None,
) -> Path:
    """Write the set as one PDF; the date is that of ``SOURCE_DATE_EPOCH`` or today.

    Parameters
    ----------
    parts : one per strip, in the order of the strips.
    findings : told on a sheet of their own.
    assembly, flat : their sheets are left out where these are None.

    Raises
    ------
    SettingError
        For a size of paper that is not known.
    OutputError
        When the file cannot be written.
    """
    pages = [
        *bill_pages(jointed, paper=paper),
        *finding_pages(findings, paper=paper),
        *key_plan_pages(jointed, paper=paper),
        *joint_pages(jointed, parts, paper=paper),
        *flat_pages(flat, paper=paper),
        *(() if assembly is None else assembly_pages(assembly, paper=paper)),
        *node_pages(jointed, parts, paper=paper),
        *part_pages(jointed, parts, paper=paper),
    ]
    titles = Titles(name, jointed.design.profile.material.name, revision, today())
    return write_pages(
        path, [index_page(jointed, parts, pages, name=name), *pages], titles, paper=paper
    )
