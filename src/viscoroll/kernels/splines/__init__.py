"""Tensor splines of grids, evaluated one point at a time: values with slopes, and the law of a grid at one alpha."""
