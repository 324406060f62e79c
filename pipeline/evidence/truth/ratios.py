"""Stage 0: fit the Bessel ratios -> src/viscoroll/kernels/law/ratios.npy (kept in git).

    python -m pipeline.evidence.truth.ratios [-o FILE]

r = I1/I0, k = K0/K1 and i2 = I2/I0 are evaluated with 60 digits at the Chebyshev
points of every bin of the layout, interpolated there, and rounded to double once, as
monomials about the centre of the bin.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import flint
import numpy as np
from flint import arb
from tqdm import tqdm

from viscoroll.core.files import replace_file
from viscoroll.kernels.law import bessel_ratios

from .enclosures import ratio_i2, ratio_k, ratio_r

TARGET = Path(__file__).parents[3] / "src/viscoroll/kernels/law/ratios.npy"
NODES = bessel_ratios.COEFFICIENTS + 1

#: 60 digits: the highest orders are 1e-26 of the values
BITS = 200
EVALUATE = {
    "r(x)/x": lambda x: ratio_r(x) / x,
    "x (1 - r(x))": lambda x: x * (1 - ratio_r(x)),
    "k(z)/z": lambda z: ratio_k(z) / z,
    "z (1 - k(z))": lambda z: z * (1 - ratio_k(z)),
    "i2(x)/x^2": lambda x: ratio_i2(x) / x**2,
}


def chebyshev_fit(values: list[arb], half_width: arb) -> list[arb]:
    """Monomial coefficients in t of the truncated Chebyshev series on |t| <= half_width."""
    angles = [(2 * i + 1) * arb.pi() / (2 * len(values)) for i in range(len(values))]
    whole = flint.arb_poly([0])
    t = flint.arb_poly([0, 1 / half_width])
    polynomials = [flint.arb_poly([1]), t]
    for n in range(bessel_ratios.COEFFICIENTS):
        coefficient = sum(v * (n * a).cos() for v, a in zip(values, angles, strict=True)) / len(
            values
        )
        whole += polynomials[n] * (coefficient * (1 + (n > 0)))
        polynomials.append(2 * t * polynomials[-1] - polynomials[-2])
    return whole.coeffs()


def table() -> list[float]:
    """Coefficients of every bin of every segment, in table order."""
    found: list[float] = []
    with flint.ctx.workprec(BITS):
        half_width = arb(1) / (2 * bessel_ratios.BINS)
        points = [half_width * ((2 * i + 1) * arb.pi() / (2 * NODES)).cos() for i in range(NODES)]
        octaves = [
            (each.function, n)
            for each in bessel_ratios.SEGMENTS
            for n in range(each.low, each.high)
        ]
        for function, octave in tqdm(octaves, "octaves", leave=False):
            for index in range(bessel_ratios.BINS):
                centre = 1 + (2 * index + 1) * half_width
                values = [
                    EVALUATE[function](((centre + t) * arb(2) ** octave).mid()) for t in points
                ]
                found += map(float, chebyshev_fit(values, half_width))
    return found


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("-o", "--output", type=Path, default=TARGET)
    output = parser.parse_args().output
    with replace_file(output) as temporary:
        np.save(temporary, np.array(table()))


if __name__ == "__main__":
    main()
