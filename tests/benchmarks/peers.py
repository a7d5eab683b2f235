"""What others reach on the same inputs, two cores (measured side by side, November 2026).

Seconds a step for an A-net at 90 degrees on 1,440, 10,000 and 100,000 quads; None where a program
does not run at that size. DOS is the public Python code for A-nets, with PARDISO put in its place.
"""

SECONDS_A_STEP = {
    "paper (C++, 2020)": (0.25, None, None),
    "DOS as shipped": (0.28, 7.9, None),
    "DOS with PARDISO": (0.058, 0.49, 13.9),
    "Ceres (C++)": (0.034, 0.37, 5.8),
    "ShapeOp (local/global)": (0.0015, 0.013, 0.20),
}

ENDS = {
    "ennd 1,440 n05 at 90": "DOS, enne: star 8e-9, angle 2.2 deg without the boundary, 9.1 s",
    "tran 1,440 n05 PQ": "DOS 1e-10 moving 0.87; ShapeOp 6e-4; libigl 2e-4; mpfp 2e-9 in 55 s",
    "wave 1,440 PQ": "DOS folds; ShapeOp stalls at 1e-2; libigl 5e-3; mpfp 5e-2 and folds",
}
"""Where they end."""

TABLE_1 = (
    # figure, |V|, |F|, seconds of ten steps
    ("6e", 409, 360, 0.3),
    ("6f", 427, 378, 0.3),
    ("7", 800, 750, 0.8),
    ("8", 614, 527, 0.4),
    ("9", 1499, 1440, 2.5),
    ("12", 1860, 1770, 1.5),
    ("13", 787, 720, 1.0),
    ("14", 679, 606, 0.8),
)
"""The paper's Table 1."""
