"""
A rubber of many relaxation times
=================================

Real rubbers relax over many decades of time.  Each relaxation time far from the others
gives rolling resistance a hump of its own; many of them close together give a plateau.
"""

from viscoroll.figures import broad_stresses, law_of_materials

figure = law_of_materials()

# %%
# All four materials have the same modulus at rest and the same at once.  ``lam`` is the
# contact length, ``epsilon`` its shift ahead of the axis.
#
# The stresses of the broadest of them, ten relaxation times over ten decades, at four
# speeds:
stresses = broad_stresses()
