"""Materials: their series, pairs of bodies, files, and the tables that kernels read."""
