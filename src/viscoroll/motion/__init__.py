"""Motion of the cylinder, Eq. (22): one, or an ensemble of many.

A roller, a start, times and a drive enter :func:`.roll.roll` and :func:`.ensembles.ensemble`;
:mod:`.motion_arguments` and :mod:`.drive_functions` check them, :mod:`.motion_problem` calls the
integrator, :mod:`.flow` looks up free motions.  They leave as :class:`.roll.Motion` and
:class:`.ensembles.Ensemble`, as datasets, and as summaries that merge (:mod:`.summaries`).
"""

from .. import _open_room

__getattr__ = _open_room(__name__, __file__)
