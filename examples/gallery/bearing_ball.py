# %% [markdown]
# # Bearing ball
# A steel ball of 10 mm is pressed on a flat race with 50 N: Hertz' point contact. Nobody says how fine the mesh has
# to be; an accuracy of two per cent of the pressure is asked for instead.
# %%
import matplotlib.pyplot as plt
import numpy as np

import signorini as sg

E, nu, radius, force = 210e3, 0.3, 5.0, 50.0  # N, mm; the ball is twice as stiff in Hertz' formulas: both are steel
modulus = E / (1 - nu**2) / 2
half_width = (3 * force * radius / (4 * modulus)) ** (1 / 3)
lines = half_width * np.array([0.0, 1.0, 2.5, 6.0, 14.0])
model = sg.Model(
    sg.rectangle(x=lines, y=-lines[::-1]),
    kind="axisymmetric",
    bodies=[sg.Body("block", sg.Elastic(E=modulus * (1 - nu**2), nu=nu))],
    supports=[sg.Support("left", u=(0.0, None)), sg.Support("bottom", u=(None, 0.0))],
    obstacles=[sg.Rigid("ball", sg.Circle((0.0, radius), radius), u=(0, None), force=(None, -force))],
    contacts=[sg.Contact("top", "ball", name="race")],
    title="A ball on a race",
    units="mm, N, MPa",
)
solution = sg.solve(model, accuracy=0.02)
print(solution)
# %%
contact = solution.contact("race")
found, known, within = contact.pressure.max(), 1.5 * force / (np.pi * half_width**2), 0.03
order = np.argsort(contact.points[:, 0])
r = np.linspace(0, half_width, 200)
figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
axes.plot(r, known * np.sqrt(1 - (r / half_width) ** 2), color="#333333", lw=1, label="Hertz")
axes.plot(contact.points[order, 0], contact.pressure[order], "o", ms=3, color="#1b4f8a", label="two per cent asked for")
axes.set(
    xlim=(0, 1.4 * half_width),
    xlabel="r, mm",
    ylabel="pressure, MPa",
    title=f"Asked for two per cent: {len(solution.model.mesh.points)} nodes",
)
axes.legend(frameon=False)
