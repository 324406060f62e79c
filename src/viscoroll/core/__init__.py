"""Foundations of all layers: errors, checks, units, results and their labels, files, figures."""
