# %% [markdown]
# # Fretting pad
# A crowned pad is pressed on a block of the same material and then pushed sideways by half of what friction can
# hold. It sticks in the middle and slips at both ends: Cattaneo and Mindlin's problem, whose stick zone has the
# half-width `c = a sqrt(1 - Q / (mu P))`. The exact path finds it event by event.
# %%
import matplotlib.pyplot as plt
import numpy as np

import signorini as sg

E, nu, mu, half_width, radius = 210e3, 0.3, 0.6, 0.5, 50.0  # N, mm; half_width of the contact
modulus = E / (1 - nu**2) / 2
press = np.pi * modulus * half_width**2 / (4 * radius)  # of Hertz, per thickness
beside = np.geomspace(0.6, 20.0, 16)
x = np.concatenate([-beside[::-1], np.linspace(-0.58, 0.58, 97), beside])
y = np.concatenate([[0.0], np.geomspace(0.02, 20.0, 22)])
mesh = sg.join({"pad": sg.rectangle(x=x, y=y), "block": sg.rectangle(x=x, y=-y[::-1])})
model = sg.Model(
    mesh,
    bodies=[sg.Body(name, sg.Elastic(E=E, nu=nu)) for name in ("pad", "block")],
    supports=[sg.Support("block.bottom", u=(0, 0))],
    loads=[
        sg.Load("pad.top", force=(None, -press), spread="displacement", name="press"),
        sg.Load("pad.top", force=(0.5 * mu * press, None), spread="displacement", name="push"),
    ],
    contacts=[sg.Contact("pad.bottom", "block.top", friction=mu, interference=f"-x^2 / {2 * radius}", name="seat")],
    steps=[sg.Step(name="press", scale={"press": 1.0, "push": 0.0}), sg.Step(name="push", scale={"push": 1.0})],
    title="A fretting pad",
    units="mm, N, MPa",
)
solution = sg.solve(model)
print(solution)
# %%
contact = solution.contact("seat")
bound = mu * contact.pressure
stick = np.abs(contact.traction) < bound * (1 - 1e-9)
found, known, within = np.ptp(contact.points[stick, 0]) / np.ptp(contact.points[contact.closed, 0]), np.sqrt(0.5), 0.04
figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
order = np.argsort(contact.points[:, 0])
axes.fill_between(contact.points[order, 0], bound[order], color="#dfe8f2", label="friction could hold")
axes.plot(contact.points[order, 0], np.abs(contact.traction[order]), "o-", ms=3, color="#c4451c", label="friction")
for end in (-1, 1):
    axes.axvline(end * half_width * known, color="#333333", ls="--", lw=0.8)
axes.set(xlim=(-0.6, 0.6), xlabel="x, mm", ylabel="MPa", title="Stick inside the dashed lines (Cattaneo, Mindlin)")
axes.legend(frameon=False)
