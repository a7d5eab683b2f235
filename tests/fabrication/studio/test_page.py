"""A click through the studio in a browser; what it shows against what report.json says."""

import json
import re
import socket
import tomllib
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

pytestmark = pytest.mark.xdist_group("browser")

WAIT = 60_000


def opened(chromium, studio, told=None):
    page = chromium.new_page(viewport={"width": 1500, "height": 950})
    page.set_default_timeout(WAIT)
    if told is not None:
        page.on("pageerror", lambda error: told.append(str(error)))
        page.on("request", lambda request: told.append(request.url))
    studio.visit(page)
    ready(page)
    return page


def ready(page):
    page.locator(".gv-layers label").first.wait_for()
    page.get_by_text("Up to date").wait_for()


def figure(page, key):
    return page.locator(f".gs-line [data-mark='{key}']").last.inner_text()


def typed(page, key):
    return page.locator(f"input[data-mark='{key}']")


def amount(page, key):
    return float(figure(page, key).replace("\u202f", "").split()[0])


def turn(page, key, presses):
    """Move a slider by so many steps, to the right where positive."""
    page.locator(f"[data-mark='slider {key}'] [tabindex='0']").focus()
    for _ in range(abs(presses)):
        page.keyboard.press("ArrowRight" if presses > 0 else "ArrowLeft")
    page.wait_for_timeout(300)
    ready(page)


def ink(page):
    """How much darker than white the 3D view is, in pixels of full black."""
    page.wait_for_timeout(600)
    picture = Image.open(BytesIO(page.locator(".gv-stage").screenshot())).convert("L")
    return int((255 - np.asarray(picture, dtype=int)).sum() / 255)


@pytest.fixture
def studio(path, start_studio):
    return start_studio(path)


def test_a_walk_from_the_project_to_the_package(chromium, studio, path):
    told = []
    page = opened(chromium, studio, told)

    # the net as it is
    assert page.locator(".gs-name").first.inner_text() == "pavilion"
    assert figure(page, "node_angle_deg") == "70.00 to 70.00°"
    assert figure(page, "lamellas") == "11"

    # a slider finds a new net; undo brings the old one back
    turn(page, "net.angle", -10)
    assert figure(page, "node_angle_deg") == "65.00 to 65.00°"
    assert page.locator(".gs-name").first.inner_text() == "pavilion •"
    assert page.locator("[aria-label='Largest residual by step'] circle").count() > 2
    page.get_by_role("button", name="Undo").click()
    page.wait_for_timeout(300)
    ready(page)
    assert figure(page, "node_angle_deg").startswith(("70.00", "65.50"))
    page.get_by_role("button", name="Redo").click()
    page.wait_for_timeout(300)
    ready(page)
    assert figure(page, "node_angle_deg") == "65.00 to 65.00°"

    # layers and colours
    names = page.locator(".gv-layer").all_inner_texts()
    wanted = {"Family A", "Family B", "Nodes", "Node axes", "Control mesh", "Net D1"}
    assert wanted | {"Diagonal mesh D2", "Checkerboard"} <= set(names)
    page.get_by_role("button", name="Distance to surface").click()
    assert page.locator(".gv-high").inner_text().endswith(" mm")
    assert page.get_by_label("Control mesh").is_checked()
    coloured = ink(page)
    page.get_by_label("Control mesh").uncheck()
    assert abs(ink(page) - coloured) > 2000
    for name in ("Net D1", "Diagonal mesh D2", "Checkerboard", "Node axes"):
        before = ink(page)
        page.get_by_label(name).check()
        assert abs(ink(page) - before) > 100, name
        page.get_by_label(name).uncheck()
    page.get_by_role("button", name="Utilisation").click()
    assert "100 %" in page.locator(".gv-high").inner_text()

    # a part alone, with its flat pattern beside
    page.evaluate("() => view.select('A3')")
    page.locator(".gv-pattern svg").wait_for()
    assert "A3" in page.locator(".gv-side").inner_text()
    page.keyboard.press("Escape")

    # the package, and a copy of the project
    page.get_by_role("button", name="Write the package").click()
    page.get_by_role("dialog").get_by_role("button", name="Write the package").click()
    page.get_by_text("The package is in pavilion-package/.").wait_for()
    page.get_by_role("button", name="Save as project").click()
    page.get_by_role("dialog").get_by_label("Name").press("Enter")
    page.get_by_text("Saved a copy as pavilion-2.toml.").wait_for()
    saved = tomllib.loads((path.parent / "pavilion-2.toml").read_text())
    assert saved["net"]["angle"] == 65.0
    report = json.loads((path.parent / "pavilion-package" / "report.json").read_text())
    built, net = report["structure"], report["net"]
    assert figure(page, "lamellas") == str(built["lamellas"])
    assert figure(page, "nodes") == str(built["nodes"])
    assert figure(page, "total_length_m") == f"{built['total_length_m']:.1f} m"
    assert amount(page, "mass_kg") == pytest.approx(built["mass_kg"], rel=1e-3)
    assert figure(page, "faces") == str(net["faces"])
    low, high = net["node_angle_deg"]["min"], net["node_angle_deg"]["max"]
    assert figure(page, "node_angle_deg") == f"{low:.2f} to {high:.2f}°"
    away = amount(page, "surface_distance_mm")
    assert away == pytest.approx(net["surface_distance_mm"]["max"], rel=1e-3)
    used = report["stress"]["utilisation"]["max"]
    assert figure(page, "utilisation") == f"{100 * used:.0f} %"

    # nothing was fetched from elsewhere, and the page had no fault
    host = studio.address.split("/?")[0]
    here = (host, host.replace("http", "ws", 1), "data:", "blob:")
    assert [line for line in told if not line.startswith(here)] == []
    page.close()
    code, said = studio.end()
    assert code == 0
    assert "What was not saved is in pavilion-unsaved.toml." in said
    kept = tomllib.loads((path.parent / "pavilion-unsaved.toml").read_text())
    assert kept["net"]["angle"] == 65.0


def test_a_number_can_be_typed_and_a_wrong_one_is_explained(chromium, studio):
    page = opened(chromium, studio)
    typed(page, "net.angle").fill("62.35")
    typed(page, "net.angle").press("Enter")
    page.wait_for_timeout(300)
    ready(page)
    assert figure(page, "node_angle_deg") == "62.35 to 62.35°"
    typed(page, "net.angle").fill("190")
    typed(page, "net.angle").press("Enter")
    told = page.locator("[data-mark=trouble]")
    told.wait_for()
    assert "net.angle" in told.inner_text()
    assert figure(page, "node_angle_deg") == "62.35 to 62.35°"
    assert typed(page, "net.angle").input_value() == "62.35"
    typed(page, "net.angle").fill("")
    typed(page, "net.angle").press("Enter")
    page.wait_for_timeout(300)
    assert typed(page, "net.angle").input_value() == "62.35"
    typed(page, "patch.lamellas.0").fill("7.6")
    typed(page, "patch.lamellas.0").press("Enter")
    page.wait_for_timeout(300)
    ready(page)
    assert typed(page, "patch.lamellas.0").input_value() == "8"
    assert figure(page, "lamellas") == "13"
    page.close()


def test_a_browser_that_goes_away_finds_everything_again(chromium, studio):
    first = opened(chromium, studio)
    turn(first, "profile.width", 5)
    assert typed(first, "profile.width").input_value() == "85"
    first.close()
    again = opened(chromium, studio)
    assert typed(again, "profile.width").input_value() == "85"
    assert again.get_by_role("button", name="Undo").is_enabled()
    again.close()


def test_what_another_program_wrote_is_told_and_can_be_loaded(chromium, studio, path):
    page = opened(chromium, studio)
    path.write_text(path.read_text().replace("70.0", "64.0"))
    page.get_by_text("was changed by another program").wait_for()
    page.get_by_role("button", name="Load it").click()
    page.wait_for_timeout(300)
    ready(page)
    assert figure(page, "node_angle_deg") == "64.00 to 64.00°"
    page.close()


def test_a_solve_that_fails_says_so_on_the_page(chromium, start_studio, path):
    path.write_text(path.read_text().replace('anchor = "free"', 'anchor = "free"\nsteps = 5'))
    studio = start_studio(path)
    page = chromium.new_page()
    page.set_default_timeout(WAIT)
    studio.visit(page)
    page.locator("[data-mark=trouble]").wait_for()
    assert "steps" in page.locator("[data-mark=trouble]").inner_text()
    page.close()


def test_findings_of_a_kind_unfold_to_their_places_and_these_show_the_part(
    chromium, start_studio, path
):
    path.write_text(path.read_text().replace("thickness = 2.0", "thickness = 9.0"))
    page = opened(chromium, start_studio(path))
    kind = page.locator("details.gs-find").first
    count = int(re.search(r"at (\d+) places", kind.locator("summary").inner_text())[1])
    places = kind.locator("[data-mark=finding]")
    assert places.count() == min(count, 200) > 1
    assert not places.first.is_visible()
    kind.locator("summary b").click()
    places.nth(1).click()
    mark = re.search(r"at ([AB]\d+)", places.nth(1).inner_text())[1]
    page.locator(".gv-side strong", has_text=mark).wait_for()
    page.close()


def test_without_the_token_the_door_is_shut(chromium, studio):
    page = chromium.new_page()
    answer = studio.visit(page, studio.address.split("?")[0])
    assert answer.status == 403
    page.close()


def test_a_port_in_use_is_named(start_studio, path):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        studio = start_studio(path, "--port", str(port))
        studio.process.wait(timeout=30)
    said = studio.said + studio.process.stdout.read()
    assert studio.process.returncode == 2
    assert str(port) in said
    assert "leave it out" in said
    assert "Traceback" not in said


def test_a_project_that_cannot_be_read_is_named(start_studio, tmp_path):
    studio = start_studio(tmp_path / "nowhere.toml")
    studio.process.wait(timeout=30)
    assert studio.process.returncode == 2
    assert "nowhere.toml" in studio.said
