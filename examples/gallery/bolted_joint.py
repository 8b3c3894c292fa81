# %% [markdown]
# # Bolted joint
# A bolt is tightened to 10 kN and locked, then the joint is pulled apart. As long as the plates touch the bolt
# takes its share by stiffness, `k_bolt / (k_bolt + k_plates)`, and from where they part all of it: the joint
# diagram of VDI 2230, exactly.
# %%
import matplotlib.pyplot as plt
import numpy as np

import signorini as sg

E, tight, pull, length = 210e3, 10e3, 24e3, 40.0  # N, mm; a slice of 10 mm
widths = {"bolt": 6.0, "plates": 12.0}
mesh = sg.join(
    {
        "bolt": sg.rectangle(x=[0, 3, 6], y=np.linspace(0, length, 9)),
        "plates": sg.rectangle(x=[8, 14, 20], y=np.linspace(0, length, 9)),
    }
)
mesh = sg.cut(mesh, "section", body="bolt", point=(0, length / 2), normal=(0, 1))
tops = [("bolt.top", "y", 1.0), ("plates.top", "y", -1.0)]  # the head: both ends move as one
model = sg.Model(
    mesh,
    kind="plane stress",
    thickness=10.0,
    bodies=[sg.Body(name, sg.Elastic(E=E, nu=0.0)) for name in widths],
    supports=[sg.Support("bolt.bottom", u=(0, 0)), sg.Support("plates.right", u=(0, None))],
    equations=[sg.Equation(tops)],
    bolts=[sg.Bolt("section", force=tight, name="bolt")],
    loads=[sg.Load("bolt.top", force=(None, pull), spread="displacement", name="pull")],
    contacts=[sg.Contact("plates.bottom", sg.Plane((0, 0), (0, 1)), name="joint")],
    steps=[
        sg.Step(name="tighten", scale={"bolt": 1.0, "pull": 0.0}),
        sg.Step(name="lock", scale={}, hold=["bolt"]),
        *(sg.Step(name=f"pull {k}", scale={"pull": k / 8}) for k in range(1, 9)),
    ],
    title="A bolted joint",
    units="mm, N, MPa",
)
solution = sg.solve(model)
print(solution)
# %%
pulls = np.array([0, *np.arange(1, 9)]) * pull / 8e3
forces = np.array([step.bolts["bolt"].force for step in solution.steps[1:]]) / 1e3
share = widths["bolt"] / sum(widths.values())
diagram = np.maximum(tight / 1e3 + share * pulls, pulls)
found, known, within = forces[3], diagram[3], 1e-9
figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
axes.plot(pulls, diagram, color="#333333", lw=1, label="springs")
axes.plot(pulls, forces, "o", ms=4, color="#1b4f8a", label="force of the bolt")
axes.plot(pulls, pulls, color="#bbbbbb", ls="--", lw=1, label="plates apart")
axes.set(xlabel="pull, kN", ylabel="force of the bolt, kN", title="A locked bolt takes a third until the plates part")
axes.legend(frameon=False)
