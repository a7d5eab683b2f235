import json
import re
from dataclasses import replace

import numpy as np
import pytest

import fabrication as fab
from fabrication.strength import NOT_CHECKED, bay_stress
from fabrication.stress_checks import stress_findings, stress_section


def judged(design, profile):
    structure = replace(design.structure, profile=profile)
    stress = bay_stress(structure, design.parts)
    found = stress_findings(structure, stress)
    return stress, [f for own in found for f in own]


def steel(**changes):
    values = {"name": "test", "modulus": 200e3, "strength": 220.0, "density": 7900.0} | changes
    return fab.Material(**values)


def test_each_strip_has_one_finding_per_code_that_names_its_worst_bay(enneper):
    stress, found = judged(enneper, fab.Profile(100.0, 12.0, steel(strength=60.0)))
    keys = [(f.where, f.code) for f in found]
    assert len(keys) == len(set(keys)) > 0
    for f in found:
        if f.code == "stress":
            index = [one.mark for one in enneper.structure.lamellas].index(f.where)
            bays = stress.of_strip(index)
            worst = bays[np.argmax(stress.utilisation[bays])]
            assert f.message.startswith(stress.where(worst))
            assert f.value == pytest.approx(stress.utilisation[bays].max() * 60.0)


def test_stress_is_found_where_each_part_of_it_alone_would_pass(hypar):
    """Straight twisted strips: shear to 0.9 of its limit, and the edges' stretch besides."""
    rate = 1.0 / 6000.0
    width = 800.0
    stretch = 200e3 * (rate * width) ** 2 / 12.0
    strength = 1.3 * stretch
    thickness = 0.9 * strength / (np.sqrt(3.0) * 200e3 / 2.6 * rate)
    profile = fab.Profile(width, float(thickness), steel(strength=float(strength)))
    _, found = judged(hypar, profile)
    assert {f.code for f in found} == {"stress"}


@pytest.mark.parametrize(("word", "sizes"), [("thick", (100.0, 12.0)), ("wide", (600.0, 1.5))])
def test_the_size_that_is_named_would_do_and_a_little_more_would_not(enneper, word, sizes):
    profile = fab.Profile(*sizes, steel(strength=150.0))
    f = next(f for f in judged(enneper, profile)[1] if f.code == "stress")
    size = float(re.search(rf"([\d.]+) mm {word}", f.message)[1])
    for more, told in ((0.0, False), (0.11, True)):
        key = {"thick": "thickness", "wide": "width"}[word]
        again = judged(enneper, replace(profile, **{key: size + more}))[1]
        assert (f.where in {g.where for g in again if g.code == "stress"}) == told


def test_where_nothing_would_do_the_finding_says_so(tube):
    _, found = judged(tube, fab.Profile(100.0, 2.5, steel(strength=1e-4)))
    told = [f.message for f in found if f.code == "stress"]
    assert any("No thickness and no width would do" in message for message in told)


def test_the_twist_finding_names_a_thickness(hypar):
    profile = fab.Profile(100.0, 4.0, steel(strength=50.0))
    f = next(f for f in judged(hypar, profile)[1] if f.code == "twist")
    thickest = float(re.search(r"At most ([\d.]+) mm", f.message)[1])
    again = judged(hypar, replace(profile, thickness=thickest))[1]
    assert f.where not in {g.where for g in again if g.code == "twist"}


# ---- the summary ----------------------------------------------------------------------------


def test_the_summary_is_the_worst_of_all_bays_and_plain_json(enneper):
    stress, _ = judged(enneper, enneper.structure.profile)
    section = json.loads(json.dumps(stress_section(stress), allow_nan=False))
    worst = int(np.argmax(stress.utilisation))
    assert section["utilisation"] == {
        "max": pytest.approx(stress.utilisation.max()),
        "where": stress.where(worst),
    }
    assert section["von_mises_n_mm2"]["max"] == pytest.approx(stress.von_mises_edge.max())
    assert section["twist_deg_per_m"]["max"] == pytest.approx(np.degrees(stress.twist.max()) * 1e3)
    assert section["radius_mm"]["min"] == pytest.approx(stress.radius.min())
    assert section["thickest_mm"]["min"] == pytest.approx(stress.thickest.min())
    assert section["not_checked"] == list(NOT_CHECKED)


def test_a_radius_without_end_is_null(hypar):
    stress, _ = judged(hypar, hypar.structure.profile)
    assert stress_section(replace(stress, radius=np.full(len(stress), np.inf)))["radius_mm"] == {
        "min": None
    }
