function contact = read_law(path)
  % contact = read_law('rubber.nc');  s = contact(kappa, mu, V, slip)      slip = omega - V
  % In MATLAB, and in Octave with its package netcdf.  Arrays come as (power, octave).
  if exist('OCTAVE_VERSION', 'builtin'), pkg load netcdf, end
  names = {'lam', 'epsilon', 'm_half_space', 'm_cylinder', 'N', 'share', 'press', 'limit', 'free_half_space', ...
           'free_cylinder', 'excess_half_space', 'excess_cylinder', 'lam_Q', 'epsilon_Q'};
  law = struct('e0', double(ncread(path, 'e0')), 'ends', []);
  law.c = NaN([size(ncread(path, 'lam')), 7]);
  info = ncinfo(path);  layer = any(strcmp({info.Variables.Name}, 'limits'));
  if layer                                   % a layer: shear acts back on the pressure, and N is not known
    e = ncread(path, 'limits');  law.ends = e(:)';
    law.alpha = e(1)^-2;  law.limit = [0, 0, 0; 4 * e(9), 8 * e(18), 8 * e(19)];
  else
    law.alpha = ncread(path, 'alpha');  law.limit = ncread(path, 'fast_limit');
  end
  for n = [1:4, 6:7], law.c(:, :, n) = ncread(path, names{n}); end
  if layer, for n = 8:14, law.c(:, :, n) = ncread(path, names{n}); end, else, law.c(:, :, 5) = ncread(path, 'N'); end
  contact = @(kappa, mu, V, slip) state(law, kappa, mu, V, slip);
end

function s = state(law, kappa, mu, V, slip)
  % NaN where one of these is NaN or infinite, kappa or mu is not above 0, or kappa |V| is above 1e300
  u = kappa * abs(V);
  if ~(kappa > 0 && mu > 0 && mu < Inf && u <= 1e300 && abs(slip) < Inf)
    s = struct('lam', NaN, 'epsilon', NaN, 'delta_star', NaN, 'beta', NaN, 'Q', NaN, ...
               'M', NaN, 'M_half_space', NaN, 'M_cylinder', NaN, 'N', NaN);
    return
  end
  f = speed(law, u);
  h = [f(1) * (1 + f(2)), 0, 0, 0, 0, 0, 0];
  if ~isempty(law.ends), h = shear(law, u); end
  L = h(1);  creepage = 0;
  if slip ~= 0, if V == 0, creepage = sign(slip) * Inf; else, creepage = slip / V; end, end
  own = creepage - 0.5 * (h(2) + h(3)) / kappa;  delta = abs(own);  side = 1;
  if V < 0, side = -1; end
  delta_star = 0.5 * mu * L / kappa;  excess = 2 * (h(4) + h(5)) / (mu * L);
  c = -sign(own) * excess / (1 + (2 * excess)^6);  % onsets of full slip lie unlike far from free rolling
  D = 4 * kappa * delta / mu / (1 + sqrt(max(1 + 4 * c * delta / delta_star, 0)));  w = L - D;  beta = 0;  used = 1;
  if delta < delta_star * (1 + c) && w > 0
    v1 = 2 * u / L;  v2 = 2 * u / w;
    [share, press] = stick(law, v2);
    if D < L / 8, q = D * ((2 * L - D) * press - 2 * u * L / w * secant(law, v1, v2)); else, q = 1 - w^2 * press; end
    beta = min(share * w / f(1), 1);  used = min(q, 1);
  end
  along = sign(own) * mu * used;  Q = side * along;  more = used * (1 + excess^4)^-0.25;
  Mh = V * f(3) - Q * (h(2) + more * h(4)) / (2 * kappa);
  Mc = V * f(4) - Q * (h(3) + more * h(5)) / (2 * kappa + h(2) + h(3));
  s = struct('lam', f(1) + h(6) * along, 'epsilon', f(2) + h(7) * along, 'delta_star', delta_star, 'beta', beta, 'Q', Q, ...
             'M', Mh + Mc, 'M_half_space', Mh, 'M_cylinder', Mc, 'N', f(5));
end

function h = shear(law, u)                 % of a layer
  [row, t] = place(law, u);
  if row < size(law.c, 2)
    h = t .^ (0:23) * reshape(law.c(:, row + 1, 8:14), 24, 7);
  else
    n = [1, 3:8];  h = law.ends(n) + law.ends(n + 8) / u;
  end
end

function [row, t, dt_dx] = place(law, x)   % row 0 is that of the slow end
  [m, e] = log2(x);
  row = e - law.e0;
  if row <= 0 || x == 0, row = 0;  dt_dx = 2^-law.e0;  t = x * dt_dx; else, t = 4 * m - 3;  dt_dx = (t + 3) / x; end
end

function f = speed(law, u)
  [row, t] = place(law, u);
  if row < size(law.c, 2)
    f = squeeze(t .^ (0:23) * reshape(law.c(:, row + 1, 1:5), 24, 5));  return
  end
  z = 0.5 / (u * sqrt(law.alpha));  half = 0.5 * law.alpha * z;  W = law.limit(1, :);  C = law.limit(2, :);
  m = half * z * (C - W * (log(z) - 0.25));
  f = [law.alpha^-0.5, half * (C(1) - W(1) * log(z)), m(2), m(3), 0.25 * (law.alpha - 1) * z^2];
  if ~isempty(law.ends), f([1, 2, 5]) = [law.ends(2) + law.ends(10) / u, law.ends(17) / u, NaN]; end
end

function [share, press] = stick(law, v)
  [row, t] = place(law, v);
  if row < size(law.c, 2)
    share = t .^ (0:23) * law.c(:, row + 1, 6);  press = t .^ (0:23) * law.c(:, row + 1, 7);  return
  end
  share = 1 - 0.5 * law.alpha / v * (law.limit(2, 1) + law.limit(1, 1) * log(v));  press = law.alpha * share^2;
  if ~isempty(law.ends)
    e = law.ends;  share = e(2) / e(1) + 2 * (e(10) * e(1) - e(2) * e(9)) / e(1)^3 / v;
  end
end

function S = secant(law, v1, v2)           % mean slope of press between v1 and v2
  [r1, t1, p1] = place(law, v1);  [r2, t2, p2] = place(law, v2);
  if r2 >= size(law.c, 2)
    W = law.limit(1, 1);  C = law.limit(2, 1);  x = (v2 - v1) / v1;  ratio = 1;
    if x > 0, ratio = log1p(x) / x; end
    shares = 2 - 0.5 * law.alpha * ((C + W * log(v1)) / v1 + (C + W * log(v2)) / v2);
    S = 0.5 * law.alpha^2 * shares * (C - W * (ratio - log(v1))) / v1 / v2;
  elseif r1 == r2
    S = chord(law, r1, t1, t2) * p1;
  else
    part = min(max((2^(law.e0 + r2 - 1) - v1) / (v2 - v1), 0), 1);
    S = part * chord(law, r1, t1, 1) * p1 + (1 - part) * chord(law, r2, t2, -1) * p2;
  end
end

function total = chord(law, row, t, s)
  last = law.c(24, row + 1, 7);  total = last;
  for k = 23:-1:2, last = last * t + law.c(k, row + 1, 7);  total = total * s + last; end
end
