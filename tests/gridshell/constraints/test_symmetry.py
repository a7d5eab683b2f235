import numpy as np

from gridshell.constraints import Symmetry

NORMAL, ORIGIN = np.array([0.6, 0.0, 0.8]), np.array([1.0, 2.0, 3.0])
A = np.array([0.3, -0.4, 0.9])


def mirrored(point):
    return point - 2.0 * ((point - ORIGIN) @ NORMAL) * NORMAL


def residual(a, b, pair=(0, 1)):
    constraint = Symmetry(np.array([pair]), ORIGIN, NORMAL)
    return constraint.evaluate(np.r_[a, b], None).residual[0]


def test_a_point_and_its_mirror_image_have_no_residual():
    np.testing.assert_allclose(residual(A, mirrored(A)), 0.0, atol=1e-14)


def test_along_the_normal_it_is_the_offset_of_their_middle_and_across_it_their_difference():
    along, across = 0.2 * NORMAL, 0.3 * np.array([0.8, 0.0, -0.6])
    np.testing.assert_allclose(residual(A, mirrored(A) + along), along / 2.0, atol=1e-14)
    np.testing.assert_allclose(residual(A, mirrored(A) + across), across, atol=1e-14)


def test_a_vertex_that_is_its_own_partner_is_drawn_onto_the_plane():
    on = A - ((A - ORIGIN) @ NORMAL) * NORMAL
    np.testing.assert_allclose(residual(on, A, (0, 0)), 0.0, atol=1e-14)
    np.testing.assert_allclose(residual(on + 0.5 * NORMAL, A, (0, 0)), 0.5 * NORMAL, atol=1e-14)
