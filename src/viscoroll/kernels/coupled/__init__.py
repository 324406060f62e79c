"""Boundary elements of steady rolling in which pressure and shear act on each other.

elements   mesh of a contact, matrices of the slopes that piecewise linear tractions cause, moments
zones      the linear system of one contact, and its zones of stick and slip
loop       states of one row: contact length of a load, edge of the stick zone, powers
"""
