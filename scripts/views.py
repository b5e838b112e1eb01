#!/usr/bin/env python3
"""Makes pages of maps and looks at them in headless Chromium, without a GPU.

    PYTHONPATH=build/python /usr/bin/python3 scripts/views.py kitchen.hgmm livox.hgmm -o views

For each map: the page, screenshots at 390 and 1280 px, frames a second, what a frame takes, and
a screenshot of a slice with marked points. truth.txt says what the map calls these: a reader
of the screenshots alone should say the same.
"""
import argparse
import pathlib

import numpy
from matplotlib import image
from matplotlib.figure import Figure
from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.support.ui import WebDriverWait

from hgmm import Map
from hgmm.view import make_page, scene_of

FLAGS = ("--headless=new", "--no-sandbox", "--hide-scrollbars", "--use-gl=angle",
         "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
WORDS = ("occupied", "free", "unknown")
MARKS = 5
MARGIN = 4
"""pixels around a mark that are the same"""


def browser():
    options = webdriver.ChromeOptions()
    for flag in FLAGS:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    driver.set_script_timeout(600)
    # Time of the thread, not of the clock: other programs do not count.
    driver.execute_cdp_cmd("Performance.enable", {"timeDomain": "threadTicks"})
    return driver


def open_page(driver, page, width, height=800):
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
        "width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})
    driver.get(page.resolve().as_uri())
    WebDriverWait(driver, 300).until(
        lambda d: d.execute_script("return document.body.dataset.state") == "ready")


def settle(driver):
    WebDriverWait(driver, 300).until(
        lambda d: d.execute_script("return !hgmmView.viewer.requested"))


def script_seconds(driver):
    """Processor time of the page's scripts so far."""
    metrics = driver.execute_cdp_cmd("Performance.getMetrics", {})["metrics"]
    return next(m["value"] for m in metrics if m["name"] == "ScriptDuration")


def click(driver, *names):
    for name in names:
        driver.find_element("id", name).click()
        settle(driver)


def places_of_pixels(driver, map_, centre):
    """The pixels of the canvas that show the slice, and the places there in the map."""
    height, camera, box = driver.execute_script(
        "const v = hgmmView.viewer, b = v.canvas.getBoundingClientRect();"
        "const m = new THREE.Matrix4().getInverse(new THREE.Matrix4().multiplyMatrices("
        "v.camera.projectionMatrix, v.camera.matrixWorldInverse));"
        "return [v.slice.place_m, m.elements, [b.left, b.top, b.width, b.height]]")
    axis = "xyz".index(driver.execute_script("return hgmmView.viewer.slice.axis"))
    back = numpy.array(camera).reshape(4, 4).T
    pixels = numpy.stack(numpy.meshgrid(numpy.arange(15, box[2] - 15, 4),
                                        numpy.arange(15, box[3] - 120, 4)), -1).reshape(-1, 2)
    clip = pixels / box[2:] * [2, -2] - [1, -1]
    ends = [numpy.column_stack([clip, numpy.full(len(clip), z), numpy.ones(len(clip))]) @ back.T
            for z in (-1, 1)]
    near, far = (end[:, :3] / end[:, 3:] for end in ends)
    share = (height - near[:, axis]) / (far[:, axis] - near[:, axis])
    return pixels + box[:2], near + share[:, None] * (far - near) + centre


def chosen_marks(pixels, words, stream):
    """Numbers of pixels, some of each word, apart from another and from other words."""
    marks = []
    for turn in range(MARKS):
        word = turn % len(WORDS)
        for i in stream.permutation(numpy.flatnonzero(words == word)):
            apart = [numpy.abs(pixels[i] - pixels[j]).max() for j in marks]
            around = words[numpy.abs(pixels - pixels[i]).max(axis=1) <= MARGIN]
            if min(apart, default=999) > 60 and (around == word).all():
                marks.append(i)
                break
    return stream.permutation(marks)


def mark(file, pixels, first):
    """Draws numbered circles into a screenshot."""
    picture = image.imread(file)
    figure = Figure(figsize=(picture.shape[1] / 100, picture.shape[0] / 100))
    axes = figure.add_axes([0, 0, 1, 1])
    axes.imshow(picture)
    axes.set_axis_off()
    for number, (x, y) in enumerate(pixels, first):
        axes.plot(x, y, "o", markersize=11, markerfacecolor="none", markeredgecolor="black")
        axes.plot(x, y, "o", markersize=9, markerfacecolor="none", markeredgecolor="white")
        axes.annotate(str(number), (x, y), (9, 9), textcoords="offset points", color="white",
                      fontsize=11, weight="bold", bbox={"facecolor": "black", "pad": 1.5})
    figure.savefig(file, dpi=100)


def marked_slice(driver, map_, centre, file, first, stream):
    """A screenshot of the slice from above with marks, and a line of truth for each."""
    click(driver, "cut", "surfaces", "view-top")
    driver.save_screenshot(str(file))
    pixels, places = places_of_pixels(driver, map_, centre)
    low, high = (numpy.array(v) for v in driver.execute_script(
        "const f = hgmmView.facts, l = f.lattice;"
        "return [l.low, l.low.map((v, k) => v + l.cell[k] * l.counts[k])]"))
    inside = ((places - centre > low + 1e-6) & (places - centre < high - 1e-6))
    axis = "xyz".index(driver.execute_script("return hgmmView.viewer.slice.axis"))
    inside[:, axis] = True
    pixels, places = pixels[inside.all(axis=1)], places[inside.all(axis=1)]
    answers = numpy.stack(map_.occupancy(places)[:3], axis=1)
    words = answers.argmax(axis=1)
    marks = chosen_marks(pixels, words, stream)
    mark(file, pixels[marks], first)
    return [f"{file.name} {number}: {WORDS[words[i]]} {answers[i].max():.2f}"
            for number, i in enumerate(marks, first)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("maps", nargs="+", type=pathlib.Path, metavar="MAP.hgmm")
    parser.add_argument("-o", "--output", type=pathlib.Path, default="views", metavar="FOLDER")
    parser.add_argument("--frames", type=int, default=30, help="to measure")
    asked = parser.parse_args()
    asked.output.mkdir(parents=True, exist_ok=True)
    driver, stream, truth = browser(), numpy.random.default_rng(7), []
    for file in asked.maps:
        map_ = Map.load(file)
        scene = scene_of(map_)
        page = asked.output / (file.stem + ".html")
        page.write_text(make_page(scene, file.stem), encoding="utf-8")
        for width in (390, 1280):
            open_page(driver, page, width)
            settle(driver)
            driver.save_screenshot(str(asked.output / f"{file.stem}-{width}.png"))
        before = script_seconds(driver)
        told = driver.execute_async_script(
            "hgmmView.viewer.measure(arguments[0]).then(arguments[1])", asked.frames)
        script_ms = 1000 * (script_seconds(driver) - before) / asked.frames
        print(f"{file.stem}: {page.stat().st_size / 1e6:.2f} MB, "
              f"{told['framesPerSecond']:.1f} frames/s by software, script {script_ms:.1f} ms a "
              f"frame, {told['calls']} draw calls, {told['triangles']} triangles")
        truth += marked_slice(driver, map_, scene.centre, asked.output / f"{file.stem}-marks.png",
                              len(truth) + 1, stream)
        for entry in driver.get_log("browser"):
            print(f"{file.stem}: console: {entry['message']}")
    (asked.output / "truth.txt").write_text("\n".join(truth) + "\n")
    driver.quit()


if __name__ == "__main__":
    main()
