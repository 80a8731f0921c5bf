"""The measurements of Illustration I, drawn: one line for each patient."""

from matplotlib.figure import Figure

from student1908 import paper
from student1908.illustration_1 import PATIENTS, hours


@paper.figure(
    "sleep-gained",
    "What each patient gained",
    alt="Hours of sleep gained by ten patients with each drug. All but one gained more with the second.",
    size=(5.0, 2.8),
)
def sleep_gained(fig: Figure) -> None:
    """Draw both drugs as points over the patient's number."""
    axes = fig.subplots()
    gained = hours()
    axes.axhline(0.0, color="0.6", linewidth=0.8)
    axes.plot(range(1, len(PATIENTS) + 1), gained["dextro"], "o", label="1 (dextro-)")
    axes.plot(range(1, len(PATIENTS) + 1), gained["laevo"], "s", label="2 (laevo-)")
    axes.set_xticks(range(1, len(PATIENTS) + 1))
    axes.set_xlabel("patient")
    axes.set_ylabel("additional sleep, hours")
    axes.margins(0.05)
    axes.legend()
