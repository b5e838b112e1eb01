"""The page of a map and the report in headless Chromium, with real clicks and keys."""
import json

import numpy
import pytest
from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.support.ui import WebDriverWait

from hgmm.report import make_report
from hgmm.view import make_page, scene_of
from hgmm.view.inputs import Poses
from hgmm.view.scene import Ellipsoids

from test_report import example_map, example_metrics

FLAGS = ("--headless=new", "--no-sandbox", "--hide-scrollbars", "--window-size=1280,800",
         "--disable-dev-shm-usage", "--disable-background-networking", "--use-gl=angle",
         "--use-angle=swiftshader", "--enable-unsafe-swiftshader")


@pytest.fixture(scope="module")
def browser():
    options = webdriver.ChromeOptions()
    for flag in FLAGS:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    yield driver
    driver.quit()


@pytest.fixture(scope="module")
def scene(room):
    turn = numpy.tile([0, 0, 0, 1.0], (40, 1))
    path = numpy.stack([numpy.linspace(-2, 2, 40), numpy.sin(numpy.arange(40) / 6),
                        numpy.full(40, 0.3)], axis=1)
    points = numpy.random.default_rng(1).uniform(-1, 1, (1000, 3))
    return scene_of(room, Poses(numpy.arange(40) / 2, path, turn), points)


@pytest.fixture(scope="module")
def page(scene, tmp_path_factory):
    file = tmp_path_factory.mktemp("page") / "room.html"
    file.write_text(make_page(scene, "room"))
    return file


def wait_until(browser, script):
    WebDriverWait(browser, 60, 0.05).until(lambda b: b.execute_script("return " + script))


def resize(browser, width, height):
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
        "width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})


def open_page(browser, file, width=1280, height=800):
    resize(browser, width, height)
    browser.get(file.as_uri())
    wait_until(browser, "document.body.dataset.state")
    assert browser.find_element(By.TAG_NAME, "body").get_attribute("data-state") == "ready"
    settle(browser)


def settle(browser):
    """Until all is drawn that was asked for."""
    wait_until(browser, "!hgmmView.viewer.requested")


def text_of(browser, name):
    return browser.find_element(By.ID, name).text


def click(browser, name):
    browser.find_element(By.ID, name).click()
    settle(browser)


def press(browser, name, *keys):
    browser.find_element(By.ID, name).send_keys(*keys)
    settle(browser)


def console(browser):
    return [entry["message"] for entry in browser.get_log("browser")]


def pixel_of(browser, places):
    """Where places of the scene are on the canvas, from its corner, by the camera's matrices."""
    camera, box = browser.execute_script(
        "const c = hgmmView.viewer.camera, b = hgmmView.viewer.canvas.getBoundingClientRect();"
        "return [[...c.projectionMatrix.elements, ...c.matrixWorldInverse.elements],"
        "[b.width, b.height]]")
    project, view = (numpy.array(m).reshape(4, 4).T for m in (camera[:16], camera[16:]))
    seen = numpy.column_stack([places, numpy.ones(len(places))]) @ (project @ view).T
    return (seen[:, :2] / seen[:, 3:] * [1, -1] + 1) / 2 * box


def click_at(browser, pixel):
    canvas = browser.find_element(By.ID, "canvas")
    middle = numpy.array([canvas.size["width"], canvas.size["height"]]) // 2
    ActionChains(browser).move_to_element_with_offset(
        canvas, *(int(v) for v in numpy.rint(pixel) - middle)).click().perform()
    settle(browser)


def picked(browser):
    rows = browser.find_elements(By.CSS_SELECTOR, "#picked-list div")
    return {row.find_element(By.TAG_NAME, "dt").text: row.find_element(By.TAG_NAME, "dd").text
            for row in rows}


def test_it_opens_quietly_and_names_the_three(browser, page):
    console(browser)
    open_page(browser, page)
    assert [e.text for e in browser.find_elements(By.CSS_SELECTOR, "#legend li")] == [
        "free", "occupied", "unknown", "trajectory"]
    assert "Height [m]" in text_of(browser, "scale-title")
    for key in "csxfuipt[]jk+,.er":
        browser.find_element(By.ID, "canvas").send_keys(key)
    settle(browser)
    assert console(browser) == []


def test_a_click_on_the_slice_says_what_the_map_says(browser, page, scene, room):
    open_page(browser, page)
    click(browser, "cut")
    click(browser, "view-top")
    height = browser.execute_script("return hgmmView.viewer.slice.place_m")
    # The middle of the room, and a place behind a wall that no ray passed.
    wall = scene.low[0] + 0.03
    for place, word in (([0.5, 0.5], "free"), ([wall, 0.0], "unknown")):
        place = numpy.array([*place, height + scene.centre[2]])
        click_at(browser, pixel_of(browser, [place - scene.centre])[0])
        found, truth = picked(browser), room.occupancy([place])
        assert found["it is"] == word
        assert abs(int(found[f"P({word})"].split()[0]) / 100 - getattr(truth, word)[0]) < 0.05


def first_hit(surfaces, origin, towards):
    """The component of level 0 that a ray meets first: by solving the quadratic of each."""
    n = surfaces.first[1]
    turn = surfaces.turn[:n] / 32767
    x, y, z, w = turn.T
    axes = numpy.stack([1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
                        2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                        2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
                       axis=1).reshape(-1, 3, 3)
    scale = 2 * surfaces.deviation[:n]
    o = numpy.einsum("nkj,nk->nj", axes, origin - surfaces.mean[:n]) / scale
    d = numpy.einsum("nkj,k->nj", axes, towards) / scale
    a, b, c = (d * d).sum(1), (o * d).sum(1), (o * o).sum(1) - 1
    with numpy.errstate(invalid="ignore"):
        near = (-b - numpy.sqrt(b * b - a * c)) / a
    return numpy.nanargmin(numpy.where(near > 0, near, numpy.nan))


def test_a_click_on_a_surface_shows_its_numbers(browser, page, scene, room):
    open_page(browser, page)
    click(browser, "slice")
    mixture = room.mixture()
    places = scene.surfaces.mean[:len(mixture.support)]
    pixels = numpy.rint(pixel_of(browser, places))
    eye = numpy.array(browser.execute_script("return hgmmView.viewer.camera.position.toArray()"))
    for i in (10, len(places) // 2, len(places) - 5):
        click_at(browser, pixels[i])
        towards = places[i] - eye
        expected = first_hit(scene.surfaces, eye, towards / numpy.linalg.norm(towards))
        found = picked(browser)
        shown = int(text_of(browser, "picked-title").split()[1])
        # A pixel is not a point: a neighbour may be what is seen at its middle.
        near = numpy.linalg.norm(mixture.mean[shown] - mixture.mean[expected])
        assert near < 4 * scene.surfaces.deviation[[shown, expected], 0].max()
        x, y, z = (float(v) for v in found["mean x, y, z"].removesuffix(" m").split(","))
        numpy.testing.assert_allclose([x, y, z], mixture.mean[shown], atol=0.006)
        assert int(found["points explained"]) == round(mixture.support[shown])
        warm = room.modality("warm", mixture.mean[[shown]])
        assert abs(float(found["warm"].split()[0]) - warm.mean[0]) < 0.001


def test_sliders_and_keys_change_what_is_shown(browser, page, room):
    open_page(browser, page)
    levels = room.info()["levels"]
    press(browser, "level", Keys.ARROW_RIGHT)
    assert text_of(browser, "level-text") == f"1: {levels[1]['surface']} ellipsoids"
    used = browser.execute_script(
        "return hgmmView.viewer.surfaces.balls.reduce((sum, ball) => sum + ball.used, 0)")
    assert used == levels[1]["surface"]
    before = text_of(browser, "slice-text")
    press(browser, "slice-at", Keys.HOME)
    assert text_of(browser, "slice-text") != before
    press(browser, "time", Keys.HOME)
    assert text_of(browser, "time-text") == "0.0 of 19.5 s"
    robot = browser.execute_script("return hgmmView.viewer.trajectory.robot.position.toArray()")
    press(browser, "time", Keys.END)
    assert browser.execute_script(
        "return hgmmView.viewer.trajectory.robot.position.x") - robot[0] == pytest.approx(4)
    press(browser, "canvas", "c")
    assert "P(occupied)" in text_of(browser, "scale-title")
    eye = browser.execute_script("return hgmmView.viewer.camera.position.toArray()")
    press(browser, "canvas", Keys.ARROW_LEFT, "+")
    moved = browser.execute_script("return hgmmView.viewer.camera.position.toArray()")
    assert numpy.linalg.norm(numpy.subtract(eye, moved)) > 0.1


def test_a_drag_turns_and_picks_nothing(browser, page):
    open_page(browser, page)
    eye = browser.execute_script("return hgmmView.viewer.camera.position.toArray()")
    ActionChains(browser).move_to_element(browser.find_element(By.ID, "canvas")) \
        .click_and_hold().move_by_offset(60, 20).release().perform()
    settle(browser)
    moved = browser.execute_script("return hgmmView.viewer.camera.position.toArray()")
    assert numpy.linalg.norm(numpy.subtract(eye, moved)) > 0.1
    assert not browser.find_element(By.ID, "picked").is_displayed()


def contrast(one, other):
    """WCAG 2's contrast of two colours rgb(r, g, b)."""
    def lightness(colour):
        share = numpy.array([float(v) for v in colour[colour.index("(") + 1:-1].split(",")[:3]])
        share = share / 255
        linear = numpy.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
        return linear @ [0.2126, 0.7152, 0.0722]
    high, low = sorted((lightness(one), lightness(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("width", [390, 1280])
def test_it_fits_and_is_readable_in_dark_and_light(browser, page, width):
    open_page(browser, page, width, 800)
    assert browser.execute_script("return document.documentElement.scrollWidth") == width
    for _ in range(2):
        click(browser, "theme")
        ink, paper = browser.execute_script(
            "const s = getComputedStyle(document.body); return [s.color, s.backgroundColor]")
        assert contrast(ink, paper) > 7
    # The canvas, the legend and the first control are in sight.
    boxes = browser.execute_script(
        "return ['canvas', 'legend', 'slice'].map((id) => { const b = "
        "document.getElementById(id).getBoundingClientRect(); return [b.top, b.bottom, b.width] })")
    assert all(0 <= top < bottom <= 800 and size > 10 for top, bottom, size in boxes)


def test_twenty_thousand_ellipsoids_stay_within_their_budget(browser, scene, tmp_path):
    stream = numpy.random.default_rng(4)
    n = 20000
    turn = stream.standard_normal((n, 4))
    turn = numpy.rint(32767 * turn / numpy.linalg.norm(turn, axis=1, keepdims=True))
    many = Ellipsoids(stream.uniform(-2, 2, (n, 3)).astype(numpy.float32),
                      -numpy.sort(-stream.uniform(0.02, 0.1, (n, 3)), axis=1).astype(numpy.float32),
                      turn.astype(numpy.int16), numpy.ones(n, numpy.float32), [0, n])
    one = numpy.ones(n, numpy.float32)
    (tmp_path / "many.html").write_text(make_page(scene._replace(
        surfaces=many, free=many, occupied=one, along_ray_deviation=one, modalities={}), "many"))
    open_page(browser, tmp_path / "many.html", 390, 600)
    for keys in ("fui", "++++"):
        press(browser, "canvas", keys)
        stats = browser.execute_script("return hgmmView.viewer.stats")
        assert stats["calls"] <= 10 and 4e5 < stats["triangles"] <= 2e6
    assert console(browser) == []


@pytest.fixture(scope="module")
def report(room, tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    room.save(folder / "map.hgmm")
    metrics = example_metrics(example_map("hgmm", 0.9), example_map("octomap:0.2", 0.8))
    (folder / "metrics.json").write_text(json.dumps({**metrics, "view": {"map": "map.hgmm"}}))
    (folder / "report.html").write_text(make_report(folder))
    return folder / "report.html"


def test_the_report_fits_and_its_map_opens(browser, report):
    console(browser)
    for width in (390, 768, 1280):
        resize(browser, width, 800)
        browser.get(report.as_uri())
        assert browser.execute_script("return document.documentElement.scrollWidth") == width
    drawn = browser.execute_script(
        "return [...document.querySelectorAll('figure svg')].map((svg) => svg.getBBox().width)")
    assert len(drawn) == 6 and min(drawn) > 200
    view = browser.find_element(By.CLASS_NAME, "view")
    browser.execute_script("arguments[0].scrollIntoView()", view)
    browser.switch_to.frame(view)
    wait_until(browser, "document.body.dataset.state")
    assert browser.execute_script("return document.body.dataset.state") == "ready"
    browser.switch_to.default_content()
    assert console(browser) == []


def test_the_tests_see_errors_and_overflow(browser, tmp_path):
    (tmp_path / "bad.html").write_text(
        "<!DOCTYPE html><link rel=icon href=data:,><div style='width:700px'>x</div>"
        "<script>undefinedCall()</script>")
    console(browser)
    resize(browser, 390, 800)
    browser.get((tmp_path / "bad.html").as_uri())
    assert any("undefinedCall" in message for message in console(browser))
    assert browser.execute_script("return document.documentElement.scrollWidth") >= 700
