"""A motion as one HTML page: the shell in every position, and what each position asks for."""

from __future__ import annotations

from math import degrees
from pathlib import Path

import numpy as np
from markupsafe import Markup

from fabrication.colours import FAMILY_COLOURS, css
from fabrication.export.html import rendered
from fabrication.export.line_chart import Course, line_chart
from fabrication.export.scene.layers import Scene
from fabrication.export.scene.motion import motion_layers
from fabrication.export.scene.page import as_json, scripts, style
from fabrication.export.scene.whole import middle
from fabrication.motion import Motion, MotionStep

_LABELS = (
    ("opening", "Opening"),
    ("angles", "Node angles"),
    ("height", "Height"),
    ("top", "Radius at the top"),
    ("cable", "Length of a cable"),
    ("lean", "Cable from the vertical"),
    ("force", "All cables pull"),
    ("radius", "Smallest bending radius"),
    ("twist", "Largest twist"),
    ("used", "Strength used"),
)


def write_motion_page(path: Path | str, found: Motion, *, name: str, opening: float) -> None:
    """Write the page; it begins at the position nearest to *opening* and opens from disk."""
    centre = middle(np.concatenate([step.strips.reshape(-1, 3) for step in found.steps]))
    texts = [_texts(step) for step in found.steps]
    page = rendered(
        "motion.html",
        name=name,
        steps=found.steps,
        kept=found.kept,
        planar=found.planar,
        cables=found.umbrella.ribs,
        low=found.cable.low,
        high=found.cable.high,
        labels=_LABELS,
        texts=as_json({key: [text[key] for text in texts] for key, _ in _LABELS}),
        shares=as_json([round(share, 4) for share in _shares(found)]),
        charts=[Markup(svg) for svg in _charts(found)],
        colours={family: css(colour) for family, colour in FAMILY_COLOURS.items()},
        scene=as_json(Scene(motion_layers(found, centre, opening)).packed()),
        scripts=scripts(),
        viewer_style=style(),
    )
    Path(path).write_text(page, encoding="utf-8")


def _shares(found: Motion) -> list[float]:
    """How far along the charts each position stands, 0 to 1."""
    openings = np.array([step.opening for step in found.steps])
    along = (openings - openings[0]) / max(float(openings[-1] - openings[0]), 1e-12)
    return list(along.tolist())


def _charts(found: Motion) -> list[str]:
    """Node angles and strength over the opening, SVG."""
    x = 100.0 * np.array([step.opening for step in found.steps])
    angles = np.degrees([step.angles for step in found.steps])
    used = np.array([100.0 * step.utilisation for step in found.steps])
    first, second = (css(colour) for colour in FAMILY_COLOURS.values())
    strength = [Course("largest", second, used)]
    axis = "opening, %"
    return [
        line_chart(
            x,
            [Course("smallest", second, angles[:, 0]), Course("largest", first, angles[:, 1])],
            title="Node angles",
            unit="degrees",
            axis=axis,
        ),
        line_chart(x, strength, title="Strength used", unit="%", axis=axis),
    ]


def _texts(step: MotionStep) -> dict[str, str]:
    low, high = map(degrees, step.angles)
    return {
        "opening": f"{100.0 * step.opening:.0f} %",
        "angles": f"{low:.1f} to {high:.1f}°",
        "height": f"{step.height / 1000.0:.2f} m",
        "top": f"{step.top_radius / 1000.0:.2f} m",
        "cable": f"{step.cable / 1000.0:.2f} m",
        "lean": f"{degrees(step.lean):.1f}°",
        "force": f"{step.force:.0f} N",
        "radius": f"{step.radius / 1000.0:.2f} m",
        "twist": f"{1000.0 * degrees(step.twist):.1f}°/m",
        "used": f"{100.0 * step.utilisation:.0f} %",
    }
