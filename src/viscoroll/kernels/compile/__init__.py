"""How kernels are compiled: decorator, disk cache, compilation of a kernel with all that it calls, and intrinsics."""
