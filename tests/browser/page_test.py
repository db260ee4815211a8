#!/usr/bin/python3
"""page_test.py PAGE.html FOLDER - what a user does with a page of view, done in headless Chromium.

Moves the clipping plane, peels, picks a cell, draws in the histogram, changes colours and theme, follows a link, and
leaves screenshots in FOLDER. Ends with 1 and a line that says what was wrong, also when the console has errors.
"""
import json
import pathlib
import sys
import tempfile
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

FLAGS = """--headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking
    --disable-component-update --disable-sync --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader
    --window-size=980,800 --hide-scrollbars""".split()


def start(profile):
    options = Options()
    options.binary_location = "/usr/bin/chromium"
    for flag in FLAGS + [f"--user-data-dir={profile}"]:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


class Page:
    def __init__(self, browser, folder):
        self.browser = browser
        self.folder = folder

    def open(self, address):
        self.browser.get(address)
        self.wait(lambda: self.state())

    def wait(self, condition, seconds=30):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                raise AssertionError(f"waited too long: {self.text('message') or 'nothing settled'}")
            time.sleep(0.02)

    def state(self):
        """The view that was last drawn at its best, as key -> value."""
        text = self.browser.execute_script("return document.body.dataset.settled || ''")
        return dict(part.split("=", 1) for part in text.split("&")) if text else {}

    def settles_with(self, **values):
        self.wait(lambda: all(self.state().get(key) == value for key, value in values.items()))

    def find(self, selector):
        return self.browser.find_element(By.CSS_SELECTOR, selector)

    def text(self, name):
        return self.find(f"#{name}").text

    def shown(self):
        return int(self.find("#counts .total").text.split()[0].replace(",", ""))

    def slide(self, name, value):
        self.browser.execute_script("""const slider = document.getElementById(arguments[0]);
            slider.value = arguments[1]; slider.dispatchEvent(new Event('input'));""", name, value)

    def choose(self, group, value):
        self.find(f"#{group} button[value={value}]").click()

    def counts(self):
        return [float(n) for n in self.find("#histogram").get_attribute("data-counts").split(",")]

    def pixels(self):
        """How many different colours a grid of the canvas shows: a picture has many, a background few."""
        return self.browser.execute_script("""const scene = document.getElementById('scene');
            const copy = document.createElement('canvas'); copy.width = 240; copy.height = 160;
            const context = copy.getContext('2d'); context.drawImage(scene, 0, 0, 240, 160);
            const data = context.getImageData(0, 0, 240, 160).data, seen = new Set();
            for (let i = 0; i < data.length; i += 4) seen.add(data[i] << 16 | data[i + 1] << 8 | data[i + 2]);
            return seen.size""")

    def shot(self, name):
        assert self.browser.save_screenshot(str(self.folder / f"{name}.png"))


def check_opening(page):
    cells = page.shown()
    assert cells > 100, cells
    assert page.pixels() > 500, f"{page.pixels()} colours: no mesh is drawn"
    page.shot("opened")
    return cells


def check_clipping(page, cells):
    page.choose("clip-axis", "y")
    page.wait(lambda: page.state()["clip"].endswith("y:0.5"))
    half = page.shown()
    assert 0 < half < cells, half
    page.shot("clipped")
    page.slide("clip", 0.25)
    page.wait(lambda: page.state()["clip"].endswith("y:0.25"))
    assert 0 < page.shown() < half, page.shown()
    page.choose("clip-axis", "flip")
    page.wait(lambda: page.state()["clip"].endswith("y:0.75"))
    assert half < page.shown() < cells, page.shown()
    page.choose("clip-axis", "view")
    page.wait(lambda: page.state()["clip"].count(",") == 2)
    page.choose("clip-axis", "none")
    page.settles_with(clip="none")
    assert page.shown() == cells


def check_histogram(page, cells):
    assert sum(page.counts()) == cells, page.counts()
    handle = page.find("#high")
    ActionChains(page.browser).drag_and_drop_by_offset(handle, -110, 0).perform()
    page.wait(lambda: page.state()["quality"] != "-1,1")
    high = float(page.state()["quality"].split(",")[1])
    assert 0.2 < high < 0.8, high
    fewer = page.shown()
    assert 0 < fewer < cells, fewer
    assert sum(page.counts()) == cells  # the bars stay
    page.shot("bad-cells")
    page.find("#low").send_keys(Keys.ARROW_RIGHT * 5)
    page.wait(lambda: not page.state()["quality"].startswith("-1"))
    assert page.shown() <= fewer
    page.find("#reset").click()
    page.settles_with(quality="-1,1")


def check_peeling_and_kinds(page, cells):
    page.slide("peel", 1)
    page.settles_with(peel="1")
    assert 0 < page.shown() < cells
    page.slide("peel", 0)
    page.settles_with(peel="0")
    page.find("#counts button[data-kind=tet]").click()
    page.wait(lambda: "tet" not in page.state()["kinds"])
    assert 0 < page.shown() < cells
    page.shot("no-tets")
    page.find("#counts button[data-kind=tet]").click()
    page.wait(lambda: "tet" in page.state()["kinds"])


def check_picking(page):
    assert not page.find("#picked").is_displayed()
    scene = page.find("#scene")
    ActionChains(page.browser).move_to_element_with_offset(scene, 0, 0).click().perform()
    page.wait(lambda: page.find("#picked").is_displayed())
    rows = dict(row.text.split(" ", 1) for row in page.find("#picked").find_elements(By.CSS_SELECTOR, "tr"))
    assert "scaled" in rows and "vertices" in rows and len(rows["vertices"].split()) >= 4, rows
    page.shot("picked")
    ActionChains(page.browser).move_to_element_with_offset(scene, -470, 280).click().perform()
    page.wait(lambda: not page.find("#picked").is_displayed())


def check_turning(page):
    before = page.state()["camera"]
    scene = page.find("#scene")
    ActionChains(page.browser).move_to_element(scene).click_and_hold().move_by_offset(150, 40).release().perform()
    page.wait(lambda: page.state()["camera"] != before)
    turned = page.state()["camera"].split(",")
    assert turned[2:] == before.split(",")[2:], turned
    ActionChains(page.browser).scroll_by_amount(0, -300).perform()
    page.browser.execute_script("document.getElementById('scene').dispatchEvent("
                                "new WheelEvent('wheel', {deltaY: -300, cancelable: true}))")
    page.wait(lambda: float(page.state()["camera"].split(",")[2]) > float(turned[2]))


def check_colours(page):
    for colour in "quality", "kind", "region", "hexes":
        page.choose("colour", colour)
        page.settles_with(colour=colour)
        assert page.text("legend") or colour == "region"
        if colour == "kind":
            page.shot("kinds")
    page.find("#edges").click()
    page.settles_with(edges="off")
    page.find("#theme").click()
    page.settles_with(theme="dark")
    page.shot("dark")


def check_link(page, address):
    """The address that the page gives itself leads to the same view, also by a new visit."""
    link = page.browser.current_url
    assert link.startswith("file://") and "theme=dark" in link, link
    page.browser.get("about:blank")
    page.open(link)
    page.settles_with(theme="dark", edges="off")
    assert page.browser.current_url == link
    page.browser.get("about:blank")
    page.open(address + "#clip=nonsense&peel=x&colour=none&nothing")  # what is no view changes nothing
    page.settles_with(peel="0", colour="hexes")


def check_console(page):
    errors = [entry for entry in page.browser.get_log("browser") if entry["level"] == "SEVERE"]
    assert not errors, errors
    for entry in page.browser.get_log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent":
            url = message["params"]["request"]["url"]
            assert url.split(":")[0] in ("file", "about", "data", "blob", "chrome"), f"asks for {url}"


def main():
    address = pathlib.Path(sys.argv[1]).resolve().as_uri()
    folder = pathlib.Path(sys.argv[2])
    folder.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = start(profile)
        try:
            page = Page(browser, folder)
            page.open(address)
            cells = check_opening(page)
            check_clipping(page, cells)
            check_histogram(page, cells)
            check_peeling_and_kinds(page, cells)
            check_picking(page)
            check_turning(page)
            check_colours(page)
            check_link(page, address)
            check_console(page)
        finally:
            browser.quit()
    print("the page works")


main()
