# %% [markdown]
# # Dovetail
# The root of a blade is pulled against the flanks of its slot, at 45 degrees, by centrifugal force: half of it, by
# symmetry. It slides up the flank, which bears `N = F / (2 (cos(45) + mu sin(45)))`; when the force is taken back
# it sticks first, and the flank keeps what it bore: on the way down it bears more for the same force.
# %%
import matplotlib.pyplot as plt
import numpy as np

import signorini as sg

mu, pull = 0.15, 8e3  # N per mm of the disc; mm
heights = np.concatenate([np.linspace(-8, -2, 4), np.linspace(-1.2, 8, 13), np.linspace(10, 20, 5)])
widths = np.interp(heights, [-8, -2, 8, 20], [14, 14, 4, 4])
grid = sg.rectangle(nx=10, ny=len(heights) - 1)
row = np.rint(grid.points[:, 1] * (len(heights) - 1)).astype(int)
points = np.column_stack([grid.points[:, 0] * widths[row], heights[row]])
right = grid.facets("right")[0]
flank = right[((points[right, 1] >= -2.0) & (points[right, 1] <= 8.0)).all(axis=1)]
mesh = sg.Mesh(points=points, cells=grid.cells, bodies=grid.bodies, boundaries={**grid.boundaries, "flank": flank})
slot = sg.Plane(point=(4.0, 8.0), normal=(-1.0, -1.0))
model = sg.Model(
    mesh,
    bodies=[sg.Body("block", sg.Elastic(E=110e3, nu=0.33))],
    supports=[sg.Support("left", u=(0.0, None))],
    loads=[sg.Load("top", force=(None, pull / 2), name="pull")],
    contacts=[sg.Contact("flank", slot, friction=mu, name="flank")],
    steps=[sg.Step(name="up and down", scale={"pull": [1.0, 0.25, 1.0]})],
    title="A dovetail",
    units="mm, N, MPa",
)
solution = sg.solve(model)
print(solution)
# %%
moments = solution.last.instants
pulls = np.array([pull * moment.factors["pull"] for moment in moments]) / 1e3
borne = np.array([(c.pressure * c.area).sum() for c in (moment.contacts[0] for moment in moments)]) / 1e3
side = np.sqrt(0.5)
found, known, within = borne[pulls.argmax()], pull / 2e3 / (side + mu * side), 0.01
figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
axes.plot(pulls, borne, "o-", ms=3, color="#1b4f8a", label="flank")
for sign, words in ((1, "sliding up"), (-1, "sliding down")):
    axes.plot(
        pulls, pulls / (2 * side * (1 + sign * mu)), color="#333333", ls="--" if sign > 0 else ":", lw=1, label=words
    )
axes.set(xlabel="pull, kN per mm", ylabel="flank bears, kN per mm", title="What goes up sticks before it comes down")
axes.legend(frameon=False)
