"""Motions of any two bodies, free or under force, torque, brake and prescribed speeds: Eq. (22) with what drives it.

    V' = Q - M_half_space + f      j omega' = -Q - M_cylinder + q      tau = gamma t

:mod:`rates`, the equations in full and in partial slip, as panels ask for them; :mod:`records`, what is handed on;
:mod:`load`, the drive at a time; :mod:`collocation`, :mod:`nodes`, what a panel of time holds; :mod:`guess`, where its
solution begins; :mod:`solve`, a panel; :mod:`origin`, what follows V = omega = 0; :mod:`events`, where a regime ends;
:mod:`steady`, an equilibrium to the end of its drive; :mod:`phase`, panel after panel in one regime; :mod:`switch`,
what follows; :mod:`output`; :mod:`integrate`, from regime to regime; :mod:`loop`, what Python calls.
"""
