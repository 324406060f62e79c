"""Rows of what is found of states, in a frame where V > 0: the answers are of Q to V and omega, of moments to V."""

V, DELTA, Q, M_HALF_SPACE, M_CYLINDER, BETA, DQ_DV, DQ_DOMEGA, DM_HALF_SPACE, DM_CYLINDER = range(10)
