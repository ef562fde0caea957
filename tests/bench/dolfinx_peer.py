#!/usr/bin/env python3
"""The pinned specimen of the benchmark in dolfinx with MUMPS; run by peers.py with the interpreter that has dolfinx.

Usage: dolfinx_peer.py linear N [--rows M] [--degree P] [--power G | --ratios A B] [--nu NU] [--slenderness S] [--solver mumps|cg]
       [--tolerance T] [--repeats R]
       dolfinx_peer.py plastic N [--steps 60] [--solver mumps|petsc] [--repeats R]
--once: no warm-up before a single pass, for the time of a whole process that finds its forms compiled.
N x M quadrilaterals of degree P (default: N x 2 N of degree 1), finer towards the corner of the end as the power G of the place.
--ratios: the last interval over the first along the radius and along the height, in geometric progression.
--solver cg: conjugate gradients with algebraic multigrid (GAMG of PETSc, with the three rigid-body modes as near-null space),
until the preconditioned residual has fallen by the factor of --tolerance.
Prints one JSON line: the ratio, and of every repeat the wall and processor seconds from the first node of the mesh to the answer.

What is counted: mesh, spaces, constraints, pattern, assembly, analysis, factorisation, solution, reaction.  What is not: the start of Python,
the imports and the compilation of the forms, which a first pass over a tiny mesh does before the clock starts.  The forms are
compiled for this processor, the law within the kernel of the element, so that one pass over the elements gives forces or
tangent; MUMPS analyses once, and its symmetric mode serves where the tangent is symmetric.
"""
import argparse
import gc
import json
import math
import os
import time

os.environ.setdefault("OMPI_MCA_ess_singleton_isolated", "true")  # one process needs no daemon

import basix
import numpy as np
import ufl
from dolfinx import fem, mesh
from dolfinx.fem import petsc
from mpi4py import MPI
from petsc4py import PETSc

RADIUS = 1.4
COMPILE = {"cffi_extra_compile_args": ["-O3", "-march=native"], "cffi_libraries": ["m"]}
CELL_PRESSURE = 50.0


class Watch:
    """Wall and processor seconds of what is counted."""

    def __init__(self):
        gc.collect()
        self.wall, self.processor = -time.perf_counter(), -time.process_time()

    def stop(self):
        self.wall += time.perf_counter()
        self.processor += time.process_time()

    def compiled(self, make, *what):
        """A form or an expression; finding or making its code does not count."""
        self.stop()
        made = make(*what, jit_params=COMPILE)
        self.wall -= time.perf_counter()
        self.processor -= time.process_time()
        return made


def places(intervals, ratio):
    """Of the lines of a mesh in [0, 1], whose intervals are a geometric progression."""
    widths = ratio ** (np.arange(intervals) / max(1, intervals - 1))
    return np.concatenate([[0.0], np.cumsum(widths) / widths.sum()])


def specimen(columns, rows, height, degree=1, power=1, ratios=None):
    corners = [np.array([0.0, 0.0]), np.array([RADIUS, height])]
    body = mesh.create_rectangle(MPI.COMM_SELF, corners, [columns, rows], mesh.CellType.quadrilateral)
    if power != 1:
        x = body.geometry.x
        for k, length in enumerate((RADIUS, height)):
            x[:, k] = length * (1 - (1 - x[:, k] / length) ** power)
    if ratios:
        x = body.geometry.x
        for k, (length, intervals, ratio) in enumerate(((RADIUS, columns, ratios[0]), (height, rows, ratios[1]))):
            x[:, k] = length * places(intervals, ratio)[np.rint(x[:, k] / length * intervals).astype(int)]
    return body, fem.VectorFunctionSpace(body, ("Lagrange", degree))


def held(space, height, moved):
    """Axis and foot held across themselves, the end held along and moved by `moved`; the end's dofs as well."""
    body = space.mesh
    line = body.topology.dim - 1

    def on(component, where):
        edges = mesh.locate_entities_boundary(body, line, where)
        return fem.locate_dofs_topological(space.sub(component), line, edges)

    axis, foot, end = (lambda x, k=k, at=at: np.isclose(x[k], at) for k, at in ((0, 0.0), (1, 0.0), (1, height)))
    zero, pushed = PETSc.ScalarType(0), on(1, end)
    conditions = [
        fem.dirichletbc(zero, on(0, axis), space.sub(0)),
        fem.dirichletbc(zero, on(0, end), space.sub(0)),
        fem.dirichletbc(zero, on(1, foot), space.sub(1)),
        fem.dirichletbc(moved, pushed, space.sub(1)),
    ]
    return conditions, pushed


def strain(u, r):
    return ufl.as_tensor([[u[0].dx(0), 0.5 * (u[0].dx(1) + u[1].dx(0)), 0], [0.5 * (u[0].dx(1) + u[1].dx(0)), u[1].dx(1), 0], [0, 0, u[0] / r]])


def direct(matrix, symmetric, package="mumps"):
    """METIS numbers the equations; scaling and permutation to the diagonal, which these matrices don't need, are off."""
    solver = PETSc.KSP().create(MPI.COMM_SELF)
    solver.setType("preonly")
    pc = solver.getPC()
    pc.setType("cholesky" if symmetric else "lu")
    pc.setFactorSolverType(package)
    if symmetric:
        matrix.setOption(PETSc.Mat.Option.SYMMETRIC, True)
        matrix.setOption(PETSc.Mat.Option.SPD, True)
    solver.setOperators(matrix)
    pc.setFactorSetUpSolverType()
    if package == "mumps":
        for control, value in ((7, 5), (8, 0), (6, 0), (14, 60)):  # the last: room for pivots, in percent
            pc.getFactorMatrix().setMumpsIcntl(control, value)
    else:
        pc.setFactorOrdering(ord_type="nd")
    return solver


def rigid_bodies(space):
    """Two translations and a rotation, orthonormal."""
    x = space.tabulate_dof_coordinates()
    modes = [PETSc.Vec().createSeq(2 * len(x)) for _ in range(3)]
    for mode, (horizontal, vertical) in zip(modes, ((1.0, 0.0), (0.0, 1.0), (-x[:, 1], x[:, 0]))):
        mode.array[0::2], mode.array[1::2] = horizontal, vertical
    basis = []
    for mode in modes:
        for other in basis:
            mode.axpy(-mode.dot(other), other)
        mode.scale(1 / mode.norm())
        basis.append(mode)
    return PETSc.NullSpace().create(vectors=basis)


def iterative(matrix, space, args):
    """Conjugate gradients with algebraic multigrid."""
    matrix.setBlockSize(2)
    matrix.setOption(PETSc.Mat.Option.SYMMETRIC, True)
    matrix.setOption(PETSc.Mat.Option.SPD, True)
    matrix.setNearNullSpace(rigid_bodies(space))
    solver = PETSc.KSP().create(MPI.COMM_SELF)
    solver.setType("cg")
    solver.setOperators(matrix)
    solver.setTolerances(rtol=args.tolerance, max_it=2000)
    solver.getPC().setType("gamg")
    options = PETSc.Options()
    options["mg_levels_ksp_type"] = "chebyshev"
    options["mg_levels_pc_type"] = "jacobi"
    solver.setFromOptions()
    return solver


def linear(watch, args, columns, rows, young=3000.0, axial=0.01):
    """Ratio of the mean end stress to that of a free end."""
    nu, height = args.nu, RADIUS * args.slenderness
    body, space = specimen(columns, rows, height, args.degree, args.power, args.ratios)
    r = ufl.SpatialCoordinate(body)[0]
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    mu, lam = young / (2 * (1 + nu)), young * nu / ((1 + nu) * (1 - 2 * nu))

    def stress(w):
        e = strain(w, r)
        return 2 * mu * e + lam * ufl.tr(e) * ufl.Identity(3)

    weight, dx = 2 * math.pi * r, ufl.dx(metadata={"quadrature_degree": 2 * args.degree})
    a = watch.compiled(fem.form, ufl.inner(stress(u), strain(v, r)) * weight * dx)
    nothing = watch.compiled(fem.form, ufl.inner(fem.Constant(body, np.zeros(2)), v) * weight * dx)
    conditions, _ = held(space, height, PETSc.ScalarType(-axial * height))
    matrix = petsc.assemble_matrix(a, bcs=conditions)
    matrix.assemble()
    b = petsc.assemble_vector(nothing)
    petsc.apply_lifting(b, [a], [conditions])
    petsc.set_bc(b, conditions)
    answer = fem.Function(space)
    solver = iterative(matrix, space, args) if args.solver == "cg" else direct(matrix, True)
    solver.solve(b, answer.vector)
    iterations = solver.getIterationNumber()
    if solver.getConvergedReason() < 0:
        raise SystemExit(f"no convergence in {iterations} iterations")
    # The reaction does all the work: force times displacement is a(u, u).
    work = fem.assemble_scalar(watch.compiled(fem.form, ufl.inner(stress(answer), strain(answer, r)) * weight * dx))
    for thing in (solver, matrix, b):
        thing.destroy()
    return work / (axial * height) / (math.pi * RADIUS**2) / (young * axial), iterations


def plastic(watch, args, columns, rows, young=3000.0, nu=0.495, axial=0.15, friction=36.87, cohesion=0.0, tolerance=1e-8):
    """Drucker-Prager as materials/drucker_prager.cpp has it (cone of triaxial compression, flow without volume change,
    apex = 1: beyond the apex only the deviator goes), with its consistent tangent.  Mean end stress less the
    cell pressure over E times strain, as the report of the deck has it."""
    steps, height = args.steps, RADIUS * args.slenderness
    body, space = specimen(columns, rows, height)
    r = ufl.SpatialCoordinate(body)[0]
    K, G = young / (3 * (1 - 2 * nu)), young / (2 * (1 + nu))
    s = math.sin(math.radians(friction))
    alpha = 2 * s / (math.sqrt(3) * (3 - s))
    k = 6 * cohesion * math.cos(math.radians(friction)) / (math.sqrt(3) * (3 - s))
    top = k / (3 * alpha)  # mean stress of the apex
    points = ufl.VectorElement("Quadrature", body.ufl_cell(), degree=2, quad_scheme="default", dim=4)
    states = fem.FunctionSpace(body, points)
    before, du = fem.Function(states), fem.Function(space)
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    unit = ufl.Identity(3)
    old = ufl.as_tensor([[before[0], before[3], 0], [before[3], before[1], 0], [0, 0, before[2]]])

    def elastic(e):
        return K * ufl.tr(e) * unit + 2 * G * ufl.dev(e)

    trial = old + elastic(strain(du, r))
    p, deviator = ufl.tr(trial) / 3, ufl.dev(trial)
    q = ufl.sqrt(0.5 * ufl.inner(deviator, deviator))
    rounding = 1e-12 * (k + 3 * alpha * abs(p) + q + 0.01 * abs(p))
    inside = ufl.And(ufl.le(q + 3 * alpha * p - k, rounding), ufl.le(p, top + rounding))
    before_apex = ufl.le(p, top + rounding)
    theta = ufl.max_value(k - 3 * alpha * p, 0.0) / q

    def choose(in_elastic, on_cone, beyond):
        pick = lambda i, j: ufl.conditional(inside, in_elastic[i, j], ufl.conditional(before_apex, on_cone[i, j], beyond[i, j]))
        return ufl.as_tensor([[pick(0, 0), pick(0, 1), 0], [pick(0, 1), pick(1, 1), 0], [0, 0, pick(2, 2)]])

    stress = choose(trial, p * unit + theta * deviator, p * unit)
    e = strain(u, r)
    normal = deviator / (math.sqrt(2) * q)
    turn = -2 * G * theta * ufl.inner(normal, e) - 3 * math.sqrt(2) * K * alpha * ufl.tr(e)
    cone = K * ufl.tr(e) * unit + 2 * G * theta * ufl.dev(e) + turn * normal
    apex = K * ufl.tr(e) * unit + 1e-7 * elastic(e)
    weight, dx = 2 * math.pi * r, ufl.dx(metadata={"quadrature_degree": 2})
    side = ufl.conditional(ufl.gt(r, RADIUS * (1 - 1e-9)), CELL_PRESSURE * v[0], 0.0) * weight * ufl.ds(metadata={"quadrature_degree": 2})
    inner_forces = watch.compiled(fem.form, ufl.inner(stress, strain(v, r)) * weight * dx + side)
    tangent = watch.compiled(fem.form, ufl.inner(choose(elastic(e), cone, apex), strain(v, r)) * weight * dx)
    flat = ufl.as_vector([stress[0, 0], stress[1, 1], stress[2, 2], stress[0, 1]])
    points_in_cell, _ = basix.make_quadrature(basix.CellType.quadrilateral, 2)
    after = watch.compiled(fem.Expression, flat, points_in_cell)
    cells = np.arange(body.topology.index_map(2).size_local, dtype=np.int32)
    slots = (4 * states.dofmap.list.array.astype(np.int64)[:, None] + np.arange(4)).ravel()

    values = before.x.array.reshape(-1, 4)
    values[:, :3] = -CELL_PRESSURE
    moved = fem.Constant(body, PETSc.ScalarType(-axial * height / steps))
    conditions, end_dofs = held(space, height, moved)
    matrix = petsc.create_matrix(tangent)
    b = petsc.create_vector(inner_forces)
    change = b.duplicate()
    solver, iterations, force = None, 0, 0.0
    fixed = np.unique(np.concatenate([condition.dof_indices()[0] for condition in conditions]))
    increment = du.x.array
    for step in range(steps):
        for iteration in range(40):
            with b.localForm() as local:
                local.set(0.0)
            petsc.assemble_vector(b, inner_forces)
            forces = b.array
            force = -forces[end_dofs].sum()
            free = forces.copy()
            free[fixed] = 0.0
            if iteration > 0 and np.abs(free).max() <= tolerance * np.abs(forces[fixed]).max():
                break
            matrix.zeroEntries()
            petsc.assemble_matrix(matrix, tangent, bcs=conditions)
            matrix.assemble()
            if step == 0 and iteration == 0:
                petsc.apply_lifting(b, [tangent], [conditions], x0=[du.vector], scale=-1.0)
                petsc.set_bc(b, conditions, du.vector, -1.0)
            else:
                b.array[fixed] = 0.0
            solver = solver or direct(matrix, False, args.solver)
            solver.solve(b, change)
            increment -= change.array
            iterations += 1
        else:
            raise SystemExit(f"no equilibrium in step {step + 1} of {columns} x {rows}")
        before.x.array[slots] = after.eval(cells).ravel()
        # The next step begins with the change of this one, whose held dofs are where they belong already.
    for thing in (solver, matrix, b, change):
        thing.destroy()
    correct = (2 * s * CELL_PRESSURE + 2 * cohesion * math.cos(math.radians(friction))) / (1 - s)  # sigma_1 - sigma_3 at failure
    return (force / (math.pi * RADIUS**2) - CELL_PRESSURE) / correct, iterations


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", choices=["linear", "plastic"])
    parser.add_argument("n", type=int)
    parser.add_argument("--rows", type=int, help="default: 2 N")
    parser.add_argument("--degree", type=int, default=1)
    parser.add_argument("--power", type=float, default=1)
    parser.add_argument("--nu", type=float, default=0.25)
    parser.add_argument("--slenderness", type=float, default=2)
    parser.add_argument("--steps", type=int, default=60)
    parser.add_argument("--solver", default="mumps", choices=["mumps", "petsc", "cg"])
    parser.add_argument("--tolerance", type=float, default=1e-8, help="of --solver cg")
    parser.add_argument("--ratios", type=float, nargs=2)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--once", action="store_true")
    args = parser.parse_args()
    rows = args.rows or 2 * args.n
    work = {"linear": linear, "plastic": plastic}[args.scene]
    if not args.once:
        work(Watch(), args, 2, 4)  # compiles the forms, or finds them compiled
    watches = []
    for _ in range(1 if args.once else args.repeats):
        watch = Watch()
        ratio, iterations = work(watch, args, args.n, rows)
        watch.stop()
        watches.append(watch)
    print(json.dumps(dict(ratio=ratio, iterations=iterations, wall=[w.wall for w in watches], processor=[w.processor for w in watches])))


if __name__ == "__main__":
    main()
