import matplotlib.pyplot as plt
import numpy as np

plt.rcParams.update({"font.size": 8, "axes.spines.top": False, "axes.spines.right": False})
printed, corrected = (np.genfromtxt(f"{name}.csv", delimiter=",", names=True)
                      for name in ("printed", "corrected"))
time = printed["times"]

fig, (top, below) = plt.subplots(2, 1, sharex=True, figsize=(85 / 25.4, 88 / 25.4),
                                 height_ratios=[1.6, 0.7], layout="constrained")
for ax in (top, below):
    ax.fill_between(time, 0, 1, printed["contact"] > 0.5, transform=ax.get_xaxis_transform(),
                    color="#f0f3f7", lw=0)
    ax.grid(axis="y", color="0.9", lw=0.4)
top.plot(time, printed["forceN"], color="C1", lw=0.95, label="printed")
top.plot(corrected["times"], corrected["forceN"], "k--", lw=0.65, label="corrected")
top.set_ylabel("Contact force $f$ (N)")
top.legend(frameon=False)
below.plot(time, np.interp(time, corrected["times"], corrected["forceN"]) - printed["forceN"],
           "k", lw=0.95)
below.set_ylabel("difference (N)")
below.set_xlabel("Time $t$ (s)")
below.set_xlim(0, 1)
fig.savefig("force.png", dpi=200)
