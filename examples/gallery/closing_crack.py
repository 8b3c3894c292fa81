# %% [markdown]
# # Closing crack
# A crack that was cut 0.01 mm wide closes as the plate is compressed: at first it is open and takes nothing, and
# its faces come together by `4 (1 - nu^2) sigma / E sqrt(b^2 - x^2)`, until they touch in the middle first: at the
# load at which that is the width.
# %%
import matplotlib.pyplot as plt
import numpy as np

import signorini as sg

E, nu, half, width = 210e3, 0.3, 1.0, 0.01  # MPa, mm
known, within = E * width / (4 * (1 - nu**2) * half), 0.03
beside = np.geomspace(1.02, 12.0, 14)
x = np.concatenate([-beside[::-1], np.linspace(-1, 1, 41), beside])
y = np.concatenate([[0.0], np.geomspace(0.05, 12.0, 16)])
halves = {"upper": sg.rectangle(x=x, y=y), "lower": sg.rectangle(x=x, y=-y[::-1])}


def split(mesh, side):
    """The side along the crack in two: inside and beyond its tips."""
    edges = mesh.facets(side)[0]
    place = np.abs(mesh.points[edges, 0])
    inside, beyond = (place <= half + 1e-9).all(axis=1), (place > half + 1e-9).all(axis=1)
    sides = {**mesh.boundaries, "crack": edges[inside], "plate": edges[beyond]}
    return sg.Mesh(points=mesh.points, cells=mesh.cells, bodies=mesh.bodies, boundaries=sides)


mesh = sg.join({"upper": split(halves["upper"], "bottom"), "lower": split(halves["lower"], "top")})
model = sg.Model(
    mesh,
    bodies=[sg.Body(name, sg.Elastic(E=E, nu=nu)) for name in halves],
    supports=[sg.Support("lower.bottom", u=(0, 0))],
    loads=[sg.Load("upper.top", traction=(0.0, -1.5 * known))],
    contacts=[
        sg.Contact("upper.crack", "lower.crack", friction=0.3, gap=width, name="crack"),
        sg.Contact("upper.plate", "lower.plate", friction="tied", name="plate"),
    ],
    steps=[sg.Step(at=6)],
    title="A crack that closes",
    units="mm, N, MPa",
)
solution = sg.solve(model)
print(solution)
# %%
first = next(event for event in solution.last.events if event.contact == "crack" and event.what == "closes")
found = 1.5 * known * first.load_factor
figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
for moment in [moment for moment in solution.last.instants if moment.what == "asked"]:
    crack = moment.contacts[0]
    order = np.argsort(crack.points[:, 0])
    axes.plot(crack.points[order, 0], 1e3 * crack.gap[order], label=f"{1.5 * known * moment.load_factor:.0f} MPa")
axes.set(xlabel="along the crack, mm", ylabel="gap, um", title="A crack of 2 mm closes from the middle")
axes.legend(frameon=False, ncols=2)
