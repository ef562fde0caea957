"""A linear specimen without two equal elements: what is left where nothing repeats, beside a direct and an iterative solver."""
import os

import peers
import specimen
from measure import Job, Table
from same_mesh import AGREE, Dolfinx, sage_job, unknowns

RATIOS = (3.0, 0.5)  # last interval over the first, along the radius and the height
TOLERANCE = 1e-8  # of the iterative solver
LEFT = 1e-5  # the error that it may leave in the ratio
TITLE = "Linear problem without equal elements"
NOTE = (
    "The specimen of the problem `pinned_ld2_nu25` on n x 2n quad4 full. The lines of the mesh get wider along the radius (last interval 3 times the first) and narrower along the height (.5 times), in geometric progression, so no two elements are equal. "
    "So sagefe computes the stiffness of each element, and its solver finds no repeated substructures.\n\n"
    "dolfinx has the same mesh, elements and integration points. Its ratio with MUMPS agrees with that of sagefe to 1e-7; otherwise the benchmark fails. The columns *CG* have conjugate gradients with algebraic multigrid of PETSc (GAMG, smoothed aggregation, with two translations and a rotation as near-null space). "
    f"The iteration ends when the preconditioned residual has fallen by the factor {TOLERANCE:g}. *error of CG* is the relative difference of its ratio from that of MUMPS.\n\n"
    "Times in seconds are processor times, except in the columns *wall*. Those of sagefe are of the whole process with all output, those of dolfinx from the mesh to the answer. *MB* is the largest memory of the process; that of dolfinx includes Python. Ratios divide processor times."
)
HEAD = [
    "n", "unknowns", "sagefe s", "wall s", "wall s, all threads", "MB", "MUMPS s", "MB of MUMPS", "MUMPS over sagefe", "CG s", "iterations of CG", "error of CG", "MB of CG", "CG over sagefe",
]


def jobs_of(bench, n):
    own = sage_job(bench, f"general_{n}", "own", n, specimen.elastic(n, RATIOS))
    jobs = {"own": own}
    if (os.cpu_count() or 1) > bench.args.threads:
        at = own.command.index("--threads")
        jobs["all"] = Job((*own.labels, "all threads"), own.command[:at] + own.command[at + 2 :], own.find)
    if peers.DOLFINX:
        ratios = ["--ratios", *map(str, RATIOS)]
        repeats = 3 if n < 112 else 1
        jobs["MUMPS"] = peers.dolfinx_job("linear", n, repeats, *ratios)
        jobs["CG"] = peers.dolfinx_job("linear", n, repeats, *ratios, "--solver", "cg", "--tolerance", str(TOLERANCE))
    return jobs


def row_of(bench, n, found):
    own = found["own"]
    row = [str(n), str(unknowns(own.text)), f"{own.cpu:.3g}", f"{own.wall:.3g}", f"{found['all'].wall:.3g}" if "all" in found else "-", f"{own.mb:.0f}"]
    if "MUMPS" not in found or "CG" not in found:
        return row + ["-"] * 8
    direct, iterative = Dolfinx(found["MUMPS"]), Dolfinx(found["CG"])
    if not abs(direct.ratio / own.value - 1) <= AGREE["linear"]:
        bench.wrong.append(f"general, n = {n}: dolfinx {direct.ratio:.10g}, sagefe {own.value:.10g}")
    error = abs(iterative.ratio / direct.ratio - 1)
    if not error <= LEFT:
        bench.wrong.append(f"general, n = {n}: CG {iterative.ratio:.10g}, MUMPS {direct.ratio:.10g}")
    row += [f"{direct.cpu:.3g}", f"{found['MUMPS'].mb:.0f}", f"{direct.cpu / own.cpu:.2f}"]
    return row + [f"{iterative.cpu:.3g}", str(iterative.iterations), f"{error:.0e}", f"{found['CG'].mb:.0f}", f"{iterative.cpu / own.cpu:.2f}"]


def general(bench):
    rows = []
    for n in [n for n in (14, 28, 56, 112, 224, 448) if n <= bench.args.largest]:
        jobs = jobs_of(bench, n)
        records = bench.turns(list(jobs.values()))
        if jobs["own"].labels not in records:
            bench.wrong.append(f"general, n = {n}: sagefe failed")
            break
        found = {name: records[job.labels] for name, job in jobs.items() if job.labels in records}
        if not abs(found["own"].value / 1.017628765 - 1) < 2e-3:
            bench.wrong.append(f"general, n = {n}: sagefe {found['own'].value}")
        rows.append(row_of(bench, n, found))
    return {"general": Table(TITLE, NOTE, "`sagefe run --threads N`; in the column *all threads* without `--threads`.", HEAD, rows)}
