"""
A start with wheel spin
=======================

A motor raises its torque in a ramp.  Beyond (1 + j) mu times load and radius the contact
cannot hold it: the wheel spins, until the throttle is let go and the wheel grips again.
Full slip is shaded.
"""

from viscoroll.figures import wheel_spin

figure = wheel_spin()
