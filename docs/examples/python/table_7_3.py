"""Table 7.3 of the source chapter: ratio of measured to correct axial stress at 10 % strain."""
import sys

import sagefe

columns = ("friction_08_kj5_nu0495", "friction_285_nu0495", "pinned_ld2_nu0495", "pinned_ld1_nu0495")
models = [sagefe.read(f"{sys.argv[1]}/{case}/deck.dat") for case in columns]
for nu in (0.25, 1 / 3, 0.495):
    ratios = [model.with_(materials={1: dict(nu=nu)}).run().report[1].ratio[-1] for model in models]
    print(f"nu = {nu:.3f}", *(f"{ratio:.4f}" for ratio in ratios), sep="  ")
