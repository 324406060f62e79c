"""Validity: which assumptions of the model a state or a motion violates, and the warnings of them."""
