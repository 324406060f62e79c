"""Foundations of all layers: errors, checks, units, results and their labels, files, figures.

Arguments enter through :mod:`.arrays` and :mod:`.quantities`, which give float64 in the unit of the
argument or raise an exception of :mod:`.errors`; :mod:`.quantities` has the unit and the symbol of
every quantity.  Results leave through :mod:`.results`, :mod:`.drives_and_labels` and :mod:`.plots`,
files through :mod:`.files`; :mod:`.arrays` also divides arrays among threads.

Other rooms import names of its modules, but for :mod:`.plots`, from the room, which imports the
module of a name at its first use: errors alone import no numpy.
"""

from .. import _open_room

__getattr__ = _open_room(__name__, __file__)
