// Elements of the page.  Whatever comes from decks goes in as text, never as markup.

export function h(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false && value !== undefined && value !== null) element.setAttribute(name, value);
  }
  for (const child of children.flat()) if (child !== null && child !== undefined) element.append(child);
  return element;
}

export function select(label, options, value, changed) {
  const list = h("select", {"aria-label": label, onchange: (e) => changed(e.target.value)},
                 options.map(([id, text]) => h("option", {value: id, selected: String(id) === String(value)}, text)));
  return h("label", {class: "field"}, h("span", {}, label), list);
}
export function check(label, value, changed) {
  return h("label", {class: "check"}, h("input", {type: "checkbox", checked: value, onchange: (e) => changed(e.target.checked)}), label);
}
export function button(text, title, clicked) {
  return h("button", {type: "button", title, onclick: clicked}, text);
}

export function table(head, rows, attributes = {}) {
  return h("table", attributes, h("thead", {}, h("tr", {}, head.map((t) => h("th", {scope: "col"}, t)))),
           h("tbody", {}, rows.map((row) => h("tr", {}, row.map((cell) => h("td", {}, cell))))));
}

export function save(name, content, type) {
  const blob = content instanceof Blob ? content : new Blob([content], {type});
  const link = h("a", {href: URL.createObjectURL(blob), download: name});
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// Files get names that every system takes.
export const file_name = (text) => text.replace(/[^A-Za-z0-9_.-]+/g, "_").slice(0, 80) || "view";
export const style_of = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
