"""Small dense systems of linear equations: LAPACK takes longer to prepare than to solve them."""

from __future__ import annotations

from ..compile.jit import kernel


@kernel(inline=True)
def factorize(matrix, count):
    """Two triangular factors in place of a matrix, without pivoting: what that spoils, Newton's convergence shows."""
    for i in range(count):
        inverse = 1.0 / matrix[i, i]
        for row in range(i + 1, count):
            share = matrix[row, i] * inverse
            matrix[row, i] = share
            for column in range(i + 1, count):
                matrix[row, column] -= share * matrix[i, column]


@kernel(inline=True)
def substitute(matrix, right, count):
    """Solve a linear system in place of its right side, from the factors of the matrix."""
    for row in range(1, count):
        total = right[row]
        for i in range(row):
            total -= matrix[row, i] * right[i]
        right[row] = total
    for i in range(count - 1, -1, -1):
        total = right[i]
        for column in range(i + 1, count):
            total -= matrix[i, column] * right[column]
        right[i] = total / matrix[i, i]
