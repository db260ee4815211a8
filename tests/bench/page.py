#!/usr/bin/python3
"""page.py [--cells N] [--page FILE] - how long a page of viewmesh with N cells (10^6) takes to open, in headless Chromium.

The mesh is a box of moved points, so that no two numbers are alike: hexes in the lower two thirds, six tets a cube above.
Printed are what viewmesh takes to write the page, and its size; the page's own marks, in seconds after it was asked for; processor
seconds of Chromium's processes (the renderer is the page, the GPU process draws, here without a graphics card) until the first
picture; and what one step of turning, of the clipping plane, of peeling and of the histogram's ends takes in the page's script.
Ends with 1 when the renderer takes MOST_SECONDS or more until the first picture. --page measures a page that is there.
"""
import argparse
import io
import os
import pathlib
import sys
import tarfile
import tempfile
import time

import numpy as np

import bench_meshes as meshes

sys.path.insert(0, os.path.join(meshes.ROOT, "tests", "browser"))
import chromium  # noqa: E402

MOST_SECONDS = 5.0
SLIDE = "document.getElementById('{0}').value = {1}, document.getElementById('{0}').dispatchEvent(new Event('input'))"
KEY = "document.getElementById('{0}').dispatchEvent(new KeyboardEvent('keydown', {{key: 'ArrowRight'}}))"
STEPS = {"turning": KEY.format("scene"), "clipping": SLIDE.format("clip", "0.7 - 0.02 * i"),
         "peeling": SLIDE.format("peel", "i"), "the histogram's end": KEY.format("low")}


def shuffled(mesh, rng):
    """The same cells with points and cells in any order, as no mesh generator leaves them: the worst for memory."""
    number = rng.permutation(len(mesh["points"])).astype(np.int32)
    points = np.empty_like(mesh["points"])
    points[number] = mesh["points"]
    return mesh | {"points": points} | {kind: rng.permutation(number[mesh[kind]]) for kind in ("hexes", "tets")}


def box(cells):
    n = max(3, round((cells / (2 / 3 + 6 / 3)) ** (1 / 3)))
    points, below = meshes.grid(n), 2 * n // 3
    corners, _ = meshes.cubes(n)
    hexes = corners[points[corners[:, 0], 2] < below][:, [0, 4, 6, 2, 1, 5, 7, 3]]
    _, tets = meshes.kuhn(n)
    tets = tets[points[tets][:, :, 2].min(axis=1) >= below]
    inside = ((points > 0) & (points < n)).all(axis=1)
    rng = np.random.default_rng(1)
    move = rng.uniform(-0.1, 0.1, points.shape)
    return shuffled({"points": points + np.where(inside[:, None], move, 0), "hexes": hexes, "tets": tets,
                     "triangles": np.zeros((0, 3), np.int32), "quads": np.zeros((0, 4), np.int32)}, rng)


def write_result(path, arrays):
    with tarfile.open(path, "w", format=tarfile.PAX_FORMAT) as tar:
        for name, array in arrays.items():
            buffer = io.BytesIO()
            np.save(buffer, np.ascontiguousarray(array))
            member = tarfile.TarInfo(f"result/{name}.npy")
            member.size = buffer.tell()
            buffer.seek(0)
            tar.addfile(member, buffer)


def write_page(cells, folder):
    mesh = box(cells)
    write_result(folder / "mesh.tar", mesh)
    seconds, peak = meshes.run([meshes.tool("viewmesh"), "-q", folder / "mesh.tar", "-o", folder / "page.html"])
    print(f"viewmesh: {len(mesh['hexes'])} hexes, {len(mesh['tets'])} tets, {seconds:.2f} s CPU, peak {peak / 2**20:.0f} MiB")
    return folder / "page.html"


def processor_seconds(profile):
    """Of each kind of Chromium's processes, which name the profile in their command line."""
    seconds, ticks = {}, os.sysconf("SC_CLK_TCK")
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            command = (process / "cmdline").read_text().replace("\0", " ")
            if str(profile) not in command:
                continue
            kind = command.split("--type=")[1].split()[0] if "--type=" in command else "browser"
            fields = (process / "stat").read_text().rsplit(")", 1)[1].split()
            seconds[kind] = seconds.get(kind, 0) + (int(fields[11]) + int(fields[12])) / ticks
        except (OSError, IndexError):
            continue
    return seconds


def open_page(browser, page):
    browser.get(page.resolve().as_uri())
    for _ in range(1200):
        if browser.execute_script("return document.body.dataset.settled || ''"):
            return
        time.sleep(0.1)
    raise SystemExit(f"{page}: no picture after two minutes: {browser.find_element('id', 'message').text}")


def marks(browser):
    return browser.execute_script("return performance.getEntriesByType('mark').map(m => [m.name, m.startTime / 1000])")


def step_seconds(browser, folder, step, count=10):
    """Processor time of the page for one step, JavaScript that knows its number i."""
    def go(first, last):
        browser.execute_async_script(f"""
            const step = i => ({step}), [first, last, done] = arguments;
            let number = first;
            const next = () => {{
                if (number === last) return done();
                step(number++);
                setTimeout(() => requestAnimationFrame(next), 20);
            }};
            next();""", first, last)
    go(0, 1)
    before = processor_seconds(folder)["renderer"]
    go(1, count + 1)
    return (processor_seconds(folder)["renderer"] - before) / count


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--cells", default=10**6, type=float)
    parser.add_argument("--page", type=pathlib.Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        page = options.page or write_page(options.cells, pathlib.Path(folder))
        print(f"page: {page.stat().st_size / 1e6:.1f} MB")
        browser = chromium.start(pathlib.Path(folder) / "profile")
        try:
            browser.set_script_timeout(200)
            open_page(browser, page)
            seconds = processor_seconds(folder)
            print("opened:", ", ".join(f"{name} {when:.2f}" for name, when in marks(browser)), "s after it was asked for")
            print("CPU:", ", ".join(f"{name} {of_it:.2f}" for name, of_it in seconds.items() if of_it > 0.2), "s")
            print("a step:", ", ".join(f"{name} {1000 * step_seconds(browser, folder, words):.0f}"
                                       for name, words in STEPS.items()), "ms CPU in the page")
        finally:
            browser.quit()
    sys.exit(seconds["renderer"] >= MOST_SECONDS)


main()
