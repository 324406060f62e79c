"""The flow map of one scene: tables of its motions, and kernels that look motions up in them."""
