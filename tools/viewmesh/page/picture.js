// The picture that the button saves: the mesh, what is drawn over it, and the legend in place of the panel, as
// picture/legend_card.cpp draws it.

import {hexShare} from "./cells.js";
import {colours} from "./colours.js";
import {legendOf} from "./legend.js";
import {fontOf} from "./marks.js";

// In ems: how high a row of each style is, its letters' size and weight.
const styles = {
  title: [1.5, 1.08, "bold"], share: [1.9, 1.6, "bold"], words: [1.3, 0.88, ""], subject: [1.7, 0.88, ""],
  scale: [0.75, 0, ""], ticks: [1.4, 0.88, ""], key: [1.45, 1, ""],
};
const margin = 1, padding = 0.9, swatch = 0.75, swatchStep = 1.2, leastWidth = 9, greatestShare = 0.34;
const heightOf = rows => rows.reduce((sum, {style}) => sum + styles[style][0], 0);

// `room`: in ems, for all rows.
function rowsOf(scene, state, room) {
  const {subject, ticks, keys} = legendOf(scene, state), share = hexShare(scene);
  const rows = [{style: "title", text: scene.title}];
  if (share) rows.push({style: "share", text: share}, {style: "words", text: "of the volume in hexes"});
  rows.push({style: "subject", text: subject});
  if (ticks.length > 0) rows.push({style: "scale"}, {style: "ticks", ticks});
  const most = Math.max(1, Math.floor((room - heightOf(rows)) / styles.key[0]));
  const shown = keys.length > most ? most - 1 : keys.length;
  rows.push(...keys.slice(0, shown).map(key => ({style: "key", ...key})));
  if (shown < keys.length) rows.push({style: "words", text: `and ${keys.length - shown} more`});
  return rows;
}

function cutTo(context, text, room) {
  if (context.measureText(text).width <= room) return text;
  const characters = [...text];
  while (characters.length > 0 && context.measureText(`${characters.join("")}…`).width > room) characters.pop();
  return `${characters.join("")}…`;
}

function drawRow(context, row, em, left, top, width, {ink, soft}) {
  const [height, size, weight] = styles[row.style], base = top + (height - 0.4) * em;
  if (size > 0) context.font = fontOf(size * em, weight);
  context.textAlign = "left";
  context.fillStyle = ["title", "share", "key"].includes(row.style) ? ink : soft;
  if (row.style === "scale") {
    const ramp = context.createLinearGradient(left, 0, left + width, 0);
    colours.quality.forEach((colour, i) => ramp.addColorStop(i / (colours.quality.length - 1), colour));
    context.fillStyle = ramp;
    context.beginPath();
    context.roundRect(left, top + 0.1 * em, width, 0.55 * em, 0.275 * em);
    context.fill();
  } else if (row.style === "ticks") {
    row.ticks.forEach((text, i) => {
      const own = context.measureText(text).width, middle = i / (row.ticks.length - 1) * width;
      context.fillText(text, left + Math.max(0, Math.min(middle - own / 2, width - own)), base);
    });
  } else if (row.style === "key") {
    context.fillText(cutTo(context, row.text, width - swatchStep * em), left + swatchStep * em, base);
    context.fillStyle = row.colour;
    context.beginPath();
    context.roundRect(left, base + (0.06 - swatch) * em, swatch * em, swatch * em, 0.2 * em);
    context.fill();
  } else context.fillText(cutTo(context, row.text, width), left, base);
}

export function drawLegend(context, scene, state, {width, height, em}) {
  const rows = rowsOf(scene, state, height / em - 2 * (margin + padding)), theme = colours[state.theme];
  const widths = rows.map(({style, text}) => {
    context.font = fontOf(styles[style][1] * em, styles[style][2]);
    return context.measureText(text ?? "").width + (style === "key" ? swatchStep * em : 0);
  });
  const outer = Math.min(Math.max(leastWidth * em, ...widths) + 2 * padding * em, greatestShare * width);
  const left = width - margin * em - outer;
  context.globalAlpha = 0.86;
  context.fillStyle = theme.card;
  context.beginPath();
  context.roundRect(left, margin * em, outer, (heightOf(rows) + 2 * padding) * em, 0.8 * em);
  context.fill();
  context.globalAlpha = 1;
  let top = (margin + padding) * em;
  for (const row of rows) {
    drawRow(context, row, em, left + padding * em, top, outer - 2 * padding * em, theme);
    top += styles[row.style][0] * em;
  }
}

export function savePicture(canvas, title) {
  canvas.toBlob(blob => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = `${title.replace(/[^\w.-]+/g, "-")}.png`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  });
}
