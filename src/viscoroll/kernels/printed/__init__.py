"""The law as the paper prints it, by root solves with Bessel functions of its own: what the others are held against."""
