"""
Braked through V = 0
====================

A torque against the motion brakes the cylinder, stops it, and sends it back.  V and omega
pass zero with a kink only. The traction Q jumps, because the stick zone forms anew at what
is now the front.
"""

from viscoroll.figures import reversal

figure = reversal()
