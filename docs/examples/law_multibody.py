"""Two rollers on a rope: a tractor at constant speed pulls one, and that one the next, by springs
with dampers.

Once the train runs smoothly, every rope carries the rolling resistance of all rollers behind it: M
of both, M of the last.  The last is of the same rubber, but colder, where its modes are slower.
"""

import numpy as np
from scipy.integrate import solve_ivp

import viscoroll as vr

warm = vr.presets.RUBBER_ROLLER
cold = warm.replace(material=warm.material.slower(10.0))
laws, gamma, j = (
    [vr.law(scene) for scene in (warm, cold)],
    warm.gamma,
    warm.j,
)
speed = 0.5  # of the tractor
stiffness, damping = 0.02, 0.05  # force over P, by distance and by speed


def rates(t, y):
    """Of stretches, speeds and angular velocities."""
    stretch, V, omega = y.reshape(3, -1)
    closing = np.append(speed, V[:-1]) - V
    rope = stiffness * stretch + damping * closing
    # of the rope ahead less that of the one behind
    pull = rope - np.append(rope[1:], 0.0)
    Q, _, M_half_space, M_cylinder = np.transpose(
        [law(*state) for law, *state in zip(laws, V, omega)]
    )
    return np.concatenate(
        [
            closing,
            gamma * (Q - M_half_space + pull),
            gamma / j * (-Q - M_cylinder),
        ]
    )


def jacobian(t, y):
    """Of all rates: the ropes are linear, the law knows its slopes."""
    _, V, omega = y.reshape(3, -1)
    n = V.size
    f = [law(*state, slopes=True) for law, *state in zip(laws, V, omega)]
    dQ_dV, dQ_domega, dM_half_space, dM_cylinder = np.transpose(f)[4:8]
    one, to_rope = np.eye(n), np.eye(n) - np.eye(n, k=1)  # of the pull
    to_V = -to_rope.T  # of the closing speeds
    return np.block(
        [
            [0.0 * one, to_V, 0.0 * one],
            [
                gamma * stiffness * to_rope,
                gamma
                * (
                    np.diag(dQ_dV - dM_half_space)
                    + damping * to_rope @ to_V
                ),
                gamma * np.diag(dQ_domega),
            ],
            [
                0.0 * one,
                -gamma / j * np.diag(dQ_dV + dM_cylinder),
                -gamma / j * np.diag(dQ_domega),
            ],
        ]
    )


# ropes; speeds; angular velocities
slack = np.array([0.0, 0.0, 0.1, 0.1, 0.1, 0.1])
found = solve_ivp(
    rates, (0.0, 20.0), slack, "Radau", jac=jacobian, rtol=1e-8, atol=1e-10
)
stretch, V, omega = found.y[:, -1].reshape(3, -1)
print(f"forces in the ropes {stiffness * stretch}, speeds {V}")
