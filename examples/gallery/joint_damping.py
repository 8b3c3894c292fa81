# %% [markdown]
# # Joint damping
# Half of a bar lies on a rough bed and slips more and more of it as it vibrates: friction damps the more, the
# larger the amplitude, and the frequency falls. What a cycle loses is known in closed form (microslip of a bar);
# here one exact path per amplitude.
# %%
import matplotlib.pyplot as plt
import numpy as np

import signorini as sg
from signorini.gallery.vibrating import bar_in_a_bed

model, exact = bar_in_a_bed(24)
solution = sg.solve(model)
print(solution)
shares = (0.2, 0.4, 0.6, 0.8)
damping = sg.joint_damping(solution, [exact.amplitude(share) for share in shares], cycles=1)
print(damping)
# %%
force = np.array(shares) * exact.bed * exact.friction / exact.pull
found, known, within = damping.ratios[-1], exact.ratio(force)[-1], 0.05
figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
for loop in damping.loops:
    axes.plot(1e3 * np.asarray(loop.coordinate), loop.force, color="#1b4f8a", lw=1.2)
axes.set(xlabel="displacement of the mode, 1e-3", ylabel="modal force", title="Loops at four amplitudes")
inset = axes.inset_axes([0.64, 0.17, 0.33, 0.34])
inset.plot(shares, 100 * damping.ratios, "o", ms=4, color="#c4451c")
inset.plot(shares, 100 * exact.ratio(force), color="#333333", lw=1)
inset.set_title("damping ratio, %; line: closed form", fontsize=7, loc="right")
inset.set_xlabel("share of the bed that slips", fontsize=7)
inset.tick_params(labelsize=7)
