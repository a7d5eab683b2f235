"""A motion as one HTML page with a slider; it opens from disk."""

from __future__ import annotations

import base64
import json
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import Environment, FileSystemLoader
from markupsafe import Markup
from plotly.offline import get_plotlyjs

from fabrication.colours import FAMILY_COLOURS, css
from fabrication.export.motion_glb import strip_triangles
from fabrication.motion import Motion, MotionStep
from fabrication.words import fixed, plural

_STEPS = 65_535
"""Places along the largest side that coordinates are rounded to."""

_EVERY = 2
"""Of the places along a strip, one in so many is drawn."""

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
    """Write the page; it begins at the position nearest to *opening*."""
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(fixed=fixed, plural=plural)
    openings = [step.opening for step in found.steps]
    page = environment.get_template("motion.html").render(
        name=name,
        steps=found.steps,
        kept=found.kept,
        planar=found.planar,
        cables=found.umbrella.ribs,
        low=found.cable.low,
        high=found.cable.high,
        begin=int(np.argmin(np.abs(np.array(openings) - opening))),
        labels=_LABELS,
        data=Markup(json.dumps(_data(found)).replace("<", "\\u003c")),
        plotly=Markup(get_plotlyjs()),
    )
    Path(path).write_text(page, encoding="utf-8")


def _data(found: Motion) -> dict[str, Any]:
    """Positions as whole numbers of a grid over the whole motion, in metres."""
    strips = np.stack([step.strips[:, ::_EVERY] for step in found.steps]) / 1000.0
    count, places = strips.shape[1:3]
    points = strips.reshape(len(strips), -1, 3)
    low, high = points.min(axis=(0, 1)), points.max(axis=(0, 1))
    scale = float((high - low).max()) / _STEPS
    whole = np.round((points - low) / scale).astype("<u2")
    frames = [base64.b64encode(frame.tobytes()).decode() for frame in whole]
    meshes = []
    for family, first, last in ((1, 0, found.first), (2, found.first, count)):
        i, j, k = strip_triangles(last - first, places).T.tolist()
        meshes.append(
            {
                "name": f"family {'AB'[family - 1]}",
                "colour": css(FAMILY_COLOURS[family]),
                "from": first * places * 2,
                "to": last * places * 2,
                "i": i,
                "j": j,
                "k": k,
            }
        )
    texts = [_texts(step) for step in found.steps]
    return {
        "low": low.tolist(),
        "size": (high - low).tolist(),
        "scale": scale,
        "frames": frames,
        "meshes": meshes,
        "texts": {key: [text[key] for text in texts] for key, _ in _LABELS},
        "steps": {
            "opening": [round(step.opening, 4) for step in found.steps],
            "smallest": [round(degrees(step.angles[0]), 2) for step in found.steps],
            "largest": [round(degrees(step.angles[1]), 2) for step in found.steps],
            "used": [round(100.0 * step.utilisation, 1) for step in found.steps],
        },
    }


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
