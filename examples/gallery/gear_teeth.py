# %% [markdown]
# # Gear tooth pair
# Two steel spur gears touch at the pitch point, where their flanks have the radii `r sin(alpha)`: two cylinders of
# different size, whose meshes need not match. The load per width presses them as Hertz says; two per cent of the
# pressure are asked for.
# %%
import matplotlib.pyplot as plt
import numpy as np

import signorini as sg

E, nu, modulus = 210e3, 0.3, 210e3 / (1 - 0.3**2) / 2  # MPa
radii = np.array([30.0, 60.0]) * np.sin(np.radians(20.0))  # mm, of the flanks at the pitch point
pinion, wheel = (sg.half_disk(radius=radius, contact_length=0.8, contact_spacing=0.2) for radius in radii)
turned = sg.Mesh(points=wheel.points * [1, -1], cells=wheel.cells, bodies=wheel.bodies, boundaries=wheel.boundaries)
model = sg.Model(
    sg.join({"pinion": pinion, "wheel": turned}),
    bodies=[sg.Body(name, sg.Elastic(E=E, nu=nu)) for name in ("pinion", "wheel")],
    supports=[sg.Support("wheel.cut", u=(0, 0)), sg.Support("pinion.cut", u=(0, -0.02))],
    contacts=[sg.Contact("pinion.arc", "wheel.arc", friction=0.05, name="flanks")],
    title="A tooth of a pinion on that of a wheel",
    units="mm, N, MPa",
)
solution = sg.solve(model, accuracy=sg.Accuracy(0.02, nodes=40_000))
print(solution)
# %%
contact = solution.contact("flanks")
load, radius = contact.normal_force[1], 1 / (1 / radii).sum()
found, known, within = contact.pressure.max(), np.sqrt(load * modulus / (np.pi * radius)), 0.02
half_width = 2 * np.sqrt(load * radius / (np.pi * modulus))
order, x = np.argsort(contact.points[:, 0]), np.linspace(-half_width, half_width, 201)
figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
axes.plot(x, known * np.sqrt(1 - (x / half_width) ** 2), color="#333333", lw=1, label="Hertz")
axes.plot(contact.points[order, 0], contact.pressure[order], "o", ms=3, color="#1b4f8a", label="two meshes")
axes.set(xlim=(-1.3 * half_width, 1.3 * half_width), xlabel="along the flank, mm", ylabel="pressure, MPa")
axes.set(title=f"{load:.0f} N per mm of width")
axes.legend(frameon=False)
