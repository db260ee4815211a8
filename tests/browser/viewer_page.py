"""A page of viewmesh in a browser, as a user sees it and works with it."""
import time

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By


class Page:
    def __init__(self, browser, folder):
        self.browser = browser
        self.folder = folder

    def open(self, address):
        self.browser.get(address)
        self.wait(lambda: self.state())

    def wait(self, condition, seconds=120):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                raise AssertionError(f"waited too long: {self.text('message') or 'nothing settled'}")
            time.sleep(0.1)  # each question wakes the driver and the browser

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

    def picture(self):
        """Red, green and blue of a coarse grid of the canvas."""
        return self.browser.execute_script("""const scene = document.getElementById('scene');
            const copy = document.createElement('canvas'); copy.width = 60; copy.height = 40;
            const context = copy.getContext('2d'); context.drawImage(scene, 0, 0, 60, 40);
            return [...context.getImageData(0, 0, 60, 40).data].filter((_, i) => i % 4 !== 3)""")

    def colours_of(self, colour):
        """How many places of a grid of the canvas have this hue, however bright."""
        return self.browser.execute_script("""const scene = document.getElementById('scene'), [r, g, b] = arguments[0];
            const copy = document.createElement('canvas'); copy.width = 480; copy.height = 320;
            const context = copy.getContext('2d'); context.drawImage(scene, 0, 0, 480, 320);
            const data = context.getImageData(0, 0, 480, 320).data;
            let count = 0;
            for (let i = 0; i < data.length; i += 4) {
              const part = data[i] / r;
              if (part > 0.3 && Math.abs(data[i + 1] - part * g) < 30 && Math.abs(data[i + 2] - part * b) < 30) ++count;
            }
            return count""", colour)

    def free(self):
        """Width and height of what the panel leaves free, at the left, and the height and width of all, in pixels."""
        return self.browser.execute_script("""return [document.getElementById('panel').getBoundingClientRect().left, innerHeight,
            innerWidth]""")

    def click_at(self, x, y):
        """A place of the free part, from -1 to 1 to the right and up."""
        right, height, width = self.free()
        across = (x + 1) / 2 * right - width / 2
        ActionChains(self.browser).move_to_element_with_offset(self.find("#scene"), round(across), round(-y * height / 2)).click().perform()

    def shot(self, name):
        assert self.browser.save_screenshot(str(self.folder / f"{name}.png"))


def difference(one, other):
    """On average, of 255."""
    return sum(abs(a - b) for a, b in zip(one, other)) / len(one)
