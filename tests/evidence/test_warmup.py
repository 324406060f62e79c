"""``viscoroll warmup``: what it compiles is all that calls need."""

import re

from processes import printed

#: public calls of all kinds, of other shapes and kinds of input than in the warm-up
CALLS = """
V = np.linspace(-2.0, 2.0, 5000)
vr.contact(scene, 0.3, omega=0.31, slopes=True)
vr.contact(scene, V[::2], omega=0.3, fields=("Q", "M"))
vr.contact(scene, V, delta=1e-3)
vr.contact(scene, V[:70], delta=1e-3, method="direct")
vr.stress(scene, np.linspace(-1.0, 1.0, 5), 0.3, delta=1e-3)
vr.roll(scene, 1.5, 0.5, np.linspace(0.0, 1e-3, 9), rest=1e-6).contact()
vr.ensemble(scene.replace(mu=np.array([0.1, 0.2])), 1.5, [0.5, 0.6], [1e-4], method="integrate")
vr.ensemble(scene, 1.5, [0.5, 0.6], [1e-4], fields=("V", "slip_loss", "rolling_loss"), method="integrate")
vr.ensemble(scene.replace(kappa=7.1), np.linspace(0.1, 0.5, 20), 0.0, [1e-4], method="flow", rest=1e-4)
vr.tables.build(scene, V[-3:], delta=V[-3:], alpha=[1.0, 11.0])
vr.tables.law(vr.Prony([1.0, 2.0, 3.0], [1.0, 0.1, 0.01]))
scene.validity(V[:3])
vr.steady(scene, slope=V[:9] / 9.0)
vr.steady(scene.replace(mu=np.array([0.1, 0.2])), force=0.01, torque=vr.Feedback(0.0, V=-0.1, omega=-0.2))
pair = vr.Bodies(vr.Prony([1.0], [1.0]), vr.Prony([2.0], [0.1]), 0.4)
vr.steady(vr.Scene(material=pair, kappa=3.0, mu=0.1), V=V[:3], force=0.0)
vr.resistance_extrema(scene)
two = vr.Bodies(vr.Prony([3.0], [2.0]), vr.Prony([1.0, 4.0, 2.0], [1.0, 0.1, 1e-3]), 0.2)
for law in (two, two.total):
    each = vr.Scene(material=law, kappa=9.0, mu=0.2)
    vr.contact(each, V[:9], omega=0.1, slopes=True)
    vr.contact(each, V, omega=0.1, fields=("M_half_space", "Q", "N"))
    each.validity(V[:3])
many = vr.Prony([[1.0, 2.0], [2.0, 1.0]], [1.0, 0.1])
for law in (many, vr.Bodies(many, vr.Prony([3.0], [2.0]), 0.3)):
    each = vr.Scene(material=law, kappa=9.0, mu=0.2, gamma=1.0, coupled=False)
    vr.ensemble(each, [1.0, 1.5], 0.5, [1e-3], fields=("V", "slip_loss"))
    vr.ensemble(each, [1.0, 1.5], 0.5, [1e-3], force=0.01)
    vr.stress(each, 0.1, 0.3, delta=1e-3)
vr.contact(scene, V, delta=0.0, fields="N")
cover = vr.Scene(material=vr.Cover(many[0], nu=0.3, thickness=0.5, on="base"), kappa=9.0, mu=0.2, gamma=1.0)
vr.contact(cover, V, omega=0.1, slopes=True)
vr.ensemble(cover, [1.0, 1.5], 0.5, [1e-3], force=0.01, fields=("V", "slip_loss"))
vr.steady(cover, V=V[:3], force=0.0)
vr.law(cover)(0.1, 0.2)
vr.ensemble(cover.replace(material=vr.Cover(1.0, nu=0.5, thickness=[0.5, 0.6]), coupled=False), 1.0, 0.5, [1e-3])
"""  # noqa: E501
CODE = f"""
import importlib
import numpy as np
import viscoroll as vr
from viscoroll.cli import main
from viscoroll.kernels.numerics.jit import KERNELS as folder
assert main(["warmup"]) == 0
modules = [
    importlib.import_module(f"viscoroll.kernels.{{path.parent.name}}.{{path.stem}}")
    for path in folder.glob("*/[!_]*.py")
]
def ready():
    kernels = {{each for module in modules for each in vars(module).values() if hasattr(each, "overloads")}}
    return {{(each.py_func.__name__, arguments) for each in kernels for arguments in each.overloads}}
before = ready()
scene = vr.presets.PAPER_SECTION_5
{CALLS}
print("anew:", *sorted(name for name, _ in ready() - before))
"""  # noqa: E501


def test_after_it_no_call_compiles():
    told, anew = printed(CODE).splitlines()
    assert re.fullmatch(
        r"functions are compiled for \d+ kinds of calls \(this took \d+\.\d s\); cache folder: .+",
        told,
    )
    assert anew == "anew:"
