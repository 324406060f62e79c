"""The law of a material as rows of polynomials: evaluation by modes, fit, layout, tables, files."""
