# %% [markdown]
# # Hip cup
# The head of a hip joint, 36 mm, presses with 2 kN on a liner of polyethylene of 3 mm in a metal cup, 0.1 mm wider:
# a conforming contact that Hertz does not know. A thin layer on a rigid back gives way under each point by itself,
# by `p t / E'` with `E' = E (1 - nu) / ((1 + nu) (1 - 2 nu))` (Bartel 1985).
# %%
import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

import signorini as sg

E, nu, head, play, thick, load = 800.0, 0.4, 18.0, 0.1, 3.0, 2e3  # MPa, mm, N
inner = head + play
model = sg.Model(
    sg.annulus(inner=inner, outer=inner + thick, n_radial=6, n_angular=45, angle=90.0),
    kind="axisymmetric",
    bodies=[sg.Body("ring", sg.Elastic(E=E, nu=nu))],
    supports=[sg.Support("outer", u=(0, 0)), sg.Support("end", u=(0, None))],
    obstacles=[sg.Rigid("head", sg.Circle((0, 0), head), u=(0, None), force=(None, load))],
    contacts=[sg.Contact("inner", "head", friction=0.05, name="liner")],
    title="A hip joint",
    units="mm, N, MPa",
)
solution = sg.solve(model)
print(solution)
# %%
stiff = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) / thick


def layer(angle, pushed):
    """Pressure of the layer under a head that is pushed in."""
    return stiff * np.maximum(pushed * np.cos(angle) - play * (1 - np.cos(angle)), 0.0)


def borne(pushed):
    """By the whole layer, along the axis."""
    return quad(lambda t: 2 * np.pi * inner**2 * layer(t, pushed) * np.cos(t) * np.sin(t), 0, np.pi / 2)[0]


pushed = brentq(lambda d: borne(d) - load, 1e-6, 1.0)
liner = solution.contact("liner")
angle = np.degrees(np.arctan2(liner.points[:, 0], liner.points[:, 1]))
found, known, within = liner.pressure.max(), layer(0.0, pushed), 0.1
figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
order, at = np.argsort(angle), np.linspace(0, 90, 181)
axes.plot(at, layer(np.radians(at), pushed), color="#333333", ls="--", lw=1, label="layer of columns")
axes.plot(angle[order], liner.pressure[order], "o-", ms=3, color="#1b4f8a", label="liner")
axes.set(
    xlabel="from the axis, degrees", ylabel="pressure, MPa", title=f"A head of 36 mm in its liner, {load / 1e3:g} kN"
)
axes.legend(frameon=False)
