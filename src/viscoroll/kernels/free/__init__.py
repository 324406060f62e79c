"""Eq. (22): one motion through every change of regime, and many."""
