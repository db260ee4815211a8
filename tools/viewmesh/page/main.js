import "./licences.js";
import {cameraOf, controlCamera, rayThrough} from "./camera.js";
import {painter, picked as pickedColour} from "./colours.js";
import {decodeScene} from "./decode.js";
import {Panel} from "./panel.js";
import {Renderer} from "./renderer.js";
import {Skin, triangleHit} from "./skin.js";
import {applyText, toText} from "./state.js";

const canvas = document.getElementById("scene"), message = document.getElementById("message");
// Pixels drawn for one of the screen when nothing moves, and how long after the last change, in milliseconds.
const stillScale = 2, settleTime = 160;

class Viewer {
  constructor(scene) {
    this.scene = scene;
    this.state = applyText({}, scene.state, scene.groups);
    applyText(this.state, location.hash.slice(1), this.scene.groups);
    this.picked = -1;
    this.skin = new Skin(scene);
    this.renderer = new Renderer(canvas, scene.reach);
    this.panel = new Panel(scene, this.state, {
      changed: () => this.changed(),
      viewDirection: () => this.camera().towards.map(n => Number(n.toPrecision(4))),
      reset: () => {
        applyText(this.state, scene.state, scene.groups);
        this.changed();
      },
      link: () => this.copyLink(),
      png: () => this.savePicture(),
    });
    controlCamera(canvas, this.state, () => this.redraw(), (x, y) => this.pick(x, y));
    addEventListener("resize", () => this.redraw());
    addEventListener("hashchange", () => {
      applyText(this.state, location.hash.slice(1), this.scene.groups);
      this.changed();
    });
    this.changed();
  }

  camera() {
    return cameraOf(this.state, canvas.clientWidth / canvas.clientHeight);
  }

  // Other cells or colours.
  changed() {
    this.skinIsOld = true;
    this.redraw();
  }

  redraw() {
    clearTimeout(this.settling);
    this.settling = setTimeout(() => this.settle(), settleTime);
    this.frame ??= requestAnimationFrame(() => {
      this.frame = undefined;
      this.draw(devicePixelRatio);
    });
  }

  draw(scale) {
    if (this.skinIsOld) {
      const colourOf = painter(this.scene, this.state.colour);
      this.triangles = this.skin.triangles(this.state, (cell, surface) =>
        cell === this.picked ? pickedColour : colourOf(cell, surface));
      this.renderer.setSkin(this.triangles);
      this.panel.show(this.triangles.counts);
      this.skinIsOld = false;
    }
    this.renderer.draw(this.state, scale);
  }

  // The best picture, and the link that leads back to it.
  settle() {
    this.draw(stillScale * devicePixelRatio);
    history.replaceState(null, "", `#${toText(this.state)}`);
    document.body.dataset.settled = toText(this.state);
  }

  pick(x, y) {
    const {left, top, width, height} = canvas.getBoundingClientRect(), camera = this.camera();
    const ray = rayThrough(camera, 2 * (x - left) / width - 1, 1 - 2 * (y - top) / height);
    const {cell, surface} = triangleHit(this.triangles, camera.eye, ray);
    this.picked = cell;
    this.panel.showCell(cell, surface);
    this.changed();
  }

  async copyLink() {
    this.settle();
    const button = document.getElementById("link");
    try {
      await navigator.clipboard.writeText(location.href);
      button.textContent = "Copied";
    } catch {
      prompt("The link to this view:", location.href);
    }
    setTimeout(() => { button.textContent = "Link"; }, 1500);
  }

  savePicture() {
    this.draw(stillScale * devicePixelRatio);
    canvas.toBlob(blob => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(blob);
      link.download = `${this.scene.title.replace(/[^\w.-]+/g, "-")}.png`;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    });
  }
}

// The marks are for tests/bench/page.py, and for whoever opens the browser's tools.
async function start() {
  const text = document.getElementById("data");
  const data = JSON.parse(text.textContent);
  text.remove();
  performance.mark("parsed");
  const scene = await decodeScene(data);
  performance.mark("decoded");
  new Viewer(scene);
  performance.mark("prepared");
  requestAnimationFrame(() => performance.mark("drawn"));
  message.textContent = "";
}

start().catch(error => {
  message.textContent = `The mesh cannot be shown: ${error.message}`;
  throw error;
});
