"use strict";
// The judge runs here, so that the page never stops: one question at a time, one answer to each.
let judge = null;

function refuse(name) {
  return () => { throw new Error(`the module asked for ${name}`); };
}

// Libraries declare functions of a browser that a judge of tables never calls.
function imports(module) {
  const all = {};
  for (const { module: from, name } of WebAssembly.Module.imports(module)) {
    (all[from] ??= {})[name] = refuse(name);
  }
  return all;
}

function answer() {
  const { memory, answer_start, answer_length } = judge;
  const bytes = new Uint8Array(memory.buffer, answer_start(), answer_length());
  return new TextDecoder().decode(bytes);
}

function ask(question) {
  const bytes = new TextEncoder().encode(JSON.stringify(question));
  const start = judge.question_start(bytes.length);
  new Uint8Array(judge.memory.buffer).set(bytes, start);
  judge.judge_question();
  return JSON.parse(answer());
}

async function begin(bytes) {
  const module = await WebAssembly.compile(bytes);
  const instance = await WebAssembly.instantiate(module, imports(module));
  judge = instance.exports;
  judge.ask_version();
  postMessage({ version: answer() });
}

// A question waits until the module is there.
let ready = null;
onmessage = async ({ data }) => {
  if (data.module) ready = begin(data.module);
  try {
    await ready;
    if (data.question) postMessage({ id: data.id, found: ask(data.question) });
  } catch (error) {
    postMessage({ id: data.id ?? 0, error: String(error) });
  }
};
