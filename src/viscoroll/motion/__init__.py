"""Motion of the cylinder, Eq. (22): one, or an ensemble of many."""
