#!/usr/bin/python3
"""finding_test.py PAGE.html LINES.html FOLDER - what a page of viewmesh finds, measures and lets fit, in headless Chromium.

LINES shows a part with dislocations. Ends with 1 and a line that says
what was wrong.
"""
import base64
import json
import math
import pathlib
import re
import sys
import tempfile
import zlib

import numpy as np
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

import chromium
from viewer_page import Page, difference

PINK = [236, 64, 140]


class Data:
    """What page.cpp wrote into a page."""

    def __init__(self, path):
        self.json = json.loads(re.search(r'id="data">(.*?)</script>', path.read_text())[1])
        self.quality = self.floats("quality")
        self.points = self.floats("points").reshape(3, -1).T * self.json["unit"]

    def floats(self, name):
        raw = np.frombuffer(zlib.decompress(base64.b64decode(self.json[name])), np.uint8)
        return np.ascontiguousarray(raw.reshape(4, -1).T).view("<f4").ravel()


def picked(page):
    return dict([td.text for td in row.find_elements(By.CSS_SELECTOR, "td")]
                for row in page.find("#picked").find_elements(By.CSS_SELECTOR, "tr"))


def pink_marks(page):
    """How many pixels over the mesh are of the colour that marks a cell."""
    return page.browser.execute_script("""const marks = document.getElementById('marks'), [r, g, b] = arguments[0];
        const data = marks.getContext('2d').getImageData(0, 0, marks.width, marks.height).data;
        let count = 0;
        for (let i = 0; i < data.length; i += 4) count += data[i] === r && data[i + 1] === g && data[i + 2] === b;
        return count""", PINK)


def box(page):
    """The part's box in the free part of the picture: how much of its width and height, and how far from its middle."""
    left, right, top, bottom, width, height = page.browser.execute_script("""
        const scene = document.getElementById('scene'), width = innerWidth, height = innerHeight;
        const copy = document.createElement('canvas'); copy.width = width; copy.height = height;
        const context = copy.getContext('2d'); context.drawImage(scene, 0, 0, width, height);
        const data = context.getImageData(0, 0, width, height).data, free = document.getElementById('panel').getBoundingClientRect().left;
        let left = width, right = 0, top = height, bottom = 0;
        for (let y = 0; y < height; ++y)
          for (let x = 0; x < width; ++x) {
            const at = 4 * (y * width + x), background = 4 * y * width;  // no part reaches the left edge
            if (Math.abs(data[at] - data[background]) + Math.abs(data[at + 2] - data[background + 2]) < 24) continue;
            left = Math.min(left, x), right = Math.max(right, x), top = Math.min(top, y), bottom = Math.max(bottom, y);
          }
        return [left, right, top, bottom, free, height]""")
    return {"wide": (right - left) / width, "high": (bottom - top) / height,
            "across": (left + right) / width - 1, "up": 1 - (top + bottom) / height}


def assert_fits(page, what):
    found = box(page)
    assert 0.86 < max(found["wide"], found["high"]) < 0.94, f"{what} does not fill the picture: {found}"
    assert abs(found["across"]) < 0.05 and abs(found["up"]) < 0.05, f"{what} is not in the middle: {found}"


def check_fitting(page):
    assert page.state()["camera"].count(",") == 1, page.state()
    assert_fits(page, "the part")
    page.choose("clip-axis", "y")
    page.wait(lambda: page.state()["clip"].endswith("y:0.5"))
    assert_fits(page, "the clipped part")
    # Who zooms keeps the place, whatever is shown; "Fit" fits again.
    page.browser.execute_script("document.getElementById('scene').dispatchEvent("
                                "new WheelEvent('wheel', {deltaY: -300, cancelable: true}))")
    page.wait(lambda: page.state()["camera"].count(",") == 5)
    zoomed = page.state()["camera"]
    page.choose("clip-axis", "none")
    page.settles_with(clip="none")
    assert page.state()["camera"] == zoomed, page.state()
    page.find("#fit").click()
    page.wait(lambda: page.state()["camera"].count(",") == 1)
    assert_fits(page, "the part after a click on Fit")


def check_up(page):
    before = page.picture()
    for up in "y", "-x":
        page.browser.execute_script("location.hash = 'up=' + arguments[0]", up)
        page.settles_with(up=up)
        assert_fits(page, f"the part with {up} up")
        assert difference(page.picture(), before) > 1, up
        before = page.picture()
    page.shot("up-is-minus-x")
    page.find("#reset").click()
    page.settles_with(up="z")


def check_poor_cells(page, data):
    """From the poorest to the next poorest and back; each is seen, marked and told."""
    found = []
    for number in range(1, 6):
        page.choose("poor", "'1'")
        page.wait(lambda: page.text("poor-place").startswith(f"{number} of "))
        page.wait(lambda: page.state()["clip"] != "none" and pink_marks(page) > 20)
        found.append(float(picked(page)["scaled Jacobian"]))
    assert page.text("poor-place") == f"5 of {len(data.quality):,}", page.text("poor-place")
    assert np.allclose(found, np.sort(data.quality)[:5], atol=6e-5), (found, np.sort(data.quality)[:5])
    page.shot("poor-cell")
    page.choose("poor", "'-1'")
    page.wait(lambda: page.text("poor-place").startswith("4 of "))
    assert float(picked(page)["scaled Jacobian"]) == found[3]
    # By another measure others are poor.
    page.choose("measures", "orthogonality")
    page.settles_with(colour="orthogonality")
    worst = float(picked(page)["non-orthogonality"].rstrip("°"))
    page.choose("poor", "'-1'")
    page.wait(lambda: float(picked(page)["non-orthogonality"].rstrip("°")) >= worst)
    # Among hexes alone.
    page.browser.execute_script("location.hash = 'kinds=hex&colour=hexes'")
    page.settles_with(kinds="hex", colour="hexes")
    page.choose("poor", "'1'")
    page.wait(lambda: page.text("poor-place").endswith(f" of {data.json['kindBegin'][1]:,}"))
    assert "hex" in picked(page), picked(page)
    page.find("#reset").click()
    page.settles_with(kinds="hex,prism,pyramid,tet", clip="none")


def check_measuring(page, data):
    page.find("#measure").click()
    page.wait(lambda: page.text("measure-hint") == "Click a vertex.")
    page.click_at(-0.1, 0)
    page.wait(lambda: page.text("measure-hint") == "Click another one.")
    page.click_at(0.15, 0.1)
    page.wait(lambda: page.browser.execute_script("return document.body.dataset.measured"))
    a, b, length = page.browser.execute_script("return document.body.dataset.measured").split()
    way = data.points[int(b)] - data.points[int(a)]
    assert abs(np.linalg.norm(way) - float(length)) < 1e-4 * float(length), (a, b, length, way)
    words = page.text("measured")
    shown = float(re.search(r"distance ([0-9.,]+)", words)[1].replace(",", ""))
    assert abs(shown - float(length)) < 1e-3 * float(length), (words, length)
    page.shot("measured")
    page.find("#scene").send_keys(Keys.ESCAPE)
    page.wait(lambda: not page.find("#measured").is_displayed())


def check_marks(page):
    drawn = """const marks = document.getElementById('marks');
        return marks.getContext('2d').getImageData(0, 0, marks.width, marks.height).data.some(value => value > 0)"""
    assert page.browser.execute_script(drawn), "no axes"
    page.find("#axes").click()
    page.settles_with(axes="off")
    assert not page.browser.execute_script(drawn), "axes are still there"
    page.find("#axes").click()
    page.settles_with(axes="on")


def check_dislocations(page, data):
    lines = data.json["dislocations"]
    assert page.find("#lines").is_displayed() and lines
    before = page.picture()
    page.find("#dislocations").click()
    page.settles_with(dislocations="on")
    assert difference(page.picture(), before) > 0.02, "no dislocations are drawn"
    page.shot("dislocations")
    page.choose("lines", "'1'")
    page.wait(lambda: page.text("lines-place").startswith("1 of "))
    page.wait(lambda: page.state()["camera"].count(",") == 5)
    length = float(page.text("lines-place").split(" · ")[1].replace(",", ""))
    assert 0 < length < math.dist(data.points.min(axis=0), data.points.max(axis=0)) * 3, length
    page.shot("dislocation-found")
    page.choose("lines", "'-1'")
    count = page.text("lines-place").split()[2]
    page.wait(lambda: page.text("lines-place").startswith(f"{count} of {count}"))


def main():
    whole, lines, folder = (pathlib.Path(name).resolve() for name in sys.argv[1:4])
    folder.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = chromium.start(profile, window="700,560")
        try:
            page, data = Page(browser, folder), Data(whole)
            page.open(whole.as_uri())
            assert not page.find("#lines").is_displayed() and not page.find("#dislocations").is_displayed()
            assert browser.title == whole.with_suffix(".msh").name, browser.title
            check_fitting(page)
            check_up(page)
            check_marks(page)
            check_measuring(page, data)
            check_poor_cells(page, data)
            browser.get("about:blank")
            page.open(lines.as_uri())
            check_dislocations(page, Data(lines))
            errors = [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
            assert not errors, errors
        finally:
            browser.quit()
    print("the page finds, measures and fits")


main()
