"""How long a change of the angle takes until the new net is on screen, and how a report turns.

Opt-in, see test_figures. The browser draws in software; the reference beside it is the solve alone.
"""

import json
import subprocess
import sys
import time

import numpy as np
import pytest

import gridshell as gs

pytestmark = pytest.mark.benchmark

MAIN = "from fabrication.cli import main; main()"

PROJECT = """
name = "strips"
[surface]
kind = "enneper"
scale = 4000.0
[patch]
layout = "asymptotic"
p = [-0.6, 0.6]
q = [-0.6, 0.6]
lamellas = [{lines}, {lines}]
[net]
angle = 75.0
anchor = "free"
keep_to_surface = false
[profile]
width = 80.0
thickness = 2.0
material = "stainless"
[joint]
kind = "slot"
clearance = 0.3
[sheet]
length = 6000.0
width = 1500.0
"""

ANGLES = (70.0, 72.0, 68.0, 80.0, 65.0)

LEAST, MOST = 20.0, 160.0
"""Ends of the angle's slider, degrees."""


def solve_alone(lines, angle):
    layout = gs.AsymptoticPatch((-0.6, 0.6), (-0.6, 0.6), (lines, lines))
    control = gs.control_patch(gs.Enneper(4000.0), layout)
    begin = time.perf_counter()
    gs.optimize(control, gs.a_net(angle=np.radians(angle)), anchor=gs.Free()).require()
    return len(control.quads), time.perf_counter() - begin


def until_drawn(page, angle):
    """Press the slider at *angle*; seconds until the net it asks for has been drawn."""
    box = page.locator("[data-mark='slider net.angle']").bounding_box()
    share = (angle - LEAST) / (MOST - LEAST)
    page.mouse.move(box["x"] + share * box["width"] - 3.0, box["y"] + box["height"] / 2.0)
    begin = page.evaluate("performance.now()")
    page.mouse.down()
    while page.evaluate("view.state.news") <= begin:
        page.wait_for_timeout(100)
    page.mouse.up()
    taken = page.evaluate("view.state.news") - begin
    page.get_by_text("Up to date").wait_for()
    page.wait_for_timeout(1000)
    return taken / 1e3


@pytest.mark.parametrize(("lines", "limit"), [(28, 0.5), (71, 3.0)])
def test_a_change_of_the_angle_is_soon_on_screen(chromium, start_studio, tmp_path, lines, limit):
    path = tmp_path / "strips.toml"
    path.write_text(PROJECT.format(lines=lines), encoding="utf-8")
    studio = start_studio(path)
    page = chromium.new_page(viewport={"width": 1500, "height": 950})
    page.set_default_timeout(60_000)
    studio.visit(page)
    page.locator(".gv-layers label").first.wait_for()
    page.get_by_text("Up to date").wait_for()
    page.wait_for_timeout(1500)
    taken = [until_drawn(page, angle) for angle in ANGLES]
    page.close()
    quads, alone = solve_alone(lines, ANGLES[0])
    shown = ", ".join(f"{seconds:.2f}" for seconds in taken)
    middle = float(np.median(taken))
    print(
        f"\n{quads} quads: on screen after {shown} s; median {middle / alone:.2f} x a solve alone"
    )
    assert middle < limit


def test_a_report_of_sixty_strips_is_small_and_soon_seen_and_turns(chromium, tmp_path):
    path, out = tmp_path / "strips.toml", tmp_path / "out"
    path.write_text(PROJECT.format(lines=30), encoding="utf-8")
    subprocess.run([sys.executable, "-c", MAIN, "run", path, "--out", out, "--quiet"], check=True)
    built = json.loads((out / "report.json").read_text())["structure"]
    size = (out / "report.html").stat().st_size / 1e6
    page = chromium.new_page(viewport={"width": 1280, "height": 900})
    begin = time.perf_counter()
    page.goto((out / "report.html").as_uri())
    page.locator("#shell canvas").first.wait_for()
    while page.evaluate("window.view ? view.state.frames : 0") == 0:
        page.wait_for_timeout(20)
    first = time.perf_counter() - begin
    rate = turning(page)
    page.close()
    what = f"{built['lamellas']} lamellas, {built['nodes']} nodes"
    print(f"\n{what}: {size:.1f} MB, first picture {first:.2f} s, {rate:.1f} frames a second")
    assert size < 8.0
    assert first < 2.0
    assert rate >= 15.0


def turning(page, seconds=3.0):
    """Frames a second while the mouse turns the shell."""
    box = page.locator(".gv-stage").bounding_box()
    x, y = box["x"] + box["width"] / 2.0, box["y"] + box["height"] / 2.0
    page.mouse.move(x, y)
    page.mouse.down()
    before, begin, moves = page.evaluate("view.state.frames"), time.perf_counter(), 0
    while time.perf_counter() - begin < seconds:
        moves += 1
        page.mouse.move(x + (7 * moves) % 300 - 150, y + (3 * moves) % 80 - 40)
    taken = time.perf_counter() - begin
    frames = page.evaluate("view.state.frames") - before
    page.mouse.up()
    return frames / taken
