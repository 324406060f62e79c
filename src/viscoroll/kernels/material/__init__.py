"""A material as the contact law sees it: g, h, m and b of z, and their slopes.

:mod:`functions`, which all other rooms call, whatever the material; :mod:`standard`, one relaxation time, by Bessel
ratios; :mod:`series`, several; :mod:`tabulated`, either of them by polynomials in bins, and :mod:`fill`, what these are
made from; :mod:`pair`, two bodies that differ; :mod:`each`, a series or a pair for each state or motion.
"""
