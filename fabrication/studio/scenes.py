"""What the studio's 3D view shows of a net and of what is built on it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fabrication.export.scene.layers import Colouring, Scene
from fabrication.export.scene.net import net_colourings, net_layers
from fabrication.export.scene.whole import lamella_scene, middle, panel_scene
from fabrication.lamella_system import LamellaSystem
from fabrication.panel_route import PanelNetSystem
from fabrication.studio.design import Built, NetDesign
from gridshell.arrays import Floats


def centre_of(net: NetDesign) -> Floats:
    """(3,) mm, of the box around the control mesh: the origin of all scenes of a session."""
    return middle(net.result.control.vertices)


def net_scene(net: NetDesign, centre: Floats) -> Scene:
    """The net alone, with the colourings of its quads."""
    layers = net_layers(net.result.control, centre, shown=True)
    return Scene(layers, net_colourings(net.figures))


def built_scene(built: Built, centre: Floats) -> Scene:
    """Everything: what is built, and the net under it."""
    system, control = built.system, built.net.result.control
    if isinstance(system, LamellaSystem):
        moving = system.moving
        scene = lamella_scene(
            system.jointed,
            system.parts,
            system.stress,
            facade=None if system.facade is None else system.facade.built,
            copies=() if system.segmented is None else system.segmented.segments.poses[1:],
            net=control,
            moving=None if moving is None else (moving.motion, moving.opening),
            centre=centre,
        )
    elif isinstance(system, PanelNetSystem):
        scene = panel_scene(system.built, net=control, centre=centre)
    else:
        raise AssertionError("there are two kinds of systems")
    return _with(scene, net_colourings(built.net.figures))


def _with(scene: Scene, more: Sequence[Colouring]) -> Scene:
    return Scene(scene.layers, [*more, *scene.colourings])


def residual_chart(residuals: Sequence[float], tolerance: float) -> str:
    """The largest residual after every step on a logarithmic scale, as an SVG."""
    width, height, edge = 260.0, 74.0, 6.0
    logs = np.log10(np.maximum(np.asarray([*residuals, tolerance], dtype=np.float64), 1e-16))
    high, low = float(logs.max()), float(logs.min())
    span = max(high - low, 1.0)
    x = edge + (width - 2 * edge) * np.arange(len(residuals)) / max(len(residuals) - 1, 1)
    y = edge + (height - 2 * edge) * (high - logs) / span
    line = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y[:-1], strict=True))
    dots = "".join(
        f'<circle cx="{a:.1f}" cy="{b:.1f}" r="2"/>' for a, b in zip(x, y[:-1], strict=True)
    )
    goal = float(y[-1]) if len(residuals) else height - edge
    told = f"{residuals[-1]:.0e} after {len(residuals)} steps" if residuals else "no step needed"
    return (
        f'<svg viewBox="0 0 {width:g} {height:g}" width="100%" role="img" '
        f'aria-label="Largest residual by step">'
        f'<path d="M{edge:g} {goal:.1f}H{width - edge:g}" stroke="#2c7a4b" '
        f'stroke-dasharray="3 3" fill="none"/>'
        f'<polyline points="{line}" fill="none" stroke="#5c7894" stroke-width="1.5"/>'
        f'<g fill="#1c232d">{dots}</g>'
        f'<text x="{width - edge:g}" y="{edge + 6:g}" text-anchor="end" font-size="10" '
        f'fill="#5a6472">{told}; {tolerance:.0e} wanted</text></svg>'
    )
