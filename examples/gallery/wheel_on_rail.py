# %% [markdown]
# # Wheel on rail
# A wheel of 460 mm on a rail crowned by 300 mm, 80 kN: by symmetry a quarter of a block with both bodies'
# compliance, on which a rigid shape presses. Hertz' ellipse has half-axes and a largest pressure from elliptic
# integrals.
# %%
import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

import signorini as sg

E, nu, load = 210e3, 0.3, 80e3  # MPa, N
modulus, curve = E / (1 - nu**2) / 2, np.array([1 / 300, 1 / 460])  # of both bodies; across and along the rail, 1/mm


def ratio(k):
    """Of the curvatures that an ellipse with b / a = k belongs to (Johnson 1985, 4.28)."""
    e2 = 1 - k**2
    return (ellipe(e2) / k**2 - ellipk(e2)) / (ellipk(e2) - ellipe(e2)) - curve[0] / curve[1]


k = brentq(ratio, 0.3, 0.999)
e2 = 1 - k**2
a = (3 * load * ellipe(e2) / (np.pi * k**2 * modulus * curve.sum())) ** (1 / 3)
b = k * a
lines = np.concatenate([np.linspace(0, 1.2, 9), [1.6, 2.4, 4.0, 7.0, 12.0]])
mesh = sg.box(x=b * lines, y=a * lines, z=-a * lines[::-1])
model = sg.Model(
    mesh,
    bodies=[sg.Body("block", sg.Elastic(E=modulus * (1 - nu**2), nu=nu))],
    supports=[
        sg.Support("left", u=(0.0, None, None)),
        sg.Support("front", u=(None, 0.0, None)),
        sg.Support("bottom", u=(None, None, 0.0)),
    ],
    obstacles=[sg.Rigid("wheel", sg.Plane((0, 0, 0), (0, 0, -1)), u=(0, 0, None), force=(None, None, -load / 4))],
    contacts=[sg.Contact("top", "wheel", gap=f"{curve[0] / 2} * x^2 + {curve[1] / 2} * y^2", name="patch")],
    title="A wheel on a rail",
    units="mm, N, MPa",
)
solution = sg.solve(model)
print(solution)
# %%
patch = solution.contact("patch")
found, known, within = patch.pressure.max(), 1.5 * load / (np.pi * a * b), 0.04
figure, axes = plt.subplots(figsize=(5.6, 4.2), layout="constrained")
shown = axes.tricontourf(*patch.points[:, :2].T, patch.pressure, levels=12, cmap="viridis")
turn = np.linspace(0, np.pi / 2, 100)
axes.plot(b * np.cos(turn), a * np.sin(turn), color="white", ls="--", lw=1)
axes.set(xlim=(0, 1.2 * b), ylim=(0, 1.2 * a), aspect="equal", xlabel="across, mm", ylabel="along, mm")
axes.set(title=f"A quarter of the patch; dashed: Hertz, {known:.0f} MPa")
figure.colorbar(shown, label="pressure, MPa")
