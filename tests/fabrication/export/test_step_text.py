import re

from fabrication.export.step_text import compact

DATA = b"""
#1 = POINT_USER('',(#2,#3),'#3 stays; it is text');
#2 = CARTESIAN_POINT('',(1.,2.,3.));
#3 = CARTESIAN_POINT('',(1.,2.,
    3.));
#4 = PART('b',#3);
#5 = PART('a',#2);
#6 = MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(#7),#1);
#7 = STYLED_ITEM('color',(#8),#5);
#8 = COLOUR_RGB('',0.1,0.2,0.3);
#9 = MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(#10),#1);
#10 = STYLED_ITEM('color',(#8),#4);
ENDSEC;
END-ISO-10303-21;
"""


def entities(data):
    return dict(re.findall(rb"^#(\d+)=(.*);$", data, re.MULTILINE))


def test_equal_points_are_one_and_every_reference_leads_where_it_did():
    found = entities(compact(DATA))
    points = [n for n, text in found.items() if text.startswith(b"CARTESIAN_POINT")]
    assert len(points) == 1
    (point,) = points
    for kind in (b"PART('b',", b"PART('a',"):
        (text,) = [t for t in found.values() if t.startswith(kind)]
        assert text == kind + b"#" + point + b")"


def test_text_in_quotes_is_left_alone():
    assert b"'#3 stays; it is text'" in compact(DATA)


def test_numbers_run_without_a_gap():
    found = [int(n) for n in entities(compact(DATA))]
    assert found == list(range(1, len(found) + 1))


def test_colours_follow_their_parts_whatever_order_they_come_in():
    head, _ = DATA.split(b"#6 =")
    kind = b"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION"
    swapped = head + (
        b"#6 = "
        + kind
        + b"""('',(#7),#1);
#7 = STYLED_ITEM('color',(#8),#4);
#8 = COLOUR_RGB('',0.1,0.2,0.3);
#9 = """
        + kind
        + b"""('',(#10),#1);
#10 = STYLED_ITEM('color',(#8),#5);
ENDSEC;
END-ISO-10303-21;
"""
    )
    assert compact(swapped) == compact(DATA)
    targets = re.findall(rb"STYLED_ITEM\('color',\(#\d+\),#(\d+)\)", compact(DATA))
    assert [int(t) for t in targets] == sorted(int(t) for t in targets)


def test_the_end_of_the_file_stays():
    assert compact(DATA).endswith(b"ENDSEC;\nEND-ISO-10303-21;\n")
