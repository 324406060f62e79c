"""Eqs. (5)-(18) and steady rolling for arrays of states, and how far they hold."""
