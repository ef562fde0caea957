"""Pinned ends on finer and finer meshes, and Richardson's extrapolation from the last three."""
import sys

import sagefe

model = sagefe.read(f"{sys.argv[1]}/pinned_ld2_nu0495/deck.dat").with_(formulation="b-bar")
ratios = []
for refine in range(4):
    result = model.with_(refine=refine).run(strict=True, keep="none")
    ratios.append(result.report[1].ratio[-1])
    print(f"{14 * 2**refine} x {28 * 2**refine} elements: {ratios[-1]:.6f}")
coarse, middle, fine = ratios[-3:]
print(f"limit: {fine - (fine - middle) ** 2 / ((fine - middle) - (middle - coarse)):.6f}")
