from dataclasses import replace
from xml.etree import ElementTree

import pytest

import fabrication as fab
from fabrication.panel_structure import PanelSystem, panelled
from fabrication.stock import section_area

SVG = "{http://www.w3.org/2000/svg}"
HOSTILE = "</svg><script>alert('x')</script> & \"A\""


def shown(thing):
    """The HTML as XML, and its figures by name."""
    root = ElementTree.fromstring(thing._repr_html_())
    assert root.find(f".//{SVG}script") is None
    assert root.find(".//script") is None
    return root, {row[0].text: row[1].text for row in root.iter("tr")}


def moves(root):
    """How many polygons and lines the picture holds."""
    return sum(path.get("d").count("M") for path in root.iter(f"{SVG}path"))


def test_a_structure_shows_its_strips_as_ribbons(enneper):
    built = enneper.structure
    root, figures = shown(built)
    assert figures["Lamellas A, B"] == "5 + 5"
    assert figures["Nodes"] == f"{len(built.nodes)}"
    assert figures["Section"] == "100 x 2.5 mm, stainless"
    total = sum(lamella.length for lamella in built.lamellas)
    mass = total * section_area(built.profile) * built.profile.material.density * 1e-9
    assert figures["In all"] == f"{total / 1e3:.1f} m, {mass:.1f} kg before cutting"
    assert moves(root) == sum(2 * len(one.stations) - 1 for one in built.lamellas)


def test_a_structure_of_nothing_is_shown(enneper):
    built = replace(enneper.structure, lamellas=(), nodes=())
    root, figures = shown(built)
    assert moves(root) == 0
    assert figures["Lamellas A, B"] == "0 + 0"
    assert "Node angle" not in figures


def test_of_very_many_strips_some_are_drawn(enneper):
    built = enneper.structure
    many = replace(built, lamellas=built.lamellas * 150)
    root, _ = shown(many)
    assert 1_000 < moves(root) < 3_000
    assert [note.text for note in root.iter("p")] == ["One strip of 3 is drawn."]


def test_a_lamella_shows_its_axis(enneper):
    lamella = enneper.lamella("B2")
    root, figures = shown(lamella)
    assert root[0].text == "Lamella B2"
    assert figures["Family"] == "B"
    assert figures["Length"] == f"{lamella.length:.1f} mm"
    assert moves(root) == 6 * len(lamella.stations) - 1 + len(lamella.stations)


def test_a_straight_lamella_has_no_bending_radius(hypar):
    assert shown(hypar.lamella("A1"))[1]["Smallest bending radius"] == "straight"


def test_a_part_shows_its_flat_pattern(enneper):
    part = enneper.part("A3")
    root, figures = shown(part)
    assert figures["Length"] == f"{part.length:.1f} mm"
    assert figures["Slots"] == f"{len(part.slots)}"
    assert "Holes" not in figures
    texts = [text.text for text in root.iter(f"{SVG}text")]
    assert {slot.partner for slot in part.slots} <= set(texts)
    assert "A3" in texts


def test_a_hostile_mark_is_text(enneper):
    part = replace(enneper.part("A3"), mark=HOSTILE)
    root, _ = shown(part)
    assert root[0].text == f"Strip {HOSTILE}"
    assert HOSTILE in [text.text for text in root.iter(f"{SVG}text")]


def test_a_part_without_a_cut_is_shown(enneper):
    bare = replace(enneper.part("A3"), slots=(), labels=(), quantity=4)
    _, figures = shown(bare)
    assert "Slots" not in figures
    assert "Slot width" not in figures
    assert figures["Built"] == "4 times"


def test_panels_are_shown_with_their_plates(tower):
    root, figures = shown(tower)
    assert moves(root) == len(tower.panels) + len(tower.plates)
    assert figures["Panels"].startswith(f"{len(tower.panels)} of ")
    mass = sum(p.mass for p in (*tower.panels, *tower.plates))
    mass += sum(tower.piece_mass(piece) for piece in tower.pieces)
    assert figures["Mass"] == f"{mass:.1f} kg"


def test_panels_alone_are_shown(tower):
    root, figures = shown(panelled(tower.mesh, PanelSystem(panels=tower.system.panels)))
    assert moves(root) == len(tower.panels)
    assert "Support plates" not in figures


def test_the_section_of_a_tube_is_what_its_walls_leave():
    solid = fab.Profile(50.0, 14.0, fab.S235)
    assert section_area(solid) == pytest.approx(700.0)
    tube = fab.HollowProfile(50.0, 14.0, fab.S235, wall=2.0)
    assert section_area(tube) == pytest.approx(700.0 - 46.0 * 10.0)
