from fabrication.summary import length, mass, summary_lines

PLANAR = {
    "structure": {
        **{"panels": 24, "plates": 56, "connectors": 1, "panel_groups": 3},
        **{"mass_kg": 1234.5, "sheets": 7},
    },
    "net": {"node_angle_deg": {"min": 90.0, "max": 90.0}},
    "closure": {"max_mm": 0.001, "volume_ppm": 0.2},
    "supports": {
        "out_of_plane_mm": {"max": 0.012},
        "classical_out_of_plane_mm": {"max": 1.5},
        "twist_deg": {"max": 0.1},
    },
}


def test_panels_are_told_with_their_groups_plates_and_connectors():
    first, second, third = summary_lines(PLANAR)
    assert first.startswith("24 panels in 3 groups, 56 support plates, 1 connector, 1234.5 kg on 7")
    assert "0.012 mm of their planes (1.5 mm with averaged normals)" in second
    assert third == "files close onto the design within 0.001 mm, volumes within 0.2 ppm"


def test_panels_alone_have_no_line_on_plates():
    bare = {**PLANAR, "structure": {**PLANAR["structure"], "plates": 0, "connectors": 0}}
    del bare["supports"]
    first, last = summary_lines(bare)
    assert "plate" not in first
    assert last.startswith("files close")


def test_small_figures_get_small_units():
    assert (length(0.62), length(12.34)) == ("620 mm", "12.3 m")
    assert (mass(0.5), mass(12.34)) == ("500 g", "12.3 kg")
