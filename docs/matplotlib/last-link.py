import matplotlib.pyplot as plt
import numpy as np

plt.rcParams.update({"font.size": 8, "axes.spines.top": False, "axes.spines.right": False})
printed, corrected = (np.genfromtxt(f"{name}.csv", delimiter=",", names=True)
                      for name in ("printed-10ms", "corrected-10ms"))
shown = [("last_accelerationrads2", r"$\ddot\theta_3$ (rad/s²)"),
         ("last_velocityrads", r"$\dot\theta_3$ (rad/s)"),
         ("last_anglerad", r"$\theta_3$ (rad)")]

fig, axes = plt.subplots(3, 1, sharex=True, figsize=(85 / 25.4, 105 / 25.4),
                         layout="constrained")
for ax, (column, label) in zip(axes, shown):
    ax.grid(axis="y", color="0.9", lw=0.4)
    ax.plot(printed["times"], printed[column], color="C2", lw=0.95, label="printed")
    ax.plot(corrected["times"], corrected[column], "k--", lw=0.65, label="corrected")
    ax.autoscale(False)
    ax.fill_between(printed["times"], 0, 1, printed["contact"] > 0.5,
                    transform=ax.get_xaxis_transform(), color="#f0f3f7", lw=0)
    ax.set_ylabel(label)
fig.align_ylabels()
axes[0].legend(frameon=False)
axes[-1].set_xlabel("Time $t$ (s)")
axes[-1].set_xlim(0, 1)
fig.savefig("last-link.png", dpi=200)
