"""
The example of the paper
========================

Sect. 5 of the paper throws a soft, slow cylinder in three ways; its Fig. 5 shows V and
omega.  A caveat: this is the exact solution of the paper's Eq. (22), but not the motion of
such a cylinder, which would rock in its own imprint (nu = 600, where the law of steady
rolling asks for less than 0.4; :doc:`/may_i`).
"""

from viscoroll.figures import figure_5, figure_6

figure = figure_5()

# %%
# The contact during the first of these motions: at the onset of stick the stick zone
# ``beta`` opens within a few ten-thousandths of T_epsilon, and the creep ``delta`` falls
# to nearly nothing.
contact = figure_6()
