"""Small dense systems of linear equations: LAPACK takes longer to prepare than to solve them."""

from __future__ import annotations

from ..compile.jit import kernel


@kernel
def eliminate(matrix, right):
    """Solve in place, without pivoting: what that spoils, Newton's convergence shows."""
    size = right.size
    for i in range(size):
        inverse = 1.0 / matrix[i, i]
        for row in range(i + 1, size):
            factor = matrix[row, i] * inverse
            for column in range(i + 1, size):
                matrix[row, column] -= factor * matrix[i, column]
            right[row] -= factor * right[i]
    for i in range(size - 1, -1, -1):
        total = right[i]
        for column in range(i + 1, size):
            total -= matrix[i, column] * right[column]
        right[i] = total / matrix[i, i]
