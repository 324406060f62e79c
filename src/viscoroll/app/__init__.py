"""What stands on all the rest: the command line, validation, functional mock-up units, parameters from measurements."""
