"""The contact law: explicit in (zeta, eta), its inverses, its slopes, the stresses, and arrays of states."""
