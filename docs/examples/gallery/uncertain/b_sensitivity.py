"""
Sensitivity to uncertain inputs
===============================

Which uncertain input causes most of the scatter of a result?  Sobol indices divide the variance of
the result among the inputs.  A run file names the inputs and their distributions
(:doc:`/sensitivity`).
"""

from pathlib import Path

from viscoroll.core.plots import draw
from viscoroll.runs import read_run
from viscoroll.runs.sensitivity import sobol_indices

Path("launch.toml").write_text(
    """
preset = "rubber-roller"
[scene]
mu = {distribution = "norm", loc = 0.3, scale = 0.03, truncate = [0.2, 0.4]}
j = { distribution = "uniform", loc = 0.45, scale = 0.1 }
[start]
V0 = { distribution = "uniform", loc = 18.0, scale = 4.0 }
omega0 = 0.0
[run]
n = 1
t = [0.1, 0.5, 10.0]
rtol = 1e-6
summaries = ["V", "onset_time"]
"""
)
indices = sobol_indices(read_run("launch.toml"), n=512)
figure = draw(indices)
Path("launch.toml").unlink()
