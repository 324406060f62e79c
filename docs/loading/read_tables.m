% The contact of a cylinder from atlas.nc and paper.nc, in Octave, or in MATLAB from R2024a on (not tested there).
%
%     octave-cli read_tables.m [TABLES [CHECKS]]      default: data/tables docs/loading
%
% Octave reads the files by itself, as HDF5; with its package netcdf, and in MATLAB, ncread does.  Either
% way the dimensions come out reversed: Q(alpha, delta, V).
% Exit code 1 where a value is further from its check value than is stated there.

1;  % a script, not a function file

function table = read_table(path, names)
  if exist('ncread')  % MATLAB, or Octave after "pkg load netcdf"
    for name = names
      table.(name{1}) = ncread(path, name{1});
    end
  else
    table = load('-hdf5', path, names{:});
  end
end

function [beta, Q, M] = from_atlas(t, alpha, kappa, mu, V, delta)  % for any kappa and mu: the steps of README.md
  u_of_s = @(s) 1 - sqrt(1 - s);
  nodes = {log(t.kappa_V(:)), log(t.alpha(:))};
  at = {log(kappa .* abs(V)), log(alpha)};
  delta_star = mu ./ kappa .* interpn(nodes{:}, t.kappa_delta_star_over_mu, at{:}, 'spline');
  s = min(abs(delta) ./ delta_star, 1);
  nodes = [{u_of_s(t.s(:))}, nodes];
  volume_at = [{u_of_s(s)}, at];
  beta = (s < 1) .* interpn(nodes{:}, t.beta, volume_at{:}, 'spline');
  Q = mu .* interpn(nodes{:}, t.Q_over_mu, volume_at{:}, 'spline');
  Q(s == 1) = mu(s == 1);
  Q = sign(delta .* V) .* Q;
  M = sign(V) .* interpn(nodes{2:3}, t.kappa_M, at{:}, 'spline') ./ kappa;
end

function [beta, Q, M] = from_paper(t, alpha, kappa, mu, V, delta)  % at the file's kappa, mu, and one of its alphas
  at = {alpha, delta, abs(V)};
  beta = interpn(t.alpha(:), t.delta(:), t.V(:), t.beta, at{:}, 'linear');
  Q = sign(V) .* interpn(t.alpha(:), t.delta(:), t.V(:), t.Q, at{:}, 'linear');
  M = sign(V) .* interpn(t.alpha(:), t.V(:), t.M, alpha, abs(V), 'linear');
end

function passed = check(tables, checks, name, contact, names)
  rows = dlmread(fullfile(checks, ['check_' name '.csv']), ',', 1, 0);
  state = num2cell(rows(:, 1:5), 1);
  [beta, Q, M] = contact(read_table(fullfile(tables, [name '.nc']), names), state{:});
  good = all(abs([beta Q M] - rows(:, 6:8)) <= rows(:, 9:11), 2);
  verdict = {'WRONG', 'ok'};
  for n = 1:size(rows, 1)
    fprintf('%s %g %g %g %g %g: ', name, rows(n, 1:5));
    fprintf('beta %.9f Q %.9f M %.9f %s\n', beta(n), Q(n), M(n), verdict{1 + good(n)});
  end
  passed = all(good);
end

folders = {'data/tables', 'docs/loading'};
if exist('argv')  % not in MATLAB
  given = argv();
  folders(1:numel(given)) = given;
end
of_atlas = {'alpha', 'kappa_V', 's', 'beta', 'Q_over_mu', 'kappa_M', 'kappa_delta_star_over_mu'};
of_paper = {'V', 'delta', 'alpha', 'beta', 'Q', 'M'};
atlas_passed = check(folders{:}, 'atlas', @from_atlas, of_atlas);
paper_passed = check(folders{:}, 'paper', @from_paper, of_paper);
if ~(atlas_passed && paper_passed)
  error('a value is further from its check value than is allowed');
end
