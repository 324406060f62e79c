"""SI units: what a :class:`viscoroll.Cylinder` takes and gives, by way of the dimensionless scene."""
