# %% [markdown]
# # Press fit
# A hub is shrunk on a hollow shaft, pulled along its axis, and then twisted until it lets go. Friction has one
# bound for both: the torque at which the fit slides all along is `T = R sqrt((mu F)^2 - N^2)`, with the force F of
# the fit and the pull N.
# %%
import matplotlib.pyplot as plt
import numpy as np

import signorini as sg

mu, seat, pull, angle = 0.15, 25.0, 8e3, 0.8e-3  # mm, N; a turn that is more than the fit bears
shaft = sg.rectangle(x=[15, 18, 21, 23, seat], y=np.linspace(-20, 20, 11))
hub = sg.rectangle(x=[seat, 27, 30, 35, 40], y=np.linspace(-20, 20, 11))
model = sg.Model(
    sg.join({"shaft": shaft, "hub": hub}),
    kind="axisymmetric twist",
    bodies=[sg.Body(name, sg.Elastic(E=210e3, nu=0.3)) for name in ("shaft", "hub")],
    supports=[
        sg.Support("hub.right", u=(None, 0, 0)),
        sg.Support("shaft.left", u=(None, None, 15.0 * angle), name="turn"),
    ],
    loads=[sg.Load("shaft.top", force=(0.0, pull, 0.0), name="pull")],
    contacts=[sg.Contact("hub.left", "shaft.right", friction=mu, name="fit")],
    steps=[
        sg.Step(name="shrink", interference={"fit": 0.02}, scale={"pull": 0.0, "turn": 0.0}),
        sg.Step(name="pull", scale={"pull": 1.0}),
        sg.Step(name="turn", scale={"turn": 1.0}, increments=24),
    ],
    title="A press fit that bears force and torque",
    units="mm, N, MPa",
)
solution = sg.solve(model)
print(solution)
# %%
torques = [abs(moment.contacts[0].tangential_force[2]) / 1e3 for moment in solution.last.instants]
turns = np.array([moment.load_factor for moment in solution.last.instants]) - 2.0
fit = solution.contact("fit")
force = (fit.pressure * fit.area).sum()
found, known, within = torques[-1], seat * np.sqrt((mu * force) ** 2 - pull**2) / 1e3, 0.01
figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
axes.plot(1e3 * angle * turns, torques, "o-", ms=3, color="#1b4f8a", label="torque of the fit")
axes.axhline(known, color="#333333", ls="--", lw=0.8, label="R sqrt((mu F)^2 - N^2)")
axes.set(
    xlabel="turn of the bore, mrad",
    ylabel="torque, N m",
    title=f"A fit that bears {pull / 1e3:g} kN along its axis, too",
)
axes.set_ylim(bottom=0)
axes.legend(frameon=False)
