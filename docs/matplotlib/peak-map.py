import sqlite3

import matplotlib.pyplot as plt
import numpy as np

plt.rcParams.update({"font.size": 8})
rows = np.array(sqlite3.connect("map.sqlite").execute(
    'SELECT "motor.voltage", "arm.k2", first_pulse_peak_N FROM run').fetchall(), dtype=float)
volts, stiffness = np.unique(rows[:, 0]), np.unique(rows[:, 1])
peak = np.full((stiffness.size, volts.size), np.nan)
peak[np.searchsorted(stiffness, rows[:, 1]), np.searchsorted(volts, rows[:, 0])] = rows[:, 2]

fig, ax = plt.subplots(figsize=(85 / 25.4, 62 / 25.4), layout="constrained")
cells = ax.pcolormesh(volts, stiffness, peak, shading="nearest")
lines = ax.contour(volts, stiffness, peak, colors="k", linewidths=0.5)
ax.clabel(lines, fontsize=6)
ax.set_xlabel("Voltage (V)")
ax.set_ylabel("$k_2$ (N·m/rad)")
fig.colorbar(cells, label="Peak force (N)")
fig.savefig("peak-map.png", dpi=200)
