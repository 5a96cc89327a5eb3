"""Figures 3 and 5 of the paper: path following and tracking from rest, and a payload whose mass is told wrong.

    python figures.py [folder]
"""

import pathlib
import sys

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt

import slung


def panel(axes, names, quantity, label):
    for name in names:
        flight = slung.run(slung.Scenario(name))
        log = flight.log
        axes.plot(log["t_s"], log[quantity], label=name)
        unit, meaning = flight.quantities[quantity]
    axes.set(xlabel="t (s)", ylabel=f"{label} ({unit})", title=meaning)
    axes.legend()


def ground_track(axes, names):
    for name in names:
        scenario = slung.Scenario(name)
        log = slung.run(scenario).log
        axes.plot(log["p2"], log["p1"], label=name)
    circle = slung.Path(**{"kind": "circle", "radius": 5.0, "p3": -10.0, "speed": -5.0}).outline()
    axes.plot(circle[:, 1], circle[:, 0], "k--", linewidth=0.8, label="path")
    axes.set(xlabel="p2 (m)", ylabel="p1 (m)", title="From rest, 4 m outside the circle", aspect="equal")
    axes.legend()


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    figure, ((a, b), (c, d)) = plt.subplots(2, 2, figsize=(11, 9), layout="constrained")
    ground_track(a, ["fig3a", "fig3b"])
    panel(b, ["fig3a", "fig3b"], "d_c", "d_C")
    panel(c, ["fig3a", "fig3b"], "thrust", "T")
    panel(d, ["fig5", "fig5-no-integral"], "p3", "p3")
    file = folder / "figures.png"
    figure.savefig(file, dpi=150)
    print(file)


if __name__ == "__main__":
    main()
