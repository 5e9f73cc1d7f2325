"use strict";
// Nothing of the text is ever markup: words become text nodes, figures are images.
const byId = (id) => document.getElementById(id);
const OPTIONS = ["step", "columns", "values", "names", "lines", "dim", "ratio", "floor", "scale", "eps", "samples"];
const LISTS = new Set(["columns", "values", "names", "lines"]);
const NUMBERS = new Set(["dim", "ratio", "floor", "scale", "eps", "tolerance"]);
// What a link keeps beside the options.
const CLAIM = ["claim", "order", "tolerance"];
const LONGEST_FILE = 4 << 20;
// A question that takes longer is given up: in milliseconds.
const PATIENCE = 10000;
const EXAMPLES = {
  pass: { order: "2", text: "h, L2\n0.1, 1.01e-2\n0.05, 2.52e-3\n0.025, 6.27e-4\n0.0125, 1.565e-4\n" },
  lost: { order: "2", text: "| h | L2 | H1 |\n|---|---|---|\n| 1/8 | 1.62e-2 | 1.30e-1 |\n| 1/16 | 4.06e-3 | 6.52e-2 |\n| 1/32 | 1.015e-3 | 3.26e-2 |\n| 1/64 | 2.538e-4 | 1.631e-2 |\n" },
  constant: { order: "2", text: "h, L2 error\n0.1, 4.1e-2\n0.05, 3.3e-2\n0.025, 3.1e-2\n0.0125, 3.05e-2\n" },
};

let worker = null;
let latest = 0;
let timer = 0;
let last = null;

function element(name, properties, ...children) {
  const node = Object.assign(document.createElement(name), properties);
  node.append(...children);
  return node;
}

async function unpacked(base64) {
  const packed = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

let module = null;
async function start() {
  module ??= await unpacked(byId("module").textContent.trim());
  const source = new Blob([byId("worker").textContent], { type: "text/javascript" });
  worker = new Worker(URL.createObjectURL(source));
  worker.onmessage = ({ data }) => receive(data);
  worker.onerror = (event) => show(message(`The page cannot compute here: ${event.message}`));
  worker.postMessage({ module: module.slice(0) });
}

function receive(data) {
  if (data.version) {
    byId("version").textContent = data.version;
    document.body.dataset.ready = "true";
    return;
  }
  if (data.id === 0) return show(message(`The page cannot compute here: ${data.error}`));
  if (data.id !== latest) return;
  clearTimeout(timer);
  if (data.error) {
    // A module that has stopped is not asked again.
    worker.terminate();
    start();
    show(message(`Nothing is judged: ${data.error}`));
  } else {
    last = data.found;
    show(last.refused ? refusal(last.refused) : answer(last));
  }
  byId("answer").dataset.answered = String(data.id);
}

// Claims as `--order` has them, one after another: `2`, `>=2`, `L2 error=3`. What is none of these
// goes to the judge as it is, and is refused there.
function orders(text) {
  const claim = /(?:>=\s*)?[\d.]+(?:[eE][+-]?\d+)?(?=[\s,]|$)|[^=,]+=(?:>=\s*)?[^\s,]+/g;
  const rest = text.replace(claim, "").replace(/[\s,]/g, "");
  return rest === "" ? (text.match(claim) ?? []).map((one) => one.trim()) : [text.trim()];
}

function question() {
  const one = { text: byId("text").value, [byId("claim").value]: orders(byId("order").value) };
  for (const name of [...OPTIONS, "tolerance"]) {
    const value = byId(name).value.trim();
    if (value === "") continue;
    if (NUMBERS.has(name)) one[name] = Number(value);
    else if (LISTS.has(name)) one[name] = value.split(",").map((column) => column.trim());
    else one[name] = value;
  }
  return one;
}

function wrongNumber() {
  return [...NUMBERS].find((name) => Number.isNaN(Number(byId(name).value.trim())));
}

function ask() {
  latest += 1;
  byId("copies").hidden = true;
  byId("copied").value = "";
  const wrong = wrongNumber();
  if (byId("text").value.trim() === "") {
    last = null;
    return show(message("Nothing yet."));
  }
  if (wrong) return show(message(`${wrong}: expected a number; found ${byId(wrong).value}`));
  byId("answer").setAttribute("aria-busy", "true");
  byId("answer").classList.add("busy");
  clearTimeout(timer);
  timer = setTimeout(giveUp, PATIENCE);
  worker.postMessage({ id: latest, question: question() });
}

function giveUp() {
  worker.terminate();
  start();
  show(message(`Nothing is judged: the text takes longer than ${PATIENCE / 1000} s here. Use \`convergence-study rates FILE\`.`));
}

function show(...nodes) {
  const place = byId("answer");
  place.replaceChildren(...nodes.flat());
  place.setAttribute("aria-busy", "false");
  place.classList.remove("busy");
  byId("copies").hidden = !last || !last.verdict || !place.querySelector(".verdict");
}

// Words between back quotes as code.
function phrase(text) {
  const parts = text.split("`");
  if (parts.length % 2 === 0) return [text];
  return parts.map((part, k) => (k % 2 ? element("code", {}, part) : part));
}

function message(words) {
  return element("p", { className: "help" }, ...phrase(words));
}

function badge(verdict) {
  return element("span", { className: `badge ${verdict}` }, verdict);
}

function answer(found) {
  const nodes = [element("p", { className: "verdict" }, badge(found.verdict), ` ${found.sentence}`)];
  for (const table of found.tables) {
    if (found.tables.length > 1) nodes.push(element("h3", {}, table.name));
    nodes.push(message(table.reading));
    for (const doubt of table.doubts) {
      const row = element("p", { className: "row" }, ...phrase(`Doubt: ${doubt.because} `));
      if (doubt.settings) row.append(offered(doubt.settings));
      nodes.push(row);
    }
    nodes.push(...table.columns.map(column));
    nodes.push(element("div", { className: "scroll", tabIndex: 0 }, cells(table.rows)));
    if (table.legend.trim() !== "") nodes.push(element("p", { className: "help legend" }, table.legend.trim()));
    nodes.push(figure(table));
  }
  return nodes;
}

function column(one) {
  const head = element("p", {}, element("b", {}, one.name), " ");
  if (one.verdict) head.append(badge(one.verdict), " ");
  head.append(...phrase(one.answer));
  const node = element("div", { className: "found" }, head);
  if (one.advice) node.append(message(one.advice));
  return node;
}

function cells(rows) {
  const [names, ...levels] = rows;
  const head = element("tr", {}, ...names.map((name) => element("th", { scope: "col" }, name.trim())));
  const row = (level) => element("tr", {}, ...level.map((cell) => element("td", {}, cell.trim())));
  return element("table", { className: "cells" }, element("thead", {}, head), element("tbody", {}, ...levels.map(row)));
}

function figure(table) {
  const source = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(table.figure)}`;
  return element("img", { className: "figure", src: source, alt: `Errors over steps of ${table.name}, on logarithmic axes` });
}

function refusal(refused) {
  const nodes = [element("p", { className: "verdict" }, element("span", { className: "badge fail" }, "not judged"))];
  nodes.push(element("pre", {}, ...phrase(refused.message)));
  if (refused.line) nodes.push(place(refused));
  for (const offer of refused.offers ?? []) {
    nodes.push(element("p", { className: "row" }, offered(offer.settings), ...phrase(offer.comment ?? "")));
  }
  return nodes;
}

// A button that reads the table with these settings.
function offered(settings) {
  const words = Object.entries(settings).map(([name, value]) => `${name} ${[value].flat().join(",")}`).join(", ");
  const button = element("button", { type: "button" }, `Read it with ${words}`);
  button.addEventListener("click", () => take(settings));
  return button;
}

// A letter that is not seen, or turns the text around, as a mark.
function visible(letter) {
  return /[\u0000-\u001f\u007f-\u009f\u200b-\u200f\u202a-\u202e\u2066-\u2069]/u.test(letter) ? "\ufffd" : letter;
}

function place(refused) {
  const line = byId("text").value.split("\n")[refused.line - 1] ?? "";
  const at = Math.max((refused.column ?? 1) - 1, 0);
  const letters = [...line].map(visible);
  const shown = element("pre", {}, `${refused.line} | ${letters.slice(0, at).join("")}`, element("mark", {}, letters.slice(at).join("") || " "));
  const button = element("button", { type: "button" }, `Go to line ${refused.line}`);
  button.addEventListener("click", () => select(refused.line, line));
  return element("div", {}, shown, button);
}

function select(number, line) {
  const text = byId("text");
  const before = text.value.split("\n").slice(0, number - 1);
  const from = before.join("\n").length + (number > 1 ? 1 : 0);
  text.focus();
  text.setSelectionRange(from, from + line.length);
}

function take(settings) {
  for (const [name, value] of Object.entries(settings)) {
    if (name === "order") byId("order").value = String(value);
    else byId(name).value = [value].flat().join(",");
  }
  byId("options").open = true;
  ask();
}

// Text and options in the fragment of the address, compressed: a server never sees them.
async function pack(bytes, stream) {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

async function fragment() {
  const state = { text: byId("text").value };
  for (const name of [...CLAIM, ...OPTIONS]) if (byId(name).value) state[name] = byId(name).value;
  const packed = await pack(new TextEncoder().encode(JSON.stringify(state)), new CompressionStream("deflate-raw"));
  const base64 = btoa(Array.from(packed, (byte) => String.fromCharCode(byte)).join(""));
  return base64.replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

async function restore() {
  const text = location.hash.slice(1);
  if (text === "") return;
  try {
    const packed = Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
    const bytes = await pack(packed, new DecompressionStream("deflate-raw"));
    const state = JSON.parse(new TextDecoder().decode(bytes));
    for (const name of ["text", "order", "tolerance", ...OPTIONS]) byId(name).value = String(state[name] ?? "");
    byId("claim").value = state.claim === "factor" ? "factor" : "order";
    byId("options").open = OPTIONS.some((name) => byId(name).value !== "");
    ask();
  } catch {
    show(message("The address has no table that can be read: it may have been cut."));
  }
}

async function copy(words, what) {
  try {
    await navigator.clipboard.writeText(words);
    byId("copied").value = `${what} copied`;
  } catch {
    // A page from a file may not reach the clipboard: the words are selected for the reader.
    const box = element("textarea", { rows: 4, value: words, readOnly: true, ariaLabel: what });
    byId("copied").replaceChildren(box);
    box.select();
    box.focus();
  }
}

async function link() {
  const address = `${location.href.split("#")[0]}#${await fragment()}`;
  const long = address.length > 8000 ? `link of ${address.length} characters, which some programs cut,` : "link";
  await copy(address, long);
}

function clearOptions() {
  for (const name of OPTIONS) byId(name).value = "";
  ask();
}

function example(name) {
  for (const option of [...OPTIONS, "tolerance"]) byId(option).value = "";
  byId("text").value = EXAMPLES[name].text;
  byId("claim").value = "order";
  byId("order").value = EXAMPLES[name].order;
  ask();
}

async function takeFile(file) {
  if (!file) return;
  // A field with so much text would stop the page; the judge has the same limit.
  if (file.size > LONGEST_FILE) {
    last = null;
    return show(message(`expected a file of at most ${LONGEST_FILE} bytes; found ${file.size}: use convergence-study rates FILE`));
  }
  byId("text").value = await file.text();
  ask();
}

async function main() {
  for (const name of ["text", ...CLAIM, ...OPTIONS]) byId(name).addEventListener("input", ask);
  for (const button of document.querySelectorAll("[data-example]")) {
    button.addEventListener("click", () => example(button.dataset.example));
  }
  byId("file").addEventListener("change", ({ target }) => takeFile(target.files[0]));
  byId("text").addEventListener("dragover", (event) => event.preventDefault());
  byId("text").addEventListener("drop", (event) => {
    if (event.dataTransfer.files.length === 0) return;
    event.preventDefault();
    takeFile(event.dataTransfer.files[0]);
  });
  byId("clear").addEventListener("click", clearOptions);
  byId("copy-markdown").addEventListener("click", () => copy(last.markdown, "Markdown"));
  byId("copy-command").addEventListener("click", () => copy(last.command, "command"));
  byId("copy-link").addEventListener("click", link);
  addEventListener("hashchange", restore);
  await start();
  await restore();
}

main();
