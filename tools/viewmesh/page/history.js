// What made the mesh: the tools with their options and what they said.

import {brief, byId, element} from "./dom.js";

// What a tool said, a line for what stands together: single values, and behind them what is told part by part, but for
// lists and for parts of parts, which only programs read.
function linesOf(name, entry, depth = 0) {
  const single = Object.entries(entry).filter(([, value]) => typeof value !== "object");
  const parts = Object.entries(entry).filter(([, value]) => value && typeof value === "object" && !Array.isArray(value));
  const words = single.map(([key, value]) => `${key.replaceAll("_", " ")} ${brief(value)}`);
  return [...words.length ? [(name && `${name.replaceAll("_", " ")}: `) + words.join(" · ")] : [],
    ...depth < 2 && entry.count !== 0 ? parts.flatMap(([key, part]) => linesOf(key, part, depth + 1)) : []];
}

export function showHistory(history) {
  const list = byId("history").querySelector("ol");
  byId("history").hidden = history.length === 0;
  for (const {tool, version, options, ...rest} of history) {
    const item = element("li", undefined, {title: `${tool} ${version ?? ""}`});
    item.append(element("b", tool), ...linesOf("", rest).map(line => element("div", line)));
    item.append(element("div", Object.entries(options ?? {}).map(([k, v]) => `--${k} ${brief(v)}`).join("  ")));
    list.append(item);
  }
}
