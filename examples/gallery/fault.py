# %% [markdown]
# # Fault in rock
# A fault of 2 m in compressed rock, 20 degrees from the direction of 100 MPa: it is pressed by 11.7 MPa and slips,
# for friction with 30 degrees bears less than the shear. In an infinite body it slips by `4 (1 - nu^2) (tau - mu
# sigma) / E sqrt(b^2 - x^2)`.
# %%
import matplotlib.pyplot as plt
import numpy as np

import signorini as sg

E, nu, load, tilt, mu, half = 25e3, 0.25, 100.0, np.radians(20.0), np.tan(np.radians(30.0)), 1.0  # MPa, m
normal, shear = load * np.sin(tilt) ** 2, load * np.sin(tilt) * np.cos(tilt)
beside = np.geomspace(1.02, 12.0, 14)
x = np.concatenate([-beside[::-1], np.linspace(-1, 1, 41), beside])
y = np.concatenate([[0.0], np.geomspace(0.05, 12.0, 16)])
halves = {"upper": sg.rectangle(x=x, y=y), "lower": sg.rectangle(x=x, y=-y[::-1])}


def split(mesh, side):
    """The side along the fault in two: inside and beyond its tips."""
    edges = mesh.facets(side)[0]
    place = np.abs(mesh.points[edges, 0])
    inside, beyond = (place <= half + 1e-9).all(axis=1), (place > half + 1e-9).all(axis=1)
    sides = {**mesh.boundaries, "fault": edges[inside], "rock": edges[beyond]}
    return sg.Mesh(points=mesh.points, cells=mesh.cells, bodies=mesh.bodies, boundaries=sides)


mesh = sg.join({"upper": split(halves["upper"], "bottom"), "lower": split(halves["lower"], "top")})
ends = [
    sg.Load(f"{half}.{end}", traction=(0.0, sign * shear))
    for half in halves
    for end, sign in (("left", 1), ("right", -1))
]
model = sg.Model(
    mesh,
    bodies=[sg.Body(name, sg.Elastic(E=E, nu=nu)) for name in halves],
    supports=[sg.Support("lower.bottom", u=(0, 0))],
    loads=[sg.Load("upper.top", traction=(-shear, -normal)), *ends],
    contacts=[
        sg.Contact("upper.fault", "lower.fault", friction=mu, name="fault"),
        sg.Contact("upper.rock", "lower.rock", friction="tied", name="rock"),
    ],
    title="A fault in rock",
    units="MPa, m",
)
solution = sg.solve(model)
print(solution)
# %%
fault = solution.contact("fault")
found, known, within = 1e3 * np.abs(fault.slip).max(), 1e3 * 4 * (1 - nu**2) * (shear - mu * normal) * half / E, 0.03
order, at = np.argsort(fault.points[:, 0]), np.linspace(-1, 1, 201)
figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
axes.plot(at, known * np.sqrt(1 - at**2), color="#333333", lw=1, label="infinite body")
axes.plot(fault.points[order, 0], 1e3 * np.abs(fault.slip[order]), "o", ms=3, color="#c4451c", label="block of 24 m")
axes.set(xlabel="along the fault, m", ylabel="slip, mm", title="A fault of 2 m under 100 MPa")
axes.legend(frameon=False)
