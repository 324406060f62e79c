"""Heat of rolling: temperatures of a roller, its warming, and the limits of load and speed."""
