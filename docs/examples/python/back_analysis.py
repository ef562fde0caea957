"""Young's modulus and friction angle from a triaxial test, by least squares on the specimen with rough platens.

The measured curve is made here: E = 2400 psi, phi = 33 degrees, rounded to a tenth of a psi as a reading would be.
"""
import sys

import numpy as np
from scipy.optimize import least_squares

import sagefe

model = sagefe.read(f"{sys.argv[1]}/dp_285/deck.dat").with_(stages={1: dict(increments=15)})


def deviator(parameters):
    modulus, angle = parameters
    changed = model.with_(materials={1: dict(E=modulus, friction_angle=angle)})
    return changed.run(strict=True, keep="none").report[1].measured_deviator


measured = np.round(deviator([2400.0, 33.0]), 1)
found = least_squares(lambda x: deviator(x) - measured, [3000.0, 36.0], x_scale=[1000.0, 10.0], diff_step=1e-4)
print(f"{found.nfev} steps, largest difference {abs(found.fun).max():.2f} psi")
print(f"E = {found.x[0]:.1f} psi, phi = {found.x[1]:.3f} degrees")
