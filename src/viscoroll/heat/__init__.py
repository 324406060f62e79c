"""Heat of rolling: the temperatures at which a roller runs, its warming, and the limits that heat
sets.
"""
