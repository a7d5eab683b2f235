from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
import pytest
from scipy.integrate import quad

import fabrication as fab
import gridshell as gs

COUNT = 25


# ---- against exact curves -------------------------------------------------------------------


@dataclass(frozen=True)
class Exact:
    """A net of exact points whose 25-node lamellas are 10 m long, and its curves' true lengths.

    ``p`` and ``q`` are the parameters of the lamellas along p; ``arc(q, p0, p1)`` is exact, mm.
    """

    surface: gs.AnalyticSurface
    p: np.ndarray
    q: np.ndarray
    arc: Callable[[float, float, float], float]
    straight: bool

    def truth(self, q: float) -> np.ndarray:
        """(25,) exact stations of the nodes of the lamella q = const."""
        bays = [self.arc(q, a, b) for a, b in zip(self.p[:-1], self.p[1:], strict=True)]
        return np.r_[0.0, np.cumsum(bays)]

    def points(self, q: float) -> np.ndarray:
        return self.surface.asymptotic_point(self.p, np.full(COUNT, q))

    def chords(self, q: float) -> np.ndarray:
        return np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(self.points(q), axis=0), axis=1))]


def along_p(surface, q, a, b):
    def speed(p):
        d = surface.derivatives((p + q) / 2.0, (p - q) / 2.0)
        return float(np.linalg.norm(d.xu + d.xv)) / 2.0

    return quad(speed, a, b, epsabs=1e-9, epsrel=1e-12)[0]


def on_catenoid(surface, q, a, b):
    v0, v1 = (a - q) / 2.0, (b - q) / 2.0
    return surface.radius * np.sqrt(2.0) * abs(np.sinh(v1) - np.sinh(v0))


def on_hypar(surface, q, a, b):
    ends = surface.asymptotic_point(np.array([a, b]), np.array([q, q]))
    return float(np.linalg.norm(ends[1] - ends[0]))


def exact(surface, arc, p, q, *, straight=False):
    p, q = np.linspace(*p, COUNT), np.linspace(*q, 5)
    return Exact(surface, p, q, partial(arc, surface), straight)


CASES = {
    "catenoid": exact(gs.Catenoid(4000.0), on_catenoid, (-1.6, 1.6), (-0.1, 0.1)),
    "enneper": exact(gs.Enneper(4500.0), along_p, (-1.2, 1.2), (0.3, 0.6)),
    "hypar": exact(gs.Hypar(6000.0), on_hypar, (-0.8, 0.8), (-0.3, 0.3), straight=True),
}


@pytest.fixture(scope="module", params=CASES)
def measured(request, profile):
    """A case and the developments of its five long lamellas by their parameter q."""
    case = CASES[request.param]
    p, q = (case.p[0], case.p[-1]), (case.q[0], case.q[-1])
    patch = gs.AsymptoticPatch(p, q, (len(case.q), COUNT))
    net = gs.diagonal_meshes(gs.control_patch(case.surface, patch))[0]
    found = {}
    for lamella in fab.structure(net, profile).lamellas:
        if len(lamella.nodes) == COUNT:
            ends = net.vertices[lamella.nodes[[0, -1]]]
            q = min(case.q, key=lambda q: np.linalg.norm(case.points(q)[[0, -1]] - ends))
            found[q] = fab.unroll(lamella, profile.width)
    assert sorted(found) == sorted(case.q)
    return case, found


def stations(development):
    return development.node_x - development.node_x[0]


def test_node_stations_are_true_within_a_tenth_of_a_millimetre_where_chords_are_not(measured):
    case, found = measured
    for q, development in found.items():
        truth = case.truth(q)
        assert 9e3 < truth[-1] < 11e3
        assert np.abs(stations(development) - truth).max() < 0.1
        assert (np.abs(case.chords(q) - truth).max() < 0.1) == case.straight


def test_developed_lengths_are_true_arc_lengths_and_two_overhangs(measured, profile):
    case, found = measured
    for q, development in found.items():
        assert abs(development.length - profile.width - case.truth(q)[-1]) < 0.1


def test_the_exact_integral_agrees_with_the_closed_form_of_the_catenoid():
    surface = CASES["catenoid"].surface
    assert along_p(surface, 0.3, -1.0, 1.2) == pytest.approx(on_catenoid(surface, 0.3, -1.0, 1.2))


# ---- the flat strip -------------------------------------------------------------------------


def test_the_first_node_lies_one_overhang_from_the_cut_end(enneper, profile):
    for lamella in enneper.structure.lamellas:
        assert fab.unroll(lamella, profile.width).node_x[0] == profile.width / 2.0


def test_the_overhang_is_an_arc_length_too(profile):
    case = CASES["catenoid"]
    patch = gs.AsymptoticPatch((-1.0, 1.0), (-0.2, 0.2), (3, 15))
    net = gs.diagonal_meshes(gs.control_patch(case.surface, patch))[0]
    for lamella in fab.structure(net, profile).lamellas:
        s = np.array([0.0, lamella.axis.length])
        outside = np.array([lamella.start, lamella.end])
        chord = np.linalg.norm(lamella.axis.spline(outside) - lamella.axis.spline(s), axis=1)
        np.testing.assert_allclose(chord, profile.width / 2.0, atol=1e-3)


def test_an_asymptotic_strip_needs_no_push_sideways(measured):
    case, found = measured
    for q, development in found.items():
        assert development.edgewise < 1e-4 * case.truth(q)[-1]


def test_a_hoop_must_be_pushed_sideways(tube, profile):
    """A hoop of a hyperboloid bulges out of any straight strip by far more than it is wide."""
    hoop = next(one for one in tube.structure.lamellas if one.closed)
    assert fab.unroll(hoop, profile.width).edgewise > profile.width


@pytest.mark.parametrize("name", ["catenoid", "hypar"])
def test_the_edge_strain_is_half_the_square_of_twist_times_half_width(name, request, profile):
    design = request.getfixturevalue(name)
    for lamella, part in zip(design.structure.lamellas, design.parts, strict=True):
        s = np.linspace(0.0, lamella.axis.length, 500)
        strain = (np.abs(lamella.twist(s)).max() * profile.width / 2.0) ** 2 / 2.0
        assert part.development.edge_strain == pytest.approx(strain, rel=1e-2)


def test_a_wider_strip_strains_with_the_square_of_its_width(hypar):
    lamella = hypar.structure.lamellas[0]
    narrow, wide = (fab.unroll(lamella, width).edge_strain for width in (50.0, 100.0))
    assert wide == pytest.approx(4.0 * narrow, rel=1e-12)
