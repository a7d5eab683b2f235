from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

import fabrication as fab
import gridshell as gs
from fabrication.cut import Floor, Relief
from fabrication.shop import Cutting, DxfVersion, FileNames, Layers, Process, preset
from fabrication.shop_sections import ShopSection
from fabrication.shop_settings import process_of

PROFILE = fab.Profile(width=100.0, thickness=3.0, material=fab.S235)


def process(**keys):
    return process_of(ShopSection.model_validate({"process": "laser"} | keys), PROFILE)


# ---- limits -----------------------------------------------------------------------------------


@pytest.mark.parametrize("cutting", Cutting)
@given(thickness=st.floats(0.5, 50.0))
def test_limits_are_at_least_the_thickness_and_grow_with_it(cutting, thickness):
    thin, thick = preset(cutting, thickness), preset(cutting, 2.0 * thickness)
    assert min(thin.min_web, thin.min_hole, thin.min_edge) >= thickness
    for key in ("min_web", "min_hole", "min_edge", "min_slot"):
        assert getattr(thick, key) >= getattr(thin, key)


def test_a_cutter_needs_slots_and_holes_as_wide_as_itself_and_dogbones():
    router = preset(Cutting.ROUTER, 2.0, tool=4.0)
    assert (router.min_slot, router.min_hole, router.kerf) == (4.0, 4.0, 4.0)
    assert router.relief == Relief(Floor.DOGBONE, 2.0)


@pytest.mark.parametrize("cutting", [Cutting.LASER, Cutting.WATERJET, Cutting.SAW])
def test_other_processes_cut_square_floors(cutting):
    assert preset(cutting, 2.0).relief == Relief()


def test_lines_are_not_moved_unless_it_is_asked_for():
    assert process(kerf=0.4).offset == 0.0
    assert process(kerf=0.4, compensate=True).offset == pytest.approx(0.2)


@pytest.mark.parametrize("key", ["min_web", "min_hole", "min_edge", "min_slot", "kerf"])
def test_a_shops_own_number_goes_over_the_usual_one(key):
    assert getattr(process(**{key: 7.5}), key) == 7.5
    assert replace(process(**{key: 7.5}), **{key: getattr(process(), key)}) == process()


def test_without_a_section_nothing_is_limited_and_files_are_the_usual_ones():
    assert process_of(None, PROFILE) == Process()


@pytest.mark.parametrize(
    "keys",
    [{"process": "axe"}, {"min_web": -1.0}, {"tool": 0.0}, {"depth": 1.0}, {"version": "R14"}],
)
def test_a_section_with_a_wrong_key_is_refused(keys):
    with pytest.raises(ValidationError):
        process(**keys)


@pytest.mark.parametrize("change", [{"min_web": -1.0}, {"kerf": float("nan")}, {"bed": (0.0, 1.0)}])
def test_limits_that_cannot_be_are_refused(change):
    with pytest.raises(gs.SettingError):
        Process(**change)


# ---- layers -----------------------------------------------------------------------------------


def test_layers_are_named_by_the_section():
    layers = process(layers={"CUT": "0_CUT", "DRILL": "HOLES"}).layers
    assert layers == Layers(cut="0_CUT", drill="HOLES")
    assert [layers.key(name) for name in ("0_cut", "HOLES", "MARK", "CUT")] == [
        "cut",
        "drill",
        "mark",
        None,
    ]


def test_holes_lie_with_the_cuts_unless_named():
    assert Layers().named["drill"] == "CUT"
    assert Layers().key("CUT") == "cut"


@pytest.mark.parametrize("name", ["", " ", "a/b", "a:b", "cut", " CUT2"])
def test_a_name_no_layer_can_have_is_refused(name):
    with pytest.raises(gs.SettingError):
        Layers(mark=name)


def test_the_oldest_format_refuses_names_it_has_not():
    with pytest.raises(gs.SettingError, match="R12"):
        Process(layers=Layers(cut="to cut"), version=DxfVersion.R12)


# ---- files ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "template", ["{prefix}", "{x}-{number}", "{number", "a/{number}", "{number:03d}", "{}{number}"]
)
def test_a_template_that_cannot_be_used_is_refused_with_the_list_of_keys(template):
    with pytest.raises(gs.SettingError, match=r"\{name\}, \{material\}, \{thickness\}"):
        process(files=template)


def test_sheets_of_another_kind_do_not_replace_those_of_strips():
    files = FileNames("{name}-{number}")
    names = {files.named(name="roof", prefix=p, number="01") for p in ("sheet", "panels", "stars")}
    assert names == {"roof-01", "panels-roof-01", "stars-roof-01"}


@given(name=st.text(max_size=30))
def test_a_name_is_one_that_files_can_have(name):
    found = FileNames("{name}_{number}").named(name=name, number="01")
    assert found
    assert not set(found) & set('/\\:*?"<>|\n')
    assert found.endswith("01")
