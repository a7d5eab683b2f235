import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pypdf import PdfReader

import fabrication as fab
import gridshell as gs
from fabrication.assembling import assembly_order
from fabrication.errors import OutputError
from fabrication.export.papers.part_sheets import spread
from fabrication.finding import Finding, Severity
from fabrication.flat_state import lay_flat
from fabrication.parts import parts_of

JOINTS = {
    "slot": fab.SlotJoint(weld=30.0),
    "scissor": fab.ScissorJoint(),
    "reciprocal": fab.ReciprocalJoint(cleat=fab.Cleat(60.0, 5.0, 60.0, fab.S235, play=1.5)),
    "two-level": fab.StudJoint(
        30.0, fab.Stud(fab.S235), bolt=8.0, blocks=fab.ShearBlock(1, 60.0, fab.S235)
    ),
    "double-slot": fab.DoubleSlotJoint(30.0, 8.0, fab.StarWasher(4.0, 18.0, 8.0, fab.S235)),
}


@pytest.fixture(scope="module", params=list(JOINTS))
def drawn(request, enneper, tmp_path_factory):
    """The drawings of a net at 60 degrees with one kind of joint, read back."""
    jointed = JOINTS[request.param].build(enneper.structure)
    parts = parts_of(jointed)
    finding = Finding("twist", Severity.WARNING, "A1", 1.0, 2.0, "rad/mm", "It twists.")
    path = tmp_path_factory.mktemp("drawings") / "drawings.pdf"
    assembly = assembly_order(jointed)
    fab.write_drawings(
        path, jointed, parts, name="roof", revision="C", findings=[finding], assembly=assembly
    )
    texts = [page.extract_text() for page in PdfReader(path).pages]
    return jointed, parts, assembly, texts


def of_kind(texts, title):
    """The pages, after the index, whose title begins with *title*."""
    return [text for text in texts[1:] if re.search(rf"^{title}", text, re.MULTILINE)]


def test_every_strip_is_drawn_with_all_its_places(drawn):
    _, parts, _, texts = drawn
    pages = of_kind(texts, "Strip")
    for part in parts:
        own = "\n".join(text for text in pages if re.search(rf"^{part.mark}$", text, re.MULTILINE))
        assert f"{part.length:.1f} x {part.width:g} x {part.thickness:g} mm" in own
        figures = set(re.findall(r"^ *(\d+\.\d)$", own, re.MULTILINE))
        places = [0.0, part.length, *(s.x for s in part.slots), *(h.x for h in part.holes)]
        assert {f"{x:.1f}" for x in places} <= figures
        for slot in part.slots:
            assert f"{slot.partner} {slot.node} w {slot.width:.2f}" in own
        for hole in part.holes:
            assert f"{hole.node} d {hole.diameter:g}" in own


def test_every_node_is_in_the_schedule_with_its_place(drawn):
    jointed, _, _, texts = drawn
    table = "\n".join(of_kind(texts, "Nodes"))
    for node in jointed.strips.nodes:
        assert re.search(rf"^{node.name}$", table, re.MULTILINE)
        for value in node.position.tolist():
            assert f"{round(value, 1) + 0.0:.1f}" in table
    assert "-0.0" not in table


def test_the_key_plan_shows_every_lamella(drawn):
    jointed, _, _, texts = drawn
    (plan,) = of_kind(texts, "Key plan")
    assert {lamella.mark for lamella in jointed.design.lamellas} <= set(plan.split("\n"))
    assert re.search(r"^1:\d+$", plan, re.MULTILINE)


def test_the_joint_is_drawn_with_its_angle(drawn):
    *_, texts = drawn
    pages = of_kind(texts, "Joint at N")
    assert pages
    assert all(re.search(r"Node angle \d\d\.\d\d degrees", text) for text in pages)


def test_the_joint_names_what_stands_at_its_node_and_dimensions_every_level(drawn):
    jointed, _, _, texts = drawn
    for text in of_kind(texts, "Joint at N"):
        node = re.search(r"^Joint at (N\d+)$", text, re.MULTILINE)[1]
        for kind in jointed.connectors:
            marks = {
                kind.shapes[body.shape].mark
                for body in kind.bodies
                if body.mark.split("-")[0] == node and kind.name in ("studs", "star washers")
            }
            assert all(f"{mark}: " in text for mark in marks)
        levels = 2 if any(kind.name == "studs" for kind in jointed.connectors) else 1
        assert len(re.findall(r"^ *100$", text, re.MULTILINE)) == levels


def test_bill_findings_and_index_are_there(drawn):
    jointed, parts, _, texts = drawn
    assert f"{len(parts)} strips" in texts[0]
    assert "buckling" in texts[0]
    (findings,) = of_kind(texts, "Findings")
    assert "It twists." in findings
    bill = "\n".join(of_kind(texts, "Bill of material"))
    assert all(line.item in bill for line in jointed.bill)


def test_every_step_of_the_assembly_is_listed(drawn):
    _, _, assembly, texts = drawn
    table = "\n".join(of_kind(texts, "Assembly"))
    assert all(re.search(rf"^{s.number}$", table, re.MULTILINE) for s in assembly.steps)


def test_the_flat_state_has_a_sheet_of_its_own(catenoid, tmp_path):
    jointed = fab.ScissorJoint().build(catenoid.structure)
    flat = lay_flat(jointed)
    path = fab.write_drawings(
        tmp_path / "a.pdf", jointed, parts_of(jointed), name="roof", flat=flat
    )
    (sheet,) = of_kind([page.extract_text() for page in PdfReader(path).pages], "Flat state")
    assert "on the ground" in sheet
    assert {lamella.mark for lamella in jointed.design.lamellas} <= set(sheet.split("\n"))


def test_two_runs_give_the_same_bytes(pair, tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    jointed = fab.SlotJoint().build(pair.structure)
    first, second = (
        fab.write_drawings(tmp_path / name, jointed, pair.parts, name="roof").read_bytes()
        for name in ("a.pdf", "b.pdf")
    )
    assert first == second


def test_unknown_paper_and_places_that_cannot_be_written_are_told(pair, tmp_path):
    jointed = fab.SlotJoint().build(pair.structure)
    with pytest.raises(gs.SettingError, match="No such size"):
        fab.write_drawings(tmp_path / "a.pdf", jointed, pair.parts, name="roof", paper="B5")
    with pytest.raises(OutputError, match="cannot be written"):
        fab.write_drawings(tmp_path / "no" / "a.pdf", jointed, pair.parts, name="roof")


@given(
    st.lists(st.floats(0.0, 100.0), min_size=2, max_size=40),
    st.floats(0.5, 6.0),
)
def test_spread_figures_keep_their_order_and_their_distance(places, pitch):
    at = np.sort(np.array(places))
    moved = spread(at, pitch, 0.0, 100.0)
    room = min(pitch, (100.0 + pitch) / len(at))
    assert (np.diff(moved) >= room - 1e-6).all()
    if (np.diff(at) >= pitch).all():
        np.testing.assert_allclose(moved, at, atol=pitch / 2.0 + 1e-9)
