import matplotlib.pyplot as plt
import numpy as np

plt.rcParams.update({"font.size": 8, "axes.spines.top": False, "axes.spines.right": False})
fig, axes = plt.subplots(2, 2, sharex=True, sharey=True, figsize=(85 / 25.4, 70 / 25.4),
                         layout="constrained")
for ax, volts in zip(axes.flat, (1, 2, 5, 10)):
    run = np.genfromtxt(f"voltage-{volts}.csv", delimiter=",", names=True)
    ax.fill_between(run["times"], 0, 1, run["contact"] > 0.5,
                    transform=ax.get_xaxis_transform(), color="#f0f3f7", lw=0)
    ax.plot(run["times"], run["forceN"], color="C1", lw=0.95)
    ax.set_title(f"{volts} V", fontsize=8)
    ax.grid(axis="y", color="0.9", lw=0.4)
    ax.set_xlim(0, 0.6)
fig.supxlabel("Time $t$ (s)", fontsize=8)
fig.supylabel("Contact force $f$ (N)", fontsize=8)
fig.savefig("voltages.png", dpi=200)
