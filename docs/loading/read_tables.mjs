// The contact of a cylinder from atlas.nc and paper.nc, in Node with h5wasm (npm install h5wasm).
//
//     node read_tables.mjs [TABLES [CHECKS]]         default: data/tables docs/loading
//
// In a browser import "h5wasm" in place of "h5wasm/node" and put the bytes of the file into FS first.
// Exit code 1 where a value is further from its check value than is stated there.

import fs from "node:fs";
import h5wasm from "h5wasm/node";

await h5wasm.ready;

function readTable(path) {
  const file = new h5wasm.File(path, "r");
  const table = Object.fromEntries(file.keys().map((name) => [name, file.get(name).value]));
  file.close();
  return table;
}

// The polynomial through the six nodes around x, which are evenly spaced: first node, weights, number of nodes.
function sixPoints(nodes, x) {
  const size = nodes.length;
  const position = ((x - nodes[0]) / (nodes[size - 1] - nodes[0])) * (size - 1);
  const first = Math.max(0, Math.min(Math.floor(position) - 2, size - 6));
  const six = [0, 1, 2, 3, 4, 5];
  const weights = six.map((k) => six.reduce((w, m) => (m === k ? w : (w * (position - first - m)) / (k - m)), 1));
  return { first, weights, size };
}

// Linear between the two nodes around x.
function twoPoints(nodes, x) {
  const size = nodes.length;
  let first = 0;
  while (first < size - 2 && nodes[first + 1] < x) first++;
  const share = (x - nodes[first]) / (nodes[first + 1] - nodes[first]);
  return { first, weights: [1 - share, share], size };
}

// Sum of weights times values, which lie in one array with the last axis fastest.
function lookUp(values, axes, offset = 0) {
  if (!axes.length) return values[offset];
  const [{ first, weights, size }, ...rest] = axes;
  return weights.reduce((sum, w, k) => sum + w * lookUp(values, rest, offset * size + first + k), 0);
}

const uOfS = (s) => 1 - Math.sqrt(1 - s);

// For any kappa and mu: the steps of README.md.
function fromAtlas(t, { alpha, kappa, mu, V, delta }) {
  const a = sixPoints(t.alpha.map(Math.log), Math.log(alpha));
  const v = sixPoints(t.kappa_V.map(Math.log), Math.log(kappa * Math.abs(V)));
  const s = Math.abs(delta) / ((mu / kappa) * lookUp(t.kappa_delta_star_over_mu, [a, v]));
  const u = sixPoints(t.s.map(uOfS), uOfS(Math.min(s, 1)));
  const beta = s < 1 ? lookUp(t.beta, [a, v, u]) : 0;
  const Q = s < 1 ? mu * lookUp(t.Q_over_mu, [a, v, u]) : mu;
  return { beta, Q: Math.sign(delta * V) * Q, M: (Math.sign(V) * lookUp(t.kappa_M, [a, v])) / kappa };
}

// At the kappa and mu of the file and one of its alphas.
function fromPaper(t, { alpha, V, delta }) {
  const a = { first: t.alpha.indexOf(alpha), weights: [1], size: t.alpha.length };
  const [v, d] = [twoPoints(t.V, Math.abs(V)), twoPoints(t.delta, delta)];
  const sign = Math.sign(V);
  return { beta: lookUp(t.beta, [v, d, a]), Q: sign * lookUp(t.Q, [v, d, a]), M: sign * lookUp(t.M, [v, a]) };
}

function check(tables, checks, name, contact) {
  const table = readTable(`${tables}/${name}.nc`);
  const [head, ...lines] = fs.readFileSync(`${checks}/check_${name}.csv`, "utf8").trim().split(/\r?\n/);
  const names = head.split(",");
  let passed = lines.length > 0;
  for (const line of lines) {
    const row = Object.fromEntries(line.split(",").map((text, n) => [names[n], Number(text)]));
    const found = contact(table, row);
    const good = ["beta", "Q", "M"].every((field) => Math.abs(found[field] - row[field]) <= row[`allowed_${field}`]);
    const [beta, Q, M] = ["beta", "Q", "M"].map((field) => found[field].toFixed(9));
    const state = ["alpha", "kappa", "mu", "V", "delta"].map((field) => row[field]).join(" ");
    console.log(`${name} ${state}: beta ${beta} Q ${Q} M ${M} ${good ? "ok" : "WRONG"}`);
    passed &&= good;
  }
  return passed;
}

const [tables = "data/tables", checks = "docs/loading"] = process.argv.slice(2);
const passed = [check(tables, checks, "atlas", fromAtlas), check(tables, checks, "paper", fromPaper)];
process.exit(passed.every(Boolean) ? 0 : 1);
