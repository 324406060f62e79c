"""Materials: series, pairs of bodies, covers and files; and their laws as tables that kernels read."""
