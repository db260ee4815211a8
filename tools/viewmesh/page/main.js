import "./licences.js";
import {cameraOf, fitCamera, rayThrough} from "./camera.js";
import {showCell} from "./cell_table.js";
import {painter, picked as pickedColour} from "./colours.js";
import {decodeScene} from "./decode.js";
import {byId} from "./dom.js";
import {Finder} from "./find.js";
import {drawMarks} from "./marks.js";
import {Measure} from "./measure.js";
import {Panel} from "./panel.js";
import {drawLegend, savePicture} from "./picture.js";
import {controlCamera} from "./pointer.js";
import {Renderer} from "./renderer.js";
import {Skin, triangleHit} from "./skin.js";
import {applyText, toText} from "./state.js";

const canvas = byId("scene"), overlay = byId("marks");
// Pixels drawn for one of the screen when nothing moves, and how long after the last change, in milliseconds.
const stillScale = 2, settleTime = 160;
// Of what the panel leaves free, this much stays free around a part that fits.
const border = 0.05;
const em = 12;  // of what is drawn over the mesh

// What decides which cells are shown, and from where a part is to fit.
const shownBy = ({clip, quality, peel, kinds, hidden, fragment, up}) =>
  JSON.stringify([clip, quality, peel, kinds, hidden, fragment, up]);

class Viewer {
  constructor(scene) {
    this.scene = scene;
    this.state = applyText({}, scene.state, scene.groups);
    applyText(this.state, location.hash.slice(1), this.scene.groups);
    this.picked = -1;
    this.skin = new Skin(scene);
    this.renderer = new Renderer(canvas, scene.reach);
    this.measure = new Measure(scene);
    this.panel = new Panel(scene, this.state, {
      changed: () => this.changed(),
      viewDirection: () => this.camera().towards.map(n => Number(n.toPrecision(4))),
      fit: () => this.fit(),
      reset: () => this.apply(scene.state),
      link: () => this.copyLink(),
      png: () => this.save(),
    });
    this.finder = new Finder({
      scene, state: this.state, skin: this.skin, aspect: () => this.aspect(), frame: () => this.frame(),
      camera: () => this.camera(), pick: cell => this.pick(cell, -1),
    });
    this.connect();
    this.changed();
  }

  connect() {
    controlCamera(canvas, this.state, () => this.redraw(), (x, y) => this.click(x, y));
    canvas.addEventListener("dblclick", () => this.measure.isOn || this.fit());
    canvas.addEventListener("keydown", ({key}) => {
      if (key === "f") this.fit();
      if (key === "m" || (key === "Escape" && this.measure.isOn)) this.toggleMeasure();
    });
    byId("measure").addEventListener("click", () => this.toggleMeasure());
    addEventListener("resize", () => this.changed());
    addEventListener("hashchange", () => this.apply(location.hash.slice(1)));
  }

  apply(text) {
    applyText(this.state, text, this.scene.groups);
    this.changed();
  }

  aspect() {
    return canvas.clientWidth / canvas.clientHeight;
  }

  camera() {
    return cameraOf(this.state, this.aspect());
  }

  // What the panel leaves free, in pixels: beside it, or on a narrow screen above it.
  free() {
    const panel = byId("panel").getBoundingClientRect(), {clientWidth, clientHeight} = canvas;
    if (byId("panel").classList.contains("folded")) return {right: clientWidth, bottom: clientHeight};
    const isBelow = panel.width > clientWidth / 2;
    return {right: isBelow ? clientWidth : panel.left, bottom: isBelow ? panel.top : clientHeight};
  }

  // Where a part is to fit, as a part of the picture from -1 to 1.
  frame() {
    const {right, bottom} = this.free();
    const across = border * 2 * right / canvas.clientWidth, up = border * 2 * bottom / canvas.clientHeight;
    return {
      left: -1 + across, right: 2 * right / canvas.clientWidth - 1 - across,
      top: 1 - up, bottom: 1 - 2 * bottom / canvas.clientHeight + up,
    };
  }

  fit() {
    this.state.fitted = this.state.follows = true;
    this.changed();
  }

  // Other cells, colours, or another size.
  changed() {
    this.skinIsOld = true;
    this.redraw();
  }

  redraw() {
    clearTimeout(this.settling);
    this.settling = setTimeout(() => this.settle(), settleTime);
    this.frameRequest ??= requestAnimationFrame(() => {
      this.frameRequest = undefined;
      this.draw(devicePixelRatio);
    });
  }

  draw(scale) {
    if (this.skinIsOld) this.renew();
    const {state} = this, beyond = state.clip ? this.skin.planeOf(state.clip) : 1;
    this.renderer.draw(this.camera(), state, scale, beyond);
    this.drawOverlay();
  }

  drawOverlay() {
    const width = Math.round(canvas.clientWidth * devicePixelRatio), height = Math.round(canvas.clientHeight * devicePixelRatio);
    const context = overlay.getContext("2d");
    if (overlay.width !== width || overlay.height !== height) overlay.width = width, overlay.height = height;
    else context.clearRect(0, 0, width, height);
    this.drawMarks(context, devicePixelRatio, this.free().bottom);
  }

  renew() {
    const {state} = this, colourOf = painter(this.scene, state.colour), shown = shownBy(state);
    this.triangles = this.skin.triangles(state, (cell, surface) =>
      cell === this.picked ? pickedColour : colourOf(cell, surface));
    this.renderer.setSkin(this.triangles);
    this.renderer.setLines(state.dislocations ? this.scene.dislocations : [], this.finder.line);
    this.panel.show(this.triangles.counts);
    if (state.follows && shown !== this.shownBefore) state.fitted = true;
    if (state.fitted) fitCamera(state, this.triangles.position, this.aspect(), this.frame());
    this.shownBefore = shown;
    this.skinIsOld = false;
  }

  drawMarks(context, scale, bottom) {
    const {scene, state, measure} = this, found = this.picked === this.finder.cell ? this.picked : -1;
    const {clientWidth, clientHeight} = canvas;
    drawMarks(context, {camera: this.camera(), state, scene, measure, found},
      {width: clientWidth * scale, height: clientHeight * scale, bottom: bottom * scale, em: em * scale});
  }

  // The best picture, and the link that leads back to it.
  settle() {
    this.draw(stillScale * devicePixelRatio);
    history.replaceState(null, "", `#${toText(this.state)}`);
    document.body.dataset.settled = toText(this.state);
  }

  click(pageX, pageY) {
    const {left, top, width, height} = canvas.getBoundingClientRect(), camera = this.camera();
    const x = 2 * (pageX - left) / width - 1, y = 1 - 2 * (pageY - top) / height;
    const hit = triangleHit(this.triangles, camera.eye, rayThrough(camera, x, y));
    if (this.measure.isOn) {
      this.measure.click(hit, camera, x, y);
      this.redraw();
    } else this.pick(hit.cell, hit.surface);
  }

  pick(cell, surface) {
    this.picked = cell;
    showCell(this.scene, cell, surface);
    this.changed();
  }

  toggleMeasure() {
    this.measure.toggle();
    this.redraw();
  }

  async copyLink() {
    this.settle();
    const button = byId("link");
    try {
      await navigator.clipboard.writeText(location.href);
      button.textContent = "Copied";
    } catch {
      prompt("The link to this view:", location.href);
    }
    setTimeout(() => { button.textContent = "Link"; }, 1500);
  }

  save() {
    const scale = stillScale * devicePixelRatio, picture = document.createElement("canvas");
    this.draw(scale);
    picture.width = canvas.width, picture.height = canvas.height;
    const context = picture.getContext("2d");
    context.drawImage(canvas, 0, 0);
    this.drawMarks(context, scale, canvas.clientHeight);
    if (this.state.legend)
      drawLegend(context, this.scene, this.state, {width: picture.width, height: picture.height, em: em * scale});
    savePicture(picture, this.scene.title);
  }
}

// The marks are for tests/bench/page.py, and for whoever opens the browser's tools.
async function start() {
  const text = byId("data");
  const data = JSON.parse(text.textContent);
  text.remove();
  performance.mark("parsed");
  const scene = await decodeScene(data);
  performance.mark("decoded");
  new Viewer(scene);
  performance.mark("prepared");
  requestAnimationFrame(() => performance.mark("drawn"));
  byId("message").textContent = "";
}

start().catch(error => {
  byId("message").textContent = `The mesh cannot be shown: ${error.message}`;
  throw error;
});
