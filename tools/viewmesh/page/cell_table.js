// What there is to say of one cell.

import {cornersOf, kindOf, middleOf} from "./cells.js";
import {colours} from "./colours.js";
import {byId, element} from "./dom.js";

function nameOf(scene, kind, place) {
  const {tag, name} = scene.groups[kind][place];
  return name === `${kind}_${tag}` ? String(tag) : `${name} (${tag})`;
}

// A cell of -1 is none, and so is a surface.
export function showCell(scene, cell, surface) {
  const table = byId("picked").querySelector("table");
  byId("picked").hidden = cell < 0;
  table.replaceChildren();
  if (cell < 0) return;
  const row = (name, value) => table.insertRow().append(element("td", name), element("td", value));
  // Candidates and the tets that they leave count from 1, as in .sol files and messages; cells of a mesh from 0.
  const first = ["candidates", "solution"].includes(scene.content) ? 1 : 0;
  row(scene.content === "candidates" ? "candidate" : scene.kinds[kindOf(scene, cell)].name,
    `number ${scene.number[cell] + first}`);
  row("scaled Jacobian", scene.quality[cell].toFixed(4));
  for (const [name, values] of Object.entries(scene.measures)) {
    const {title, unit, decimals} = colours.measures[name];
    row(title, (values[cell] / unit).toFixed(decimals) + (name === "orthogonality" ? "°" : ""));
  }
  row("region", nameOf(scene, "region", scene.groups.region.findIndex(({tag}) => tag === scene.region[cell])));
  if (surface >= 0) row("surface", nameOf(scene, "surface", surface));
  row("layer", scene.layer[cell]);
  row("vertices", [...cornersOf(scene, cell)].join(" "));
  row("middle", middleOf(scene, cell).map((m, i) => Number((scene.centre[i] + scene.unit * m).toPrecision(5))).join(", "));
  byId("picked").scrollIntoView({block: "nearest"});
}
