// const contact = law(JSON.parse(text of rubber.json));  contact(kappa, mu, V, slip)      slip = omega - V
// Plain JavaScript, for pages and Node; `viscoroll tables law MATERIAL.toml -o rubber.json` writes the file.
function law(file) {
  const { lam, epsilon, m_half_space, m_cylinder, N, share, press, e0, limits } = file;
  const rows = lam.length, slow = 2 ** -e0;
  // of a layer: what it has besides; where shear acts back on the pressure
  const alpha = limits ? limits[0] ** -2 : file.alpha;
  const fast_limit = limits ? [[0, 4 * limits[8]], [0, 8 * limits[17]], [0, 8 * limits[18]]] : file.fast_limit;
  const names = ["free_half_space", "free_cylinder", "excess_half_space", "excess_cylinder", "lam_Q", "epsilon_Q"];
  function shear(u) { // L and the functions of these names
    const p = place(u), order = [0, 2, 3, 4, 5, 6, 7];
    if (p.row < rows) return ["limit", ...names].map(name => value(file[name], p));
    return order.map(n => limits[n] + limits[n + 8] / u);
  }
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
    if (p.row < rows) return [lam, epsilon, m_half_space, m_cylinder, N].map(c => c ? value(c, p) : NaN);
    const z = 0.5 / (u * Math.sqrt(alpha)), g = 0.5 * alpha * z, ln = Math.log(z), [[W, C], ...bodies] = fast_limit;
    const [mh, mc] = bodies.map(([W, C]) => g * z * (C - W * (ln - 0.25)));
    if (limits) return [limits[1] + limits[9] / u, limits[16] / u, mh, mc, NaN];
    return [alpha ** -0.5, g * (C - W * ln), mh, mc, 0.25 * (alpha - 1) * z * z];
  }
  function stick(v) {
    const p = place(v);
    if (p.row < rows) return [value(share, p), value(press, p)];
    const [W, C] = fast_limit[0], s = 1 - 0.5 * alpha / v * (C + W * Math.log(v));
    if (!limits) return [s, alpha * s * s];
    const [L, l] = limits, slope = 2 * (limits[9] * L - l * limits[8]) / L ** 3;
    return [l / L + slope / v, alpha * s * s];
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
    const [lam, epsilon, mh, mc, N] = speed(u);
    const [L, fh, fc, gh, gc, lam_Q, epsilon_Q] = limits ? shear(u) : [lam * (1 + epsilon), 0, 0, 0, 0, 0, 0];
    const creepage = slip === 0 ? 0 : V === 0 ? Math.sign(slip) * Infinity : slip / V;
    const own = creepage - 0.5 * (fh + fc) / kappa, side = V < 0 ? -1 : 1;
    const delta = Math.abs(own), delta_star = 0.5 * mu * L / kappa, excess = 2 * (gh + gc) / (mu * L);
    const c = -Math.sign(own) * excess / (1 + (2 * excess) ** 6); // onsets of full slip lie unlike far from free rolling
    const D = 4 * kappa * delta / mu / (1 + Math.sqrt(1 + 4 * c * delta / delta_star)), w = L - D;
    let beta = 0, used = 1;
    if (delta < delta_star * (1 + c) && w > 0) {
      const [s, p] = stick(2 * u / w);
      const q = D < L / 8 ? D * ((2 * L - D) * p - 2 * u * L / w * secant(2 * u / L, 2 * u / w)) : 1 - w * w * p;
      beta = Math.min(s * w / lam, 1);
      used = Math.min(q, 1);
    }
    const along = Math.sign(own) * mu * used, Q = side * along, more = used * (1 + excess ** 4) ** -0.25;
    const ch = Q * (fh + more * gh) / (2 * kappa), cc = Q * (fc + more * gc) / (2 * kappa + fh + fc);
    return {
      lam: lam + lam_Q * along, epsilon: epsilon + epsilon_Q * along, delta_star, beta, Q,
      M: V * (mh + mc) - (ch + cc), M_half_space: V * mh - ch, M_cylinder: V * mc - cc, N,
    };
  };
}
if (typeof module !== "undefined") module.exports = law;
