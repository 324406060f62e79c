"""Memory that large calls need beside their input and their result -> data/results/large.json (kept
in git).

    python -m pipeline.evidence.measure.large [--config FILE] [--quick] [-o FILE]

Each call runs in a process of its own, whose peak is read from the system.  Numbers of elements are
in [large] of the configuration; 10^8 motions want 8 GB.  pipeline/evidence/document/ puts the table
into docs/times.md.
"""

import sys

from ...stage import Row
from ..results import run
from ..timing import printed

#: calls on vectors x and y of n elements, or on a grid of n of them; ``alphas`` is a scene with an
#: alpha for each
CALLS = {
    "one by one": "vr.contact(alphas, x, delta=y, fields='Q')",
    "slice": "vr.contact(scene, x, omega=y, fields=('Q', 'M'))",
    "grid": "vr.contact(scene, x[:side, None], delta=y[:side], fields=('Q', 'M'))",
    "slopes": "vr.contact(scene, x, delta=0.01, fields=(), slopes=True)",
    "stress": "vr.stress(scene, x, 1.0, delta=0.01)",
    "flow map": "vr.ensemble(scene, x, y, 3e-3)",
    "integrated": "vr.ensemble(scene, x, y, 1e-9, method='integrate')",
}
_CHILD = """
scene = vr.presets.PAPER_SECTION_5
def own(result, *given):  # what the result holds, each array once, without the arrays that were given
    values = result.as_dict() if hasattr(result, "as_dict") else vars(result)
    whole = {}
    for value in values.values():
        if isinstance(value, np.ndarray):
            while isinstance(value.base, np.ndarray):
                value = value.base
            whole[id(value)] = value
    return sum(array.nbytes for key, array in whole.items() if key not in map(id, given))
def run(n):
    side, alphas = round(n**0.5), scene.replace(alpha=np.resize([10.0, 11.0], n))
    x, y = np.linspace(0.1, 2.0, n), np.linspace(-0.01, 0.5, n)
    before, start = memory("VmRSS"), time.perf_counter()
    result = CALL
    seconds, after = time.perf_counter() - start, memory("VmRSS")
    held = min(own(result, x, y), after - before)  # pages of zeros take memory when they are first written
    return {"seconds": seconds, "result_bytes": own(result, x, y), "extra_bytes": memory("VmHWM") - before - held}
run(10_000)  # compiles, and builds the map
print(json.dumps(run(*given)))
"""  # noqa: E501


def measured(name: str, count: int) -> Row:
    """Seconds, bytes of the result, and bytes at the peak beside it and the input."""
    return {"call": CALLS[name], "elements": count} | printed(
        _CHILD.replace("CALL", CALLS[name]), count
    )


def measure(sizes):
    """All calls."""
    return {
        "rows": [
            measured(name, sizes["integrated" if name == "integrated" else "elements"])
            for name in CALLS
        ]
    }


if __name__ == "__main__":
    sys.exit(run("large", measure, __doc__))
