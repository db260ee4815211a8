// The distance between two vertices, each the one of a facet that is nearest to a click.

import {placeOf} from "./camera.js";
import {kindOf, pointOf} from "./cells.js";
import {brief, byId, element} from "./dom.js";

export class Measure {
  constructor(scene) {
    this.scene = scene;
    this.isOn = false;
    this.ends = [];  // vertices, at most two
  }

  toggle() {
    this.isOn = !this.isOn;
    this.ends = [];
    byId("measure").setAttribute("aria-pressed", this.isOn);
    byId("scene").classList.toggle("measuring", this.isOn);
    this.show();
  }

  // (x, y): a place of the picture, from -1 to 1.
  click({cell, facet}, camera, x, y) {
    if (cell < 0) return;
    const {scene} = this, k = kindOf(scene, cell), {corners: width, facets} = scene.kinds[k];
    const vertices = facets[facet].map(corner => scene.corners[k][(cell - scene.kindBegin[k]) * width + corner]);
    const [across, up] = camera.halfFrustum;
    const distance = vertex => {
      const place = placeOf(camera, pointOf(scene, vertex));
      return place ? Math.hypot((place[0] - x) * across, (place[1] - y) * up) : Infinity;
    };
    const nearest = vertices.reduce((a, b) => distance(b) < distance(a) ? b : a);
    this.ends = this.ends.length === 1 ? [this.ends[0], nearest] : [nearest];
    this.show();
  }

  // From the first end to the second, in the mesh's own units; null as long as there are no two.
  get way() {
    if (this.ends.length < 2) return null;
    const [a, b] = this.ends.map(vertex => pointOf(this.scene, vertex));
    return a.map((from, i) => this.scene.unit * (b[i] - from));
  }

  get text() {
    return this.way && brief(Math.hypot(...this.way));
  }

  show() {
    const {way} = this, table = byId("measured").querySelector("table");
    byId("measured").hidden = !this.isOn;
    byId("measure-hint").textContent = ["Click a vertex.", "Click another one.", ""][this.ends.length];
    table.replaceChildren();
    document.body.dataset.measured = way ? `${this.ends.join(" ")} ${Math.hypot(...way)}` : "";
    if (!way) return;
    const row = (name, value) => table.insertRow().append(element("td", name), element("td", value));
    row("distance", this.text);
    row("along x, y, z", way.map(brief).join(", "));
    row("vertices", this.ends.join(" "));
  }
}
