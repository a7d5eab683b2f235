import numpy as np

from gridshell.constraints import FieldAngle, NodeAngle

QUAD = np.array([[0, 1, 2, 3]])
X = np.array([0.0, 0, 0, 2, 0.1, 0, 2, 2, 0.3, 0.2, 2, 0])


def test_the_field_is_asked_in_the_middle_of_the_corners():
    heard = []

    def field(points):
        heard.append(points[0].tolist())
        return np.full(len(points), 1.2)

    found = FieldAngle(QUAD, field).evaluate(X, None)
    np.testing.assert_allclose(heard[0], X.reshape(4, 3).mean(axis=0))
    same = NodeAngle(QUAD, np.array([1.2])).evaluate(X, None)
    np.testing.assert_allclose(found.residual, same.residual, atol=1e-15)
    np.testing.assert_allclose(found.values, same.values, atol=1e-9)


def test_a_field_that_says_what_is_there_is_met():
    angle = np.arccos(NodeAngle(QUAD, np.array([np.pi / 2.0])).evaluate(X, None).residual[0, 0])
    assert (
        abs(FieldAngle(QUAD, lambda p: np.full(len(p), angle)).evaluate(X, None).residual) < 1e-12
    )
