"""What the kernels compute with: numbers, polynomials, roots."""
