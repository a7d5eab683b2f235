import pytest

from fabrication.colours import FAMILY_COLOURS, css


def test_either_family_has_a_colour_of_its_own():
    assert set(FAMILY_COLOURS) == {1, 2}
    assert FAMILY_COLOURS[1] != FAMILY_COLOURS[2]


@pytest.mark.parametrize(
    ("shade", "text"), [(1.0, "rgb(255, 128, 0)"), (0.5, "rgb(128, 64, 0)"), (0.0, "rgb(0, 0, 0)")]
)
def test_a_colour_is_written_for_a_page_and_darkened(shade, text):
    assert css((1.0, 0.502, 0.0), shade) == text
