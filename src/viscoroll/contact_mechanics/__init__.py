"""Contact mechanics: Eqs. (5)-(18) and steady rolling for arrays of states, and how far they hold.

A roller (:mod:`.parameters`), speeds and creepages enter :func:`.contact_states.contact` and
:func:`.stress.stress`, loads enter :func:`.steady_rolling.steady`.  :mod:`.contact_table` alone
calls the kernels of the law.  Results leave as :class:`viscoroll.Values` and
:class:`.steady_result.Steady`, a law for integrators as :class:`.contact_states.Law`, violated
assumptions through :mod:`.model_validity`.
"""

from .. import _open_room

__getattr__ = _open_room(__name__, __file__)
