"""Measurements: text files, dynamic mechanical analysis, and parameters of a cylinder.

Files enter through :mod:`.text_table`, :func:`.dma_reader.read_dma` and
:func:`.identify.read_measurements`.  :mod:`.fit_series` fits a Prony series to measured moduli,
:mod:`.identify` fits parameters of a cylinder to its resistance, traction and coast-down.  Results
leave as :class:`viscoroll.Fit` and :class:`.identification_result.Identification`.
"""
