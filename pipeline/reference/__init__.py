"""What is made once in many digits and kept in git: check values, check motions, the kernels' table of ratios."""
