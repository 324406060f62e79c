"""Commands, functional mock-up units, materials and parameters from measurements."""
