// Small helpers for elements and numbers.

export const byId = id => document.getElementById(id);
export const grouped = new Intl.NumberFormat("en").format;

export function element(tag, text, properties = {}) {
  const result = Object.assign(document.createElement(tag), properties);
  if (text !== undefined) result.textContent = text;
  return result;
}

export function swatch(colour) {
  const box = element("b");
  box.style.background = colour;
  return box;
}

// With the four digits that tell.
export function brief(value) {
  if (typeof value !== "number" || !Number.isFinite(value)) return String(value);
  return Number.isInteger(value) ? grouped(value) : String(Number(value.toPrecision(4)));
}
