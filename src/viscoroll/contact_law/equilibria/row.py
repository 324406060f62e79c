"""Rows of what is found of states, in a frame where V > 0: the answers are of Q to V and omega, of moments to V.

In place of the answers :class:`.result.States` have omega and the eigenvalues, fast and slow, with the imaginary part.
"""

V, DELTA, Q, M_HALF_SPACE, M_CYLINDER, BETA, DQ_DV, DQ_DOMEGA, DM_HALF_SPACE, DM_CYLINDER = range(10)
OMEGA, FAST, SLOW, IMAGINARY = range(6, 10)
