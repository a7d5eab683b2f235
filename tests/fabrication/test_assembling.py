"""Steps of assembly: slotted grids, pieces, pinwheels, two levels, and slots that lock a strip."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import fabrication as fab
from fabrication.arrangement import Lane, arranged
from fabrication.assembling import Assembly, AssemblyStep, Side, assembly_order
from fabrication.cut import Cuts, Edge
from fabrication.errors import OutputError
from fabrication.jointed import Feature, Fixture, Jointed
from fabrication.lamella import piece_of
from fabrication.node import Crossing
from fabrication.outlines import Frame
from fabrication.shapes import Body, Prisms, Shape, circle
from fabrication.structures import Structure

WASHER = fab.StarWasher(4.0, 18.0, 8.0, fab.S235)


def strips_in(assembly: Assembly, jointed: Jointed) -> list[str]:
    known = {lamella.mark for lamella in jointed.strips.lamellas}
    return [mark for step in assembly.steps for mark in step.marks if mark in known]


def fits(assembly: Assembly, jointed: Jointed) -> bool:
    """Push strip after strip, reading its slots as they are cut."""
    present: set[str] = set()
    for mark in strips_in(assembly, jointed):
        edges = {s.edge for s in jointed.cuts[mark].slots if s.partner in present}
        if len(edges) > 1:
            return False
        present.add(mark)
    return len(present) == len(jointed.strips.lamellas)


def flipped(jointed: Jointed, flip: Callable[[str, str], bool]) -> Jointed:
    """Slots of the nodes that *flip* (mark of family A, of family B) says, opened to the other
    edge in both strips."""
    other = {Edge.LOWER: Edge.UPPER, Edge.UPPER: Edge.LOWER}
    cuts: Mapping[str, Cuts] = {
        mark: replace(
            own,
            slots=tuple(
                replace(s, edge=other[s.edge]) if flip(*sorted((mark, s.partner))) else s
                for s in own.slots
            ),
        )
        for mark, own in jointed.cuts.items()
    }
    return replace(jointed, cuts=cuts)


# ---- slotted grids -----------------------------------------------------------------------------


@pytest.mark.parametrize("joint", [fab.SlotJoint(), fab.DoubleSlotJoint(30.0, 8.0, WASHER)])
@pytest.mark.parametrize("name", ["catenoid", "ring", "tube", "saddle"])
def test_slotted_grids_go_together_from_above(name, joint, request):
    jointed = joint.build(request.getfixturevalue(name).structure)
    assembly = assembly_order(jointed)
    assert not assembly.findings
    assert fits(assembly, jointed)
    assert {step.side for step in assembly.steps} <= {None, Side.ABOVE}
    assert [step.number for step in assembly.steps] == list(range(1, len(assembly.steps) + 1))


def test_all_slots_are_engaged_once_and_from_the_middle(catenoid):
    jointed = fab.SlotJoint(weld=20.0).build(catenoid.structure)
    assembly = assembly_order(jointed)
    engaged = [node for step in assembly.steps for node in step.nodes]
    slotted = {slot.node for cuts in jointed.cuts.values() for slot in cuts.slots}
    assert sorted(engaged) == sorted(slotted)
    first, *_ = (step for step in assembly.steps if step.nodes)
    assert first.marks == ("B3",)
    x = {slot.node: slot.x for slot in jointed.cuts["B3"].slots}
    away = [abs(x[node] - np.median(list(x.values()))) for node in first.nodes]
    assert away == sorted(away)
    assert assembly.steps[0].marks == ("A1", "A2", "A3", "A4", "A5")
    assert "Raise the grid" in assembly.steps[-2].what
    assert assembly.steps[-1].marks == ("weld",)


def test_axes_of_a_flat_grid_are_parallel_and_of_a_catenoid_are_not(catenoid):
    flat = [replace(node, axis=np.array([0.0, 0.0, 1.0])) for node in catenoid.structure.nodes]
    jointed = fab.SlotJoint().build(catenoid.structure)
    assert max(step.spread for step in assembly_order(jointed).steps) > 0.1
    level = replace(jointed, strips=replace(jointed.strips, nodes=tuple(flat)))
    assert max(step.spread for step in assembly_order(level).steps) < 1e-7


# ---- other cuts --------------------------------------------------------------------------------


def test_a_strip_slotted_the_other_way_goes_below(catenoid):
    jointed = flipped(fab.SlotJoint().build(catenoid.structure), lambda a, b: b == "B2")
    assembly = assembly_order(jointed)
    assert not assembly.findings
    assert fits(assembly, jointed)
    order = strips_in(assembly, jointed)
    last = max(order.index(mark) for mark in ("A1", "A5"))
    from_below = [step.marks for step in assembly.steps if step.side is Side.BELOW]
    assert order.index("B2") < last or from_below == [("B2",)]


def test_a_weave_locks_every_strip(catenoid):
    number = {
        mark: int(mark[1:]) for mark in (lamella.mark for lamella in catenoid.structure.lamellas)
    }
    weave = flipped(
        fab.SlotJoint().build(catenoid.structure), lambda a, b: (number[a] + number[b]) % 2 == 0
    )
    assembly = assembly_order(weave)
    assert not assembly.steps
    assert {f.code for f in assembly.findings} == {"locked-out"}
    assert [f.where.split()[0] for f in assembly.findings] == [
        lamella.mark for lamella in catenoid.structure.lamellas
    ]
    assert all(f.severity is fab.Severity.ERROR for f in assembly.findings)
    assert assembly.section()["possible"] is False


def test_a_lock_of_four_strips_names_these_and_their_nodes(catenoid):
    jointed = flipped(
        fab.SlotJoint().build(catenoid.structure),
        lambda a, b: (a, b) in {("A1", "B1"), ("A2", "B2")},
    )
    assembly = assembly_order(jointed)
    assert {f.where.split()[0] for f in assembly.findings} == {"A1", "A2", "B1", "B2"}
    for found in assembly.findings:
        mark, node = found.where.split()
        slot = next(s for s in jointed.cuts[mark].slots if s.node == node)
        assert slot.edge is Edge.LOWER
        assert f"on {slot.partner} at {node}" in found.message


def test_slots_open_to_the_same_edge_are_told(catenoid):
    jointed = fab.SlotJoint().build(catenoid.structure)
    slots = tuple(replace(s, edge=Edge.LOWER) for s in jointed.cuts["A3"].slots)
    assembly = assembly_order(replace(jointed, cuts={**jointed.cuts, "A3": Cuts(slots)}))
    assert [f.code for f in assembly.findings] == ["same-edge"] * len(slots)
    assert not assembly.steps


# ---- pieces ------------------------------------------------------------------------------------


def in_pieces(design: Structure, ends: Callable[[int, int, int], bool]) -> Jointed:
    """Lamellas cut into pieces at the nodes where *ends* (family, row, column) says so."""
    number = {lam.mark: int(lam.mark[1:]) for lam in design.lamellas}
    strips, carriers = [], []
    crossings: dict[str, list[Crossing]] = {node.name: [] for node in design.nodes}
    for i, lam in enumerate(design.lamellas):
        last, cuts = len(lam.nodes) - 1, [0]
        for k in range(1, last):
            partner = next(
                c.lamella for c in design.nodes[int(lam.nodes[k])].crossings if c.lamella != i
            )
            pair = sorted((lam.mark, design.lamellas[partner].mark))
            if ends(lam.family, number[pair[0]], number[pair[1]]):
                cuts.append(k)
        cuts.append(last)
        for piece, (k, m) in enumerate(pairwise(cuts), start=1):
            start = lam.start if k == 0 else float(lam.stations[k]) + 2.0
            end = lam.end if m == last else float(lam.stations[m]) - 2.0
            made = piece_of(lam, f"{lam.mark}.{piece}", (k, m), start, end)
            for v, station in zip(made.nodes.tolist(), made.stations.tolist(), strict=True):
                crossings[design.nodes[v].name].append(Crossing(len(strips), station))
            strips.append(made)
            carriers.append(i)
    nodes = tuple(replace(n, crossings=tuple(crossings[n.name])) for n in design.nodes)
    return Jointed(
        design=design,
        strips=Structure(tuple(strips), nodes, design.profile),
        carriers=tuple(carriers),
        cuts={strip.mark: Cuts() for strip in strips},
        fixtures=(),
    )


def test_pieces_go_in_after_the_strips_they_end_on(catenoid):
    jointed = in_pieces(catenoid.structure, lambda family, a, b: family == 2)
    assembly = assembly_order(jointed)
    assert not assembly.findings
    order = strips_in(assembly, jointed)
    assert sorted(order) == sorted(strip.mark for strip in jointed.strips.lamellas)
    last_through = max(k for k, mark in enumerate(order) if mark.startswith("A"))
    assert all(mark.startswith("A") for mark in order[: last_through + 1])
    assert {len(step.marks) for step in assembly.steps if step.marks[0].startswith("B")} == {4}


def test_pieces_known_by_their_ends_alone_go_in_after_the_strips_they_end_on(catenoid):
    """Nodes with the through strip only; the pieces are there by what their ends are fixed to."""
    whole = in_pieces(catenoid.structure, lambda family, a, b: family == 2)
    ends = []
    nodes = []
    for node in whole.strips.nodes:
        through = []
        for crossing in node.crossings:
            strip = whole.strips.lamellas[crossing.lamella]
            if strip.start < crossing.station < strip.end:
                through.append(crossing)
                continue
            first = crossing.station < strip.start
            feature, x = (Feature.START, 0.0) if first else (Feature.END, strip.length)
            ends.append(Fixture(strip.mark, node.name, feature, x, 50.0, node.position))
        nodes.append(replace(node, crossings=tuple(through)))
    jointed = replace(whole, strips=replace(whole.strips, nodes=tuple(nodes)), fixtures=tuple(ends))
    assert assembly_order(jointed).lines() == assembly_order(whole).lines()


def test_pinwheels_close_in_rings_that_are_told(catenoid):
    jointed = in_pieces(catenoid.structure, lambda family, a, b: (a + b) % 2 == family - 1)
    assembly = assembly_order(jointed)
    (found,) = assembly.findings
    assert (found.code, found.severity) == ("bearing-ring", fab.Severity.INFO)
    assert found.value >= 1
    assert sorted(strips_in(assembly, jointed)) == sorted(
        strip.mark for strip in jointed.strips.lamellas
    )


# ---- two levels --------------------------------------------------------------------------------


def two_levels(design: Structure, apart: float) -> Jointed:
    lanes = {1: (Lane("", along=-apart / 2.0),), 2: (Lane("", along=apart / 2.0),)}
    made = arranged(design, lanes, crossing=False)
    frame = Frame(np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0]))
    stud = Prisms(
        "stud", (0.5, 0.5, 0.5), (Shape("S1", circle(10.0), 0.0, 80.0),), (Body("S1", 0, frame),)
    )
    empty = Prisms("shear block", (0.5, 0.5, 0.5), (), ())
    return Jointed(
        design=design,
        strips=made.strips,
        carriers=made.carriers,
        cuts={lamella.mark: Cuts() for lamella in made.strips.lamellas},
        fixtures=(),
        connectors=(stud, empty),
    )


@pytest.mark.parametrize(("apart", "low"), [(120.0, "A"), (-120.0, "B")])
def test_the_lower_level_comes_first_and_studs_come_last(catenoid, apart, low):
    jointed = two_levels(catenoid.structure, apart)
    assembly = assembly_order(jointed)
    assert not assembly.findings
    order = strips_in(assembly, jointed)
    assert {mark[0] for mark in order[:5]} == {low}
    assert "temporary frame" in assembly.steps[-2].what
    assert assembly.steps[-1].marks == ("stud",)
    assert "only fit once" in assembly.steps[-1].what


# ---- what is told ------------------------------------------------------------------------------


def test_steps_are_read_back(catenoid, tmp_path):
    assembly = assembly_order(fab.DoubleSlotJoint(30.0, 8.0, WASHER).build(catenoid.structure))
    fab.write_assembly(tmp_path / "assembly.csv", assembly)
    with (tmp_path / "assembly.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [int(row["step"]) for row in rows] == [step.number for step in assembly.steps]
    for row, step in zip(rows, assembly.steps, strict=True):
        assert tuple(row["parts"].split()) == tuple(" ".join(step.marks).split())
        assert tuple(row["nodes"].split()) == step.nodes
        assert int(row["slots"]) == len(step.nodes)
    assert assembly.lines()[0].startswith("1. Lay out A1L, A1R")
    assert assembly.section()["steps"] == len(rows)


def test_a_list_that_cannot_be_written_is_told(tmp_path):
    step = AssemblyStep(1, ("A1",), "Lay out A1.")
    with pytest.raises(OutputError, match="order of assembly"):
        fab.write_assembly(tmp_path / "none" / "assembly.csv", Assembly((step,), ()))
