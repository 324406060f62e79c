"""What every room stands on: errors, checks, units, results and their labels, files, plots."""
