// Sliders and curves of live.md.  law() is that of read_law.js, RUBBER the file of a law; lengths, speeds and creep are scaled: kappa = 1.
(() => {
  const contact = law(RUBBER), place = document.getElementById("law"), COLOURS = ["primary", "accent"], POINTS = 241;
  const decades = RUBBER.retardation_time.map(T => -Math.log10(T)), low = Math.floor(Math.min(...decades)) - 2, high = Math.ceil(Math.max(...decades)) + 3;
  const SLIDERS = { // what, from, to, at first, value of the place
    u: ["κV", low, high, low + 2.5, x => 10 ** x], creep: ["κδ", -0.3, 0.3, -0.04, x => x], mu: ["μ", -2, 0, -0.5, x => 10 ** x],
  };
  const NUMBERS = { lam: "λ", epsilon: "ε", delta_star: "κδ*", beta: "β", Q: "Q", M: "κM" }, now = {};
  const at = (u, creep) => contact(1, now.mu, u, creep * u);
  const PLOTS = [ // heading, names of the curves, what they are over, from, to, their values there, place of the state
    ["length and shift", ["λ", "ε"], "lg κV", low, high, x => { const c = at(10 ** x, 0); return [c.lam, c.epsilon]; }, () => Math.log10(now.u)],
    ["rolling resistance", ["κM"], "lg κV", low, high, x => [at(10 ** x, 0).M], () => Math.log10(now.u)],
    ["friction and stick at this creep", ["|Q|/μ", "β"], "lg κV", low, high, x => traction(10 ** x, now.creep), () => Math.log10(now.u)],
    ["friction and stick at this speed", ["|Q|/μ", "β"], "κδ", -0.3, 0.3, x => traction(now.u, x), () => now.creep],
  ];
  const traction = (u, creep) => { const c = at(u, creep); return [Math.abs(c.Q) / now.mu, c.beta]; };

  function plot([heading, names, over, from, to, values, here]) {
    const x = Array.from({ length: POINTS }, (_, i) => from + (to - from) * i / (POINTS - 1)), y = x.map(values), all = y.flat();
    const top = Math.max(...all), bottom = Math.min(0, ...all), px = x => 34 + 256 * (x - from) / (to - from), py = y => 150 - 130 * (y - bottom) / (top - bottom || 1);
    const curve = k => `<path class="${COLOURS[k]}" d="M${x.map((x, i) => `${px(x).toFixed(1)} ${py(y[i][k]).toFixed(1)}`).join("L")}"/>`;
    return `<figure><figcaption>${heading}: ${names.map((name, k) => `<span class="${COLOURS[k]}">${name}</span>`).join(", ")}</figcaption>
<svg viewBox="0 0 300 180" role="img" aria-label="${heading}: ${names.join(", ")} over ${over}">${names.map((_, k) => curve(k)).join("")}
<path class="axis" d="M34 20V150H290M${px(here())} 20V150"/><text x="34" y="166">${from}</text><text x="162" y="176" text-anchor="middle">${over}</text>
<text x="290" y="166" text-anchor="end">${to}</text><text x="30" y="26" text-anchor="end">${top.toPrecision(2)}</text><text x="30" y="150" text-anchor="end">${bottom.toPrecision(2)}</text></svg></figure>`;
  }

  function draw() {
    const state = { ...now, ...at(now.u, now.creep) };
    for (const shown of place.querySelectorAll("data")) { shown.value = state[shown.id]; shown.textContent = state[shown.id].toPrecision(5); }
    place.querySelector(".plots").innerHTML = PLOTS.map(plot).join("");
  }

  const number = name => `<data id="${name}"></data>`;
  place.innerHTML = `<form>${Object.entries(SLIDERS).map(([name, [text, from, to, first]]) =>
    `<label>${text} = ${number(name)}<input name="${name}" type="range" min="${from}" max="${to}" value="${first}" step="any"></label>`).join("")}</form>
<p role="status">${Object.entries(NUMBERS).map(([name, text]) => `<span>${text} = ${number(name)}</span>`).join(" ")}</p><div class="plots"></div>`;
  for (const input of place.querySelectorAll("input")) {
    const read = () => { now[input.name] = SLIDERS[input.name][4](input.valueAsNumber); };
    input.addEventListener("input", () => { read(); draw(); });
    read();
  }
  draw();
})();
