#!/usr/bin/python3
"""page_test.py PAGE.html FOLDER CANDIDATES.cand CHOICE.html... - what a user does with a page, in headless Chromium.

Moves the clipping plane along every axis, peels, filters, picks a cell, draws in the histogram, changes colours and theme,
reads the history, copies a link and follows it, downloads a picture, and leaves screenshots in FOLDER. Ends with 1 and a
line that says what was wrong, also when the console has errors or the page asks the network for something.
Pages of candidates or of a solution give cells the numbers that they have in the .cand file.
"""
import json
import pathlib
import sys
import tempfile

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

import chromium
from viewer_page import Page, difference


# A line each what --view refuses, as viewmesh.bats checks.
WRONG_VIEWS = (pathlib.Path(__file__).parent.parent / "data" / "wrong_views.txt").read_text().splitlines()


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
    for axis in "x", "z":
        page.choose("clip-axis", axis)
        page.wait(lambda: page.state()["clip"].endswith(f"{axis}:0.75"))
        assert 0 < page.shown() < cells, page.shown()
        page.shot(f"clipped-{axis}")
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
    without = 0
    for kind in "hex", "prism", "pyramid", "tet":
        button = page.find(f"#counts button[data-kind={kind}]")
        button.click()
        page.wait(lambda: kind not in page.state()["kinds"])
        without += cells - page.shown()
        page.shot(f"no-{kind}")
        button.click()
        page.wait(lambda: kind in page.state()["kinds"])
    assert without == cells, without


def pick(page):
    """What the page says of the cell in the middle of what the panel leaves free."""
    assert not page.find("#picked").is_displayed()
    page.click_at(0, 0)
    page.wait(lambda: page.find("#picked").is_displayed())
    return dict([td.text for td in row.find_elements(By.CSS_SELECTOR, "td")]
                for row in page.find("#picked").find_elements(By.CSS_SELECTOR, "tr"))


def check_numbers(page, address, candidates):
    page.open(address + "#kinds=hex,prism,pyramid")
    rows = pick(page)
    number = next(iter(rows.values()))
    kind, *fields = candidates[int(number.removeprefix("number "))].split()
    corners = {"hex": 8, "prism": 6, "pyramid": 5}[kind]
    assert [int(v) - 1 for v in fields[4:4 + corners]] == [int(v) for v in rows["vertices"].split()], rows


def check_picking(page):
    rows = pick(page)
    kind, corners = next(iter(rows)), len(rows["vertices"].split())
    assert {"hex": 8, "prism": 6, "pyramid": 5, "tet": 4}[kind] == corners, rows
    assert 0 < float(rows["scaled Jacobian"]) <= 1 and rows["layer"] == "1" and len(rows["middle"].split(",")) == 3, rows
    assert page.colours_of([236, 64, 140]) > 0, "the picked cell is not marked"
    page.shot("picked")
    page.click_at(-0.99, -0.95)
    page.wait(lambda: not page.find("#picked").is_displayed())


def check_turning(page):
    before = page.state()["camera"]
    scene = page.find("#scene")
    ActionChains(page.browser).move_to_element(scene).click_and_hold().move_by_offset(150, 40).release().perform()
    page.wait(lambda: page.state()["camera"] != before)
    turned = page.state()["camera"].split(",")
    assert before.count(",") == 1 and len(turned) == 6, (before, turned)  # what was turned need not fit any more
    ActionChains(page.browser).scroll_by_amount(0, -300).perform()
    page.browser.execute_script("document.getElementById('scene').dispatchEvent("
                                "new WheelEvent('wheel', {deltaY: -300, cancelable: true}))")
    page.wait(lambda: float(page.state()["camera"].split(",")[2]) > float(turned[2]))


def check_colours(page):
    before = [0] * 3 * 60 * 40
    for colour in "quality", "kind", "surface", "region", "hexes":
        page.choose("colour", colour)
        page.settles_with(colour=colour)
        assert page.text("legend")
        picture = page.picture()
        assert difference(picture, before) > 1, f"{colour} looks like the one before"
        before = picture
        page.shot(f"by-{colour}")
    for measure in "orthogonality", "weight", "determinant", "flatness":
        page.choose("measures", measure)
        page.settles_with(colour=measure)
        picture = page.picture()
        assert difference(picture, before) > 0.5, f"{measure} looks like the one before"
        before = picture
    page.shot("by-flatness")
    page.choose("colour", "hexes")
    page.find("#edges").click()
    page.settles_with(edges="off")
    page.find("#theme").click()
    page.settles_with(theme="dark")
    page.shot("dark")


def check_groups(page):
    """The legend of surfaces hides one, shows one alone, and shows all again."""
    page.choose("colour", "surface")
    page.settles_with(colour="surface", hidden="none")
    groups = page.browser.find_elements(By.CSS_SELECTOR, "#legend .group")
    assert len(groups) > 1, page.text("legend")
    whole, count, tag = page.picture(), len(groups), groups[0].get_attribute("value")
    groups[0].click()
    page.settles_with(hidden=f"surface:{tag}")
    assert difference(page.picture(), whole) > 0.1, "the surface is still there"
    page.shot("surface-hidden")
    last = page.browser.find_elements(By.CSS_SELECTOR, "#legend .group")[-1]
    ActionChains(page.browser).key_down(Keys.SHIFT).click(last).key_up(Keys.SHIFT).perform()
    page.wait(lambda: page.state()["hidden"].count("surface:") == count - 1)
    page.find("#legend .all").click()
    page.settles_with(hidden="none")
    page.choose("colour", "hexes")
    page.settles_with(colour="hexes")


HISTORY = {
    "tetmesh": ("tets", "--size"), "findhex": ("hexes", "--min-quality"), "buildgraph": ("vertices", "edges"),
    "initsol": ("seed", "weight", "--iterations"), "certify": ("weight", "bound", "gap"), "assemble": ("hex: count", "--smooth"),
}


def check_history(page):
    page.find("#history summary").click()
    entries = {entry.find_element(By.CSS_SELECTOR, "b").text: entry.text
               for entry in page.find("#history").find_elements(By.CSS_SELECTOR, "li")}
    for tool, words in HISTORY.items():
        for word in words:
            assert word in entries[tool], f"{tool} without {word}: {entries.get(tool)}"
    page.browser.execute_script("document.getElementById('history').scrollIntoView()")
    page.shot("history")
    page.find("#history summary").click()


def check_png(page, downloads):
    """The button leaves the picture that the canvas shows, named after the page."""
    page.find("#png").click()
    target = downloads / "hexpipe-result.png"
    page.wait(lambda: target.exists() and not list(downloads.glob("*.crdownload")))
    data = target.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n" and len(data) > 20000, len(data)
    size = [int.from_bytes(data[at:at + 4], "big") for at in (16, 20)]
    canvas = page.find("#scene")
    assert size == [int(canvas.get_attribute(name)) for name in ("width", "height")] and size[0] > 1000, size
    page.browser.execute_script("location.hash = 'legend=off'")
    page.settles_with(legend="off")
    page.find("#png").click()
    without = downloads / "hexpipe-result (1).png"
    page.wait(lambda: without.exists() and not list(downloads.glob("*.crdownload")))
    assert without.read_bytes() != data, "the picture has no legend"


def check_link(page, address):
    """The button copies the address that leads to the same view, also by a new visit."""
    page.browser.execute_cdp_cmd("Browser.grantPermissions", {"permissions": ["clipboardReadWrite", "clipboardSanitizedWrite"]})
    page.find("#link").click()
    page.wait(lambda: page.text("link") == "Copied")
    link = page.browser.execute_async_script("navigator.clipboard.readText().then(arguments[0])")
    assert link == page.browser.current_url, link
    before = page.picture()
    assert link.startswith("file://") and "theme=dark" in link, link
    page.browser.get("about:blank")
    page.open(link)
    page.settles_with(theme="dark", edges="off")
    assert page.browser.current_url == link
    assert difference(page.picture(), before) < 1, "the link shows another picture"
    page.browser.get("about:blank")
    page.open(address)
    before = page.state()
    page.browser.get("about:blank")
    page.open(address + "#" + "&".join(WRONG_VIEWS))  # what is no view changes nothing
    assert page.state() == before, page.state()
    page.browser.get("about:blank")
    page.open(address + "#camera=1e1,-90,.5,0,0,0&clip=-x:0.25&quality=-1,0.5&peel=1.5&kinds=none&fragment=0&color=kind")
    page.settles_with(camera="10,-90,0.5,0,0,0", clip="-x:0.25", quality="-1,0.5", peel="1", kinds="none", colour="kind")


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
    candidates = pathlib.Path(sys.argv[3]).read_text().splitlines()
    folder.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        downloads = pathlib.Path(profile) / "downloads"
        browser = chromium.start(profile, downloads, window="700,560")
        try:
            page = Page(browser, folder)
            page.open(address)
            cells = check_opening(page)
            check_clipping(page, cells)
            check_histogram(page, cells)
            check_peeling_and_kinds(page, cells)
            check_picking(page)
            check_turning(page)
            check_groups(page)
            check_colours(page)
            check_history(page)
            check_png(page, downloads)
            check_link(page, address)
            for choice in sys.argv[4:]:
                check_numbers(page, pathlib.Path(choice).resolve().as_uri(), candidates)
            check_console(page)
        finally:
            browser.quit()
    print("the page works")


main()
