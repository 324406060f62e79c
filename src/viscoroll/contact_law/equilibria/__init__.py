"""Steady rolling under load: all equilibria, and the rolling resistance over speed that determines them."""
