// const contact = law(JSON.parse(text of rubber.json));  contact(kappa, mu, V, slip)      slip = omega - V
// Plain JavaScript, for pages and Node; `viscoroll tables law MATERIAL.toml -o rubber.json` writes the file.
function law({ lam, epsilon, m_half_space, m_cylinder, N, share, press, e0, alpha, fast_limit }) {
  const rows = lam.length, slow = 2 ** -e0;
  const word = new Float64Array(1), half = new Uint32Array(word.buffer); // half[1]: sign, exponent, top of the mantissa
  function place(x) { // row 0 is that of the slow end
    word[0] = x;
    const row = ((half[1] >>> 20) & 2047) - 1022 - e0;
    if (row <= 0) return { row: 0, t: x * slow, dt_dx: slow };
    half[1] = (half[1] & 0xfffff) | (1022 << 20);
    const t = 4 * word[0] - 3;
    return { row, t, dt_dx: (t + 3) / x };
  }
  function value(c, { row, t }) {
    const powers = c[row];
    let sum = 0;
    for (let k = powers.length - 1; k >= 0; k--) sum = sum * t + powers[k];
    return sum;
  }
  function speed(u) {
    const p = place(u);
    if (p.row < rows) return [lam, epsilon, m_half_space, m_cylinder, N].map(c => value(c, p));
    const z = 0.5 / (u * Math.sqrt(alpha)), g = 0.5 * alpha * z, ln = Math.log(z), [[W, C], ...bodies] = fast_limit;
    const [mh, mc] = bodies.map(([W, C]) => g * z * (C - W * (ln - 0.25)));
    return [alpha ** -0.5, g * (C - W * ln), mh, mc, 0.25 * (alpha - 1) * z * z];
  }
  function stick(v) {
    const p = place(v);
    if (p.row < rows) return [value(share, p), value(press, p)];
    const [W, C] = fast_limit[0], s = 1 - 0.5 * alpha / v * (C + W * Math.log(v));
    return [s, alpha * s * s];
  }
  function chord({ row, t }, s) {
    const c = press[row];
    let last = c[c.length - 1], sum = last;
    for (let k = c.length - 2; k > 0; k--) { last = last * t + c[k]; sum = sum * s + last; }
    return sum;
  }
  function secant(v1, v2) { // mean slope of press between v1 and v2
    const a = place(v1), b = place(v2);
    if (b.row >= rows) {
      const [W, C] = fast_limit[0], x = (v2 - v1) / v1, e = v => (C + W * Math.log(v)) / v;
      const slope = C - W * ((x > 0 ? Math.log1p(x) / x : 1) - Math.log(v1));
      return 0.5 * alpha * alpha * (2 - 0.5 * alpha * (e(v1) + e(v2))) * slope / v1 / v2;
    }
    if (a.row === b.row) return chord(a, b.t) * a.dt_dx;
    const part = Math.min(Math.max((2 ** (e0 + b.row - 1) - v1) / (v2 - v1), 0), 1);
    return part * chord(a, 1) * a.dt_dx + (1 - part) * chord(b, -1) * b.dt_dx;
  }
  // NaN where one of these is NaN or infinite, kappa or mu is not above 0, or kappa |V| is above 1e300
  return function contact(kappa, mu, V, slip) {
    const u = kappa * Math.abs(V);
    if (!(kappa > 0 && mu > 0 && mu < Infinity && u <= 1e300 && Math.abs(slip) < Infinity)) {
      const names = ["lam", "epsilon", "delta_star", "beta", "Q", "M", "M_half_space", "M_cylinder", "N"];
      return Object.fromEntries(names.map(name => [name, NaN]));
    }
    const [lam, epsilon, mh, mc, N] = speed(u), L = lam * (1 + epsilon);
    const delta = slip === 0 ? 0 : Math.abs(slip / V), D = 2 * kappa * delta / mu, w = L - D, sign = Math.sign(slip);
    const state = {
      lam, epsilon, delta_star: 0.5 * mu * L / kappa, beta: 0, Q: sign * mu,
      M: V * (mh + mc), M_half_space: V * mh, M_cylinder: V * mc, N,
    };
    if (!(delta < state.delta_star && w > 0)) return state;
    const [s, p] = stick(2 * u / w);
    const q = D < L / 8 ? D * ((2 * L - D) * p - 2 * u * L / w * secant(2 * u / L, 2 * u / w)) : 1 - w * w * p;
    state.beta = Math.min(s * w / lam, 1);
    state.Q = sign * mu * Math.min(q, 1);
    return state;
  };
}
if (typeof module !== "undefined") module.exports = law;
