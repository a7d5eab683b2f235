from math import radians

import pytest

import fabrication as fab
import gridshell as gs
from fabrication.joint_settings import joint_of
from fabrication.sections import Project

PROFILE = fab.Profile(width=100.0, thickness=2.5, material=fab.STAINLESS)
REST = {
    "name": "roof",
    "surface": {"kind": "hypar", "scale": 6000.0},
    "patch": {"layout": "asymptotic", "p": (-0.2, 0.2), "q": (-0.2, 0.2), "lamellas": (3, 3)},
    "net": {"anchor": "free"},
    "profile": {"width": 100.0, "thickness": 2.5, "material": "stainless"},
    "sheet": {"length": 4000.0, "width": 1000.0},
}


def made(**joint):
    wall = {"width": 40.0, "thickness": 14.0, "wall": 2.0, "material": "GRP"}
    more = {"profile": wall} if joint["kind"] == "hinged" else {}
    project = Project.model_validate({**REST, **more, "joint": joint})
    return joint_of(project.joint, PROFILE)


@pytest.mark.parametrize(
    ("section", "joint"),
    [
        (
            {"kind": "slot", "clearance": 0.1, "weld": 30.0},
            fab.SlotJoint(clearance=0.1, weld=30.0),
        ),
        (
            {"kind": "scissor", "opens_from": 50.0, "control": 5.0},
            fab.ScissorJoint(opens_from=radians(50.0), control=radians(5.0)),
        ),
        (
            {"kind": "reciprocal", "gap": 1.0, "through": "B", "pinwheel": True, "sharpest": 40.0},
            fab.ReciprocalJoint(gap=1.0, through=2, pinwheel=True, sharpest=radians(40.0)),
        ),
        (
            {"kind": "reciprocal", "cleat": {"leg": 60.0, "thickness": 5.0, "height": 80.0}},
            fab.ReciprocalJoint(cleat=fab.Cleat(60.0, 5.0, 80.0, fab.STAINLESS)),
        ),
        (
            {
                "kind": "two-level",
                "spacing": 30.0,
                "level": 55.0,
                "bolt": 8.0,
                "stud": {"material": "birch-ply", "wall": 2.0},
                "blocks": {"length": 60.0, "per_bay": 2},
            },
            fab.StudJoint(
                30.0,
                fab.Stud(fab.BIRCH_PLY, wall=2.0),
                level=55.0,
                bolt=8.0,
                blocks=fab.ShearBlock(2, 60.0, fab.STAINLESS),
            ),
        ),
        (
            {
                "kind": "double-slot",
                "spacing": 30.0,
                "bolt": 8.0,
                "washer": {"thickness": 4.0, "arm": 18.0, "material": "S235"},
            },
            fab.DoubleSlotJoint(30.0, 8.0, fab.StarWasher(4.0, 18.0, 8.0, fab.S235)),
        ),
        ({"kind": "hinged", "pin": 6.0, "gap": 5.0}, fab.HingedJoint(6.0, gap=5.0)),
    ],
    ids=lambda value: value["kind"] if isinstance(value, dict) else "",
)
def test_a_section_is_its_joint(section, joint):
    assert made(**section) == joint


def test_every_joint_of_the_registry_has_a_section():
    for kind in fab.JOINTS:
        more = {
            "two-level": {"spacing": 30.0},
            "hinged": {"pin": 6.0},
            "double-slot": {
                "spacing": 30.0,
                "bolt": 8.0,
                "washer": {"thickness": 4.0, "arm": 18.0},
            },
        }.get(kind, {})
        assert isinstance(made(kind=kind, **more), fab.JOINTS[kind])


def test_sizes_that_cannot_be_are_refused_by_their_key():
    with pytest.raises(gs.SettingError) as info:
        made(kind="reciprocal", sharpest=90.0)
    assert info.value.where == "sharpest"


@pytest.mark.parametrize(
    ("joint", "profile", "where"),
    [
        ({"kind": "hinged", "pin": 6.0}, {}, "profile.wall"),
        ({"kind": "slot"}, {"wall": 0.5}, "profile.wall"),
    ],
)
def test_walls_and_hinges_go_together(tmp_path, joint, profile, where):
    import json

    from fabrication.errors import ProjectError
    from fabrication.project import read_project

    text = json.dumps({**REST["profile"], **profile}).replace(":", " =")
    lines = ['name = "x"', f"profile = {text}", "joint = " + json.dumps(joint).replace(":", " =")]
    lines += ['surface = { kind = "hypar", scale = 6000.0 }', 'net = { anchor = "free" }']
    patch = 'layout = "asymptotic", p = [-0.2, 0.2], q = [-0.2, 0.2], lamellas = [3, 3]'
    lines += [f"patch = {{ {patch} }}", "sheet = { length = 4000.0, width = 1000.0 }"]
    (tmp_path / "p.toml").write_text("\n".join(lines))
    with pytest.raises(ProjectError) as info:
        read_project(tmp_path / "p.toml")
    assert f", {where}" in str(info.value)
