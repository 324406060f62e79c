"""Defects planted in the kernels, and whether the tests notice."""
