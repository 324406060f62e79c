"""Motions of any two bodies, free or under force, torque, brake and prescribed speeds: Eq. (22)
with its drive.

    V' = Q - M_half_space + f      j omega' = -Q - M_cylinder + q      tau = gamma t

A scene, a drive and a start enter :func:`driver.motion_loop` as records, and outputs leave in the
arrays of the caller.  From the equations to the entry from Python:

- :mod:`collocation`: Radau IIA nodes, matrices, dense output; rows of numbers at the nodes of a
  step
- :mod:`drive`: force, torque, brake and prescribed speed at a time
- :mod:`motion_law`: the contact law at a state: rolling moments, creepage, slip, added mass
- :mod:`rhs`: right-hand side in full and in partial slip, with its derivatives; the forces that act
- :mod:`step`, :mod:`step_control`: one step by Newton's iteration, its error, the next length
- :mod:`events`: event functions and their location
- :mod:`departure_from_rest`, :mod:`regimes`: what follows V = omega = 0, and what follows an event
- :mod:`asymptotics`: equilibrium and exponential decay in closed form
- :mod:`output`: outputs and quadratures of accepted steps
- :mod:`regime_solver`, :mod:`driver`: integration within one regime, from regime to regime, of many
- :mod:`flow_layout`, :mod:`flow_lookup`, :mod:`flow_loop`: free motions of one scene from its flow
  map
"""
