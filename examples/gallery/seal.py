# %% [markdown]
# # Seal
# A rubber O-ring of 4 mm, long enough to be plane, is squeezed between two plates by a twentieth of its thickness.
# Rubber keeps its volume, so that its cells have a mean dilatation. A cylinder between two plates is squeezed by `2
# F / (pi E') (2 ln(4 R / a) - 1)` (Johnson 1985, 5.57), `a` the half-width of Hertz.
# %%
import matplotlib.pyplot as plt
import numpy as np

import signorini as sg

E, diameter, squeeze = 3.0, 4.0, 0.05  # MPa, mm
model = sg.Model(
    sg.quarter_disk(radius=diameter / 2, contact_length=0.9, contact_spacing=0.05),
    bodies=[sg.Body("disk", sg.Elastic(E=E, nu=0.4995), formulation="mean dilatation")],
    supports=[sg.Support("axis", u=(0.0, None)), sg.Support("cut", u=(None, -squeeze * diameter / 2), name="squeeze")],
    contacts=[sg.Contact("arc", sg.Plane((0, 0), (0, 1)), friction=0.2, name="plate")],
    steps=[sg.Step(name="squeeze", at=10)],
    title="An O-ring",
    units="mm, N, MPa",
)
solution = sg.solve(model)
print(solution)
# %%
squeezed = squeeze * np.array([moment.load_factor for moment in solution.last.instants])
forces = np.array([2 * moment.contacts[0].normal_force[1] for moment in solution.last.instants])
modulus = E / (1 - 0.4995**2)
half_widths = np.sqrt(2 * diameter * np.maximum(forces, 1e-12) / (np.pi * modulus))
johnson = 2 * forces / (np.pi * modulus) * (2 * np.log(2 * diameter / half_widths) - 1) / diameter
found, known, within = squeezed[-1], johnson[-1], 0.03
figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
axes.plot(100 * squeezed, forces, color="#1b4f8a", label="small strain, friction 0.2")
axes.plot(100 * johnson, forces, color="#333333", ls="--", lw=1, label="Johnson")
axes.set(xlabel="squeezed by, % of the thickness", ylabel="force, N per mm", title="An O-ring of 4 mm")
axes.legend(frameon=False)
