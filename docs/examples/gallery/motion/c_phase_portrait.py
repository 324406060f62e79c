"""
Phase portrait
==============

Every motion has two parts.  While all of the contact slips (grey) friction brings rim and
axis together, and V + j omega hardly changes.  Then the motion turns onto one common
curve, the slow manifold, and creeps along it towards rest.
"""

from viscoroll.figures import phase_portrait

figure = phase_portrait()

# %%
# Right: the difference omega - V a thousand times enlarged.  The band of partial slip,
# which the left panel cannot show, is a few thousandths of V wide.
