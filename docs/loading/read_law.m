function contact = read_law(path)
  % contact = read_law('rubber.nc');  s = contact(kappa, mu, V, slip)      slip = omega - V
  % In MATLAB, and in Octave with its package netcdf.  Arrays come as (power, octave).
  if exist('OCTAVE_VERSION', 'builtin'), pkg load netcdf, end
  law = struct('e0', double(ncread(path, 'e0')), 'alpha', ncread(path, 'alpha'), 'limit', ncread(path, 'fast_limit'));
  names = {'lam', 'epsilon', 'm_half_space', 'm_cylinder', 'N', 'share', 'press'};
  for n = 1:7, law.c(:, :, n) = ncread(path, names{n}); end
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
  L = f(1) * (1 + f(2));  delta = 0;
  if slip ~= 0, delta = abs(slip / V); end
  D = 2 * kappa * delta / mu;  w = L - D;
  s = struct('lam', f(1), 'epsilon', f(2), 'delta_star', 0.5 * mu * L / kappa, 'beta', 0, 'Q', sign(slip) * mu, ...
             'M', V * (f(3) + f(4)), 'M_half_space', V * f(3), 'M_cylinder', V * f(4), 'N', f(5));
  if ~(delta < s.delta_star && w > 0), return, end
  v1 = 2 * u / L;  v2 = 2 * u / w;
  [share, press] = stick(law, v2);
  if D < L / 8, q = D * ((2 * L - D) * press - 2 * u * L / w * secant(law, v1, v2)); else, q = 1 - w^2 * press; end
  s.beta = min(share * w / f(1), 1);  s.Q = sign(slip) * mu * min(q, 1);
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
end

function [share, press] = stick(law, v)
  [row, t] = place(law, v);
  if row < size(law.c, 2)
    share = t .^ (0:23) * law.c(:, row + 1, 6);  press = t .^ (0:23) * law.c(:, row + 1, 7);  return
  end
  share = 1 - 0.5 * law.alpha / v * (law.limit(2, 1) + law.limit(1, 1) * log(v));  press = law.alpha * share^2;
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
