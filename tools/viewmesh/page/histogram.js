// How many cells have which quality, as bars whose ends can be drawn in to show less.

import {colours, qualityColour} from "./colours.js";

const bins = 50;
const css = colour => `rgb(${colour.join()})`;

export class Histogram {
  // changed() is called when a handle has moved and state.quality with it.
  constructor(scene, state, changed) {
    this.scene = scene;
    this.state = state;
    this.box = document.getElementById("histogram");
    this.canvas = document.getElementById("bars");
    this.handles = [document.getElementById("low"), document.getElementById("high")];
    let least = 0;
    for (const quality of scene.quality) least = Math.min(least, quality);
    this.least = Math.max(-1, Math.floor(10 * least) / 10);
    this.handles.forEach((handle, end) => this.control(handle, end, changed));
  }

  control(handle, end, changed) {
    const set = value => {
      const range = this.state.quality.map(q => Math.max(q, this.least));
      const inside = end === 0 ? Math.min(value, range[1]) : Math.max(value, range[0]);
      // At its end a handle lets everything pass.
      this.state.quality[end] = inside <= this.least ? -1 : Math.min(1, inside);
      changed();
    };
    handle.addEventListener("pointerdown", event => {
      handle.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    handle.addEventListener("pointermove", event => {
      if (!handle.hasPointerCapture(event.pointerId)) return;
      const {left, width} = this.box.getBoundingClientRect();
      const part = Math.max(0, Math.min(1, (event.clientX - left) / width));
      set(Math.round((this.least + part * (1 - this.least)) * 200) / 200);
    });
    handle.addEventListener("keydown", event => {
      const step = {ArrowLeft: -0.01, ArrowRight: 0.01, ArrowDown: -0.01, ArrowUp: 0.01}[event.key];
      if (!step) return;
      event.preventDefault();
      set(Number((Math.max(this.state.quality[end], this.least) + step).toFixed(3)));
    });
  }

  // Cells of the kinds shown: [hexes, others] in each bin.
  count() {
    const counts = [new Float64Array(bins), new Float64Array(bins)];
    for (let k = 0; k < 4; ++k) {
      if (!this.state.kinds[k]) continue;
      for (let cell = this.scene.kindBegin[k]; cell < this.scene.kindBegin[k + 1]; ++cell) {
        const part = (this.scene.quality[cell] - this.least) / (1 - this.least);
        ++counts[k === 0 ? 0 : 1][Math.max(0, Math.min(bins - 1, Math.floor(part * bins)))];
      }
    }
    return counts;
  }

  show() {
    const {canvas, state} = this, ratio = 2 * devicePixelRatio, [hexes, others] = this.count();
    canvas.width = ratio * canvas.clientWidth, canvas.height = ratio * canvas.clientHeight;
    const context = canvas.getContext("2d"), width = canvas.width / bins;
    const most = Math.max(1, ...hexes.map((n, i) => n + others[i]));
    // By square roots, so that the few bad cells are seen beside the many good ones.
    const height = n => Math.sqrt(n / most) * (canvas.height - 2 * ratio);
    const quiet = state.theme === "dark" ? "#4a525d" : "#d9dde3";
    for (let i = 0; i < bins; ++i) {
      const value = this.least + (i + 0.5) / bins * (1 - this.least);
      const inside = value >= state.quality[0] && value <= state.quality[1];
      const full = height(hexes[i] + others[i]), lower = full * hexes[i] / Math.max(1, hexes[i] + others[i]);
      const bar = (bottom, top, colour) => {
        context.fillStyle = inside ? colour : quiet;
        context.fillRect(i * width, canvas.height - top, width - 0.6 * ratio, top - bottom);
      };
      if (full === 0) continue;
      const same = state.colour === "quality" ? css(qualityColour(value)) : colours.plain;
      bar(lower, full, same);
      bar(0, lower, css(qualityColour(value)));
    }
    this.box.dataset.counts = Array.from(hexes, (n, i) => n + others[i]).join();
    this.box.title = "Cells by scaled Jacobian; heights are square roots of counts. Draw in the ends to show less.";
    this.showHandles();
  }

  showHandles() {
    const {state, least} = this, shown = state.quality.map(q => Math.max(q, least));
    this.handles.forEach((handle, end) => {
      handle.style.left = `${100 * (shown[end] - least) / (1 - least)}%`;
      handle.setAttribute("aria-valuenow", shown[end]);
    });
    document.getElementById("range").textContent = `${shown[0].toFixed(2)} – ${shown[1].toFixed(2)}`;
  }
}
