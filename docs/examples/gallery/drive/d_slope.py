"""
What settles and what runs away
===============================

The plane (V, omega) on a slope of 3 degrees: all motions left of the orange line settle at
the stable speed (filled dot), all right of it run away.  The line ends in the unstable
speed (open dot).
"""

from viscoroll.figures import slope_portrait

figure = slope_portrait()
