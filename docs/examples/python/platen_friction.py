"""How the friction of the platens raises the measured stress: a sweep over the friction angle, and its plot."""
import sys

from matplotlib import pyplot

import sagefe

model = sagefe.read(f"{sys.argv[1]}/friction_285_nu0495/deck.dat")
angles = [0.1, 0.8, 2.5, 5.0, 10.0, 15.0, 28.5]
ratios = []
for angle in angles:
    result = model.with_(materials={2: dict(friction_angle=angle)}).run(strict=True, keep="none")
    ratios.append(result.report[1].ratio[-1])
    print(f"{angle:5.1f}  {ratios[-1]:.5f}")

pyplot.plot(angles, ratios, marker="o")
pyplot.xlabel("friction angle of the platens [degrees]")
pyplot.ylabel("measured / correct deviator at 10 % strain")
pyplot.savefig("platen_friction.png", dpi=120)
