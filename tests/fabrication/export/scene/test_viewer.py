"""The 3D view of a report in a browser: what is shown against what was designed."""

from io import BytesIO
from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

import fabrication as fab
import gridshell as gs
from fabrication.export.report import write_report
from fabrication.motion import motion
from fabrication.parts import parts_of
from fabrication.strength import bay_stress

pytestmark = pytest.mark.xdist_group("browser")


@pytest.fixture(scope="module")
def design():
    control = gs.control_patch(gs.Catenoid(1000.0), gs.BisectingPatch((-0.8, 0.8), 24))
    net, _ = gs.diagonal_meshes(control)
    jointed = fab.SlotJoint().build(fab.structure(net, fab.Profile(100.0, 2.5, fab.STAINLESS)))
    return jointed, parts_of(jointed)


@pytest.fixture(scope="module")
def opened(chromium, design, tmp_path_factory):
    """The page, and what the browser complained of while it was used."""
    path = tmp_path_factory.mktemp("view") / "report.html"
    write_report(path, name="Pavilion", report={}, jointed=design[0], parts=design[1])
    page = chromium.new_page(viewport={"width": 1280, "height": 1000})
    told = []
    page.on("console", lambda message: told.append(message.text))
    page.on("pageerror", lambda error: told.append(str(error)))
    page.on("request", lambda request: told.append(request.url))
    page.goto(path.as_uri())
    page.wait_for_selector(".gv-layers label")
    yield page, told
    assert [line for line in told if not line.startswith(("file:", "blob:"))] == []
    page.close()


@pytest.fixture
def page(opened):
    page, _ = opened
    page.evaluate("() => { view.select(null); view.bend(1); view.colour(null); view.frame(); }")
    return page


def tip(page):
    return page.locator(".gv-tip")


def test_every_layer_can_be_switched(page):
    names = page.locator(".gv-layer").all_inner_texts()
    assert names == ["Family A", "Family B", "Marks", "Nodes", "Node axes", "Axes, 0.1 m long"]
    shown = "() => view.state.layers.get('strips-A').made.objects[0].visible"
    assert page.evaluate(shown)
    page.get_by_label("Family A").uncheck()
    assert not page.evaluate(shown)
    page.get_by_label("Family A").check()
    assert page.evaluate(shown)


def stage(page):
    """The frame of the view as it is on the screen."""
    page.wait_for_timeout(700)
    picture = Image.open(BytesIO(page.locator(".gv-stage").screenshot()))
    return np.asarray(picture.convert("RGB")).astype(int)


def changed(page, before):
    """Pixels that are no longer as in the picture *before*, outside the list of layers."""
    away = np.abs(stage(page) - before).max(axis=2) > 24
    away[:260, :200] = False
    return int(np.count_nonzero(away))


def alone(page, name):
    """Pixels that a layer draws when no other is shown; all are shown again afterwards."""
    boxes = page.locator(".gv-layer input")
    was = [boxes.nth(k).is_checked() for k in range(boxes.count())]
    for k in range(boxes.count()):
        boxes.nth(k).set_checked(False)
    empty = stage(page)
    page.get_by_label(name, exact=True).check()
    drawn = changed(page, empty)
    for k, checked in enumerate(was):
        boxes.nth(k).set_checked(checked)
    return drawn


def test_every_layer_draws_something_when_it_is_asked_for(page):
    for name in page.locator(".gv-layer").all_inner_texts():
        assert alone(page, name) > 50, name


def test_a_net_that_opens_is_seen_in_every_position(chromium, tmp_path):
    umbrella = gs.Umbrella(10, 1000.0, (600.0,) * 4)
    profile = fab.Profile(50.0, 4.0, fab.GRP)
    found = motion(umbrella.position(0.4), profile, count=5, limits=(0.35, 2.79))
    control = gs.control_patch(gs.Catenoid(1000.0), gs.BisectingPatch((-0.8, 0.8), 24))
    net, _ = gs.diagonal_meshes(control)
    jointed = fab.SlotJoint().build(fab.structure(net, fab.Profile(100.0, 2.5, fab.STAINLESS)))
    path = tmp_path / "report.html"
    more = {"moving": (found, found.steps[2].opening)}
    parts = parts_of(jointed)
    write_report(path, name="Umbrella", report={}, jointed=jointed, parts=parts, **more)
    page = chromium.new_page(viewport={"width": 1280, "height": 1000})
    page.goto(path.as_uri())
    page.wait_for_selector(".gv-open input")
    built = stage(page)
    blank = np.full_like(built, 255)
    seen = []
    for number in (0, 2, 4):
        page.evaluate("(number) => view.open(number)", number)
        assert changed(page, blank) > 1000
        assert changed(page, built) > 20_000
        seen.append(stage(page))
    assert all(np.abs(a - b).max() > 24 for a, b in pairwise(seen))
    page.get_by_role("button", name="As built").click()
    assert changed(page, built) < 5000  # edges are smoothed when nothing moves
    page.close()


def test_everything_is_in_the_frame_and_fills_it(page):
    """Of all points on the screen, in the frame's own coordinates from -1 to 1."""
    spread = page.evaluate(
        """() => {
          const { layers } = view.state, points = [];
          const camera = view.camera;
          for (const id of ["strips-A", "strips-B"]) {
            const all = layers.get(id).made.points;
            for (let n = 0; n < all.length; n += 3) {
              const at = camera.position.clone().fromArray(all, n).project(camera);
              points.push(Math.abs(at.x), Math.abs(at.y));
            }
          }
          return points;
        }"""
    )
    assert 0.8 < max(spread) <= 1.0


def test_pointing_at_a_strip_tells_its_numbers(page, design):
    _, parts = design
    page.get_by_label("Nodes").uncheck()
    part = next(part for part in parts if part.mark == "B5")
    page.mouse.move(*page.evaluate("() => view.where('B5')"))
    tip(page).wait_for()
    told = tip(page).inner_text()
    mark = told.splitlines()[0]  # another strip may stand before it
    part = next(part for part in parts if part.mark == mark)
    assert f"length {part.length:,.1f} mm".replace(",", "\u202f") in told
    assert f"{len(part.slots)} slots" in told
    page.get_by_label("Nodes").check()


def test_clicking_a_strip_shows_it_alone_with_its_flat_pattern(page, design):
    _, parts = design
    page.evaluate("() => view.select('A3')")
    side = page.locator(".gv-side")
    side.locator("svg").wait_for()
    part = next(part for part in parts if part.mark == "A3")
    assert side.locator("strong").inner_text() == "A3"
    texts = side.locator("svg text").all_text_contents()
    assert f"{part.length:,.1f}".replace(",", "\u202f") in texts
    faint = "() => view.state.layers.get('strips-B').made.materials[0].opacity"
    assert page.evaluate(faint) < 0.5
    page.keyboard.press("Escape")
    assert side.is_hidden()
    assert page.evaluate(faint) == 1.0


def test_colours_come_with_a_legend_in_units(page, design):
    jointed, parts = design
    stress = bay_stress(jointed.strips, parts)
    page.get_by_role("button", name="Von Mises stress").click()
    high = page.locator(".gv-high").inner_text()
    assert high.endswith("N/mm²")
    worst = float(stress.von_mises_edge.max())
    assert float(high.split()[0]) == pytest.approx(worst, rel=5e-3)
    page.get_by_role("button", name="Plain").click()
    assert page.locator(".gv-scale").count() == 0


def points(page, name):
    flat = page.evaluate(f"() => Array.from(view.state.layers.get('{name}').made.points)")
    return np.array(flat).reshape(-1, 3)


def test_strips_bend_from_flat_to_built_and_keep_their_length(page, design):
    _, parts = design
    built = points(page, "strips-A")
    page.locator(".gv-bend input").fill("0")
    flat = points(page, "strips-A")
    assert np.ptp(flat[:, 2]) < 1e-5  # on the ground
    longest = max(part.length for part in parts if part.mark.startswith("A"))
    assert np.ptp(flat[:, 0]) == pytest.approx(longest / 1e3, rel=1e-4)
    columns = page.evaluate("() => Array.from(view.state.layers.get('strips-A').made.columns)")
    heights = page.evaluate("() => Array.from(view.state.layers.get('strips-A').made.heights)")
    for share in (0, 30, 70):
        page.locator(".gv-bend input").fill(str(share))
        now = points(page, "strips-A")
        same = np.flatnonzero(np.diff(columns) == 0)
        apart = np.linalg.norm(now[same + 1] - now[same], axis=1)
        assert apart == pytest.approx(np.abs(np.diff(heights))[same], abs=1e-5)
    page.locator(".gv-bend input").fill("100")
    np.testing.assert_allclose(points(page, "strips-A"), built, atol=1e-6)


def test_the_page_prints_a_picture(page):
    page.wait_for_timeout(600)
    assert page.evaluate("() => document.getElementById('still').src.length") > 10_000
