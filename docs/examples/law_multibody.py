"""Two rollers on ropes: a tractor at constant speed pulls the first roller, and the first roller
pulls the second one.  Each rope is a spring with a damper.

When the speeds have become constant, the force in each rope equals the rolling resistance of all
rollers behind it: the first rope pulls both rollers, the second rope the second roller.  The second
roller is of the same rubber, but colder, so its relaxation times are ten times longer.
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
speed = 0.5  # of the tractor, dimensionless
# force divided by P, per distance and per speed
stiffness, damping = 0.02, 0.05


def rates(t, y):
    """Rates of the stretches of the ropes, of V and of omega."""
    stretch, V, omega = y.reshape(3, -1)
    closing = np.append(speed, V[:-1]) - V
    rope = stiffness * stretch + damping * closing
    # force of the rope ahead minus force of the rope behind
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
    """Derivatives of the rates.  The ropes are linear; the law gives its own derivatives."""
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


# initial values: stretches of the ropes; V; omega
slack = np.array([0.0, 0.0, 0.1, 0.1, 0.1, 0.1])
found = solve_ivp(
    rates, (0.0, 20.0), slack, "Radau", jac=jacobian, rtol=1e-8, atol=1e-10
)
stretch, V, omega = found.y[:, -1].reshape(3, -1)
print(f"forces in the ropes {stiffness * stretch}, speeds {V}")
