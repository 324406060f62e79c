"""How kernels are compiled: the decorator and its cache, arithmetic in one rounding."""
