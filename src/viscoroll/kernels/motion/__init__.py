"""Motions of any two bodies, free or under force, torque, brake and prescribed speeds: Eq. (22) with its drive.

    V' = Q - M_half_space + f      j omega' = -Q - M_cylinder + q      tau = gamma t

From the equations to the entry from Python:

- :mod:`records`: records, codes, columns of a segment of the drive; without numba
- :mod:`workspace`: rows of numbers at the nodes of a step
- :mod:`drive`: force, torque, brake and prescribed speed at a time
- :mod:`law`: the contact law at a state: rolling moments, creepage, slip, added mass
- :mod:`rhs`: right-hand side in full and in partial slip, with its derivatives; the forces that act
- :mod:`collocation`: Radau IIA nodes, matrices, dense output
- :mod:`predictor`, :mod:`step`, :mod:`error_estimate`, :mod:`step_control`: one step by Newton's iteration, the values
  that it starts from, its error, its length
- :mod:`events`: event functions and their location
- :mod:`departure_from_rest`, :mod:`regimes`: what follows V = omega = 0, and what follows an event
- :mod:`asymptotics`: equilibrium and exponential decay in closed form
- :mod:`output`: outputs and quadratures of accepted steps
- :mod:`regime_solver`, :mod:`driver`: integration within one regime, and from regime to regime
- :mod:`batch`: all motions of a batch
"""
