"""The package sagefe: models, results, stepping, laws, threads, signals."""

import gc
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import sagefe

SOURCE = pathlib.Path(os.environ["SAGE_SOURCE_DIR"])
CASES = SOURCE / "legacy_inputs" / "chapter7"
PINNED = CASES / "pinned_ld2_nu0495" / "deck.dat"
PLASTIC = CASES / "dp_285" / "deck.dat"


def layer(rows=4, law="linear_elastic", gravity=False, increments=10, **parameters):
    """A column of `rows` elements of .5 m between smooth sides under 100 kPa: it settles by p H / E where nu = 0."""
    nodes = [(x, 0.5 * j) for j in range(rows + 1) for x in (0.0, 1.0)]
    quads = [(2 * j + 1, 2 * j + 2, 2 * j + 4, 2 * j + 3) for j in range(rows)]
    if law == "linear_elastic":
        parameters = parameters or dict(youngs_modulus=20e3, poissons_ratio=0.0)
    material = sagefe.Material(law, **parameters)
    return sagefe.build(
        nodes, [material], [sagefe.Group("quad4", quads)],
        [sagefe.Stage(increments, "press", pressures=[sagefe.Pressure([rows], 3, 100.0)])],
        supports=[sagefe.Support([1, 2], "fixed", "fixed"), sagefe.Support(range(3, 2 * rows + 3), "fixed")],
        reports=[sagefe.ReportOf("nodes", nodes=[2 * rows + 1, 2 * rows + 2])],
        units=("m", "kN", "kPa"), title="layer",
    )


@pytest.fixture(scope="module")
def pinned():
    return sagefe.read(PINNED).run()


def test_reads_a_deck_with_its_warnings():
    model = sagefe.read(PINNED)
    assert model.geometry == "axisymmetric"
    assert model.units == {"length": "in", "force": "lbf", "stress": "psi"}
    assert model.nodes.shape == (435, 2)
    assert [one.code for one in model.warnings if one.severity == "warning"] == ["S325"]
    assert model.materials[1] == ("elastic specimen", "linear_elastic",
                                  {"youngs_modulus": 3000.0, "poissons_ratio": 0.495})
    assert "psi" in repr(model)


def test_ratio_is_that_of_table_7_3(pinned):
    assert pinned.converged and pinned.status == "completed"
    assert len(pinned.report[1]) == 10
    assert f"{pinned.report[1].ratio[-1]:.4f}" == "1.1189"
    assert pinned.report[1].units["force"] == "lbf"
    np.testing.assert_allclose(pinned.report[1].axial_strain, np.linspace(0.01, 0.1, 10), rtol=1e-12)


def test_reports_are_those_of_the_program(tmp_path, pinned):
    subprocess.run([os.environ["SAGE_EXECUTABLE"], "run", str(PINNED), "-o", str(tmp_path), "-q", "--digits", "17"],
                   check=True, stderr=subprocess.DEVNULL)
    table = next(tmp_path.glob("*.report1.csv")).read_text().splitlines()
    rows = [line.split(",") for line in table if not line.startswith("#")]
    names = [name.split("[")[0] for name in rows[0]]
    for column, name in enumerate(names):
        np.testing.assert_array_equal(pinned.report[1][name], [float(row[column]) for row in rows[1:]])


def test_signs_and_units_are_the_outer_ones(pinned):
    """The cell pressure of 50 psi is compression: positive; the specimen is shortened: the top moves down."""
    cell = pinned.at(stage=1)
    np.testing.assert_allclose(cell.points.stress[:, :3].mean(axis=0), 50.0, rtol=1e-9)
    end = pinned.at(strain=0.1)
    top = end.nodes.place[:, 1] == 2.8
    np.testing.assert_allclose(end.nodes.displacement[top, 1].mean() - cell.nodes.displacement[top, 1].mean(), -0.28)
    assert end.points.strain[:, 1].mean() > 0.09
    assert end.points.stress.shape == (392 * 4, 4) and end.points.deviator.shape == (392 * 4,)
    assert end.points.unit("stress") == "psi" and "compression positive" in repr(end)


def test_fields_at_any_increment(pinned):
    assert len(pinned) == 1 + 1 + 10  # the start, and every increment
    for increment in (1, 5, 10):
        state = pinned.at(stage=2, increment=increment)
        assert (state.stage, state.increment) == (2, increment)
        assert state.load_factor == pytest.approx(increment / 10)
    fifth, tenth = pinned.at(stage=2, increment=5), pinned.at(stage=2, increment=10)
    grown = tenth.points.stress - pinned.at(stage=1).points.stress
    np.testing.assert_allclose(2 * (fifth.points.stress - pinned.at(stage=1).points.stress), grown, atol=1e-9)
    with pytest.raises(KeyError, match="no state of stage 2, increment 11"):
        pinned.at(stage=2, increment=11)
    with pytest.raises(KeyError, match="no increment ends at"):
        pinned.at(strain=0.0123)
    with pytest.raises(AttributeError, match="there are: .*stress"):
        pinned[-1].points.nonsense


def test_every_field_that_is_named_can_be_read():
    state = sagefe.read(PLASTIC).with_(stages={1: dict(increments=4)}).run()[-1]
    for fields in (state.nodes, state.points, state.interfaces):
        assert len(fields) > 0 and fields.names()
        for name in fields.names():
            values = fields[name]
            assert len(values) == len(fields) and not values.flags.writeable
    assert set(state.interfaces.words("status")) <= {"elastic", "slipping", "open", "unloading"}
    assert len(state.structures) == 0


def test_arrays_are_read_only_and_outlive_their_run():
    result = sagefe.read(PINNED).run()
    state = result.at(strain=0.1)
    view, copy = state.nodes.displacement, state.points.stress
    before = view.copy(), copy.copy()
    for array in (view, copy, result.report[1].ratio):
        with pytest.raises(ValueError):
            array[0] = 1.0
    ratio = result.report[1].ratio
    del result, state
    gc.collect()
    other = sagefe.read(PINNED).with_(materials={1: dict(nu=0.2)}).run()  # takes the memory that was let go
    np.testing.assert_array_equal(view, before[0])
    np.testing.assert_array_equal(copy, before[1])
    assert ratio[-1] == pytest.approx(1.1189, abs=5e-5) and other.converged


def test_with_other_values():
    model = sagefe.read(PINNED)
    for nu, printed in ((0.25, "1.0181"), (0.33333333, "1.0344"), (0.495, "1.1189")):  # Table 7.3
        assert f"{model.with_(materials={1: dict(nu=nu)}).run().report[1].ratio[-1]:.4f}" == printed
    by_name = model.with_({"material.elastic specimen.poissons_ratio": 0.25})
    assert by_name["material.1.nu"] == 0.25 and model["material.1.nu"] == 0.495
    assert len(model.with_(stages={2: dict(increments=3)}).run().report[1]) == 3
    assert model.with_(geometry="plane_strain").geometry == "plane_strain"
    # B-bar does not lock: the converged answer is 1.086254 (docs/verification.md)
    assert model.with_(formulation="b-bar").run().report[1].ratio[-1] == pytest.approx(1.0863, rel=5e-3)
    # Twice the pressure of a linear model: twice the stress
    assert model.with_({"stage.1.load_factor": 2.0}).run().at(stage=1).points.stress[0, 0] == pytest.approx(100.0)


@pytest.mark.parametrize("values, code, words", [
    ({"material.1.nus": 0.3}, "S730", "did you mean material.1.nu"),
    ({"material.2.nu": 0.3}, "S730", "no number of the name material.2.nu"),
    ({"stage.3.increments": 3}, "S730", "stage.3.increments"),
    ({"stage.2.increments": 2.5}, "S731", "whole number"),
    ({"material.1.nu": float("nan")}, "S731", "finite"),
    ({"geometry": "plane"}, "S731", "plane_strain or axisymmetric"),
    ({"formulation": "bbar"}, "S731", "b-bar"),
    ({"material.1.nu": 0.3, "material.elastic specimen.poissons_ratio": 0.2}, "S731", "the same number"),
    ({"material.1.nu": 0.6}, "S224", "with material.1.nu = 0.6"),
])
def test_values_that_can_not_be_meant(values, code, words):
    with pytest.raises(sagefe.DeckError) as caught:
        sagefe.read(PINNED).with_(values)
    assert caught.value.code == code
    assert words in str(caught.value)


def test_deck_errors_have_places(tmp_path):
    deck = tmp_path / "bad.dat"
    text = PINNED.read_text().splitlines()
    line = next(i for i, one in enumerate(text) if one.startswith("   15                 1.4"))
    text[line] = text[line].replace("1.4", "1.x")
    deck.write_text("\n".join(text))
    with pytest.raises(sagefe.DeckError) as caught:
        sagefe.read(deck)
    first = caught.value.diagnostics[0]
    assert (first.severity, first.line, first.file) == ("error", line + 1, str(deck))
    assert first.first_column >= 16 and first.last_column <= 25 and first.code.startswith("S")
    assert isinstance(caught.value, ValueError) and "1.x" in "\n".join([first.text, *first.detail])
    with pytest.raises(sagefe.DeckError):
        sagefe.read(tmp_path / "missing.dat")


def test_model_of_arrays():
    result = layer().run()
    np.testing.assert_allclose(result.report[1].uy, -np.linspace(0.001, 0.01, 10), rtol=1e-9)  # p H / E
    np.testing.assert_allclose(result[-1].points.stress[:, 1], 100.0, rtol=1e-9)
    with pytest.raises(sagefe.DeckError, match="unknown"):
        layer(law="linear_elastics", E=1.0)
    with pytest.raises(sagefe.DeckError, match="parameter 'E'"):
        layer(law="linear_elastic", E=1.0, poissons_ratio=0.0)
    with pytest.raises(ValueError, match="fixed"):
        sagefe.build([(0, 0)], [], [], [], supports=[sagefe.Support([1], "held")])


def test_ties_spread_a_force():
    """100 kN on one of two nodes that settle alike are 100 kPa on the column of 1 m, which shortens by p H / E."""
    model = sagefe.build(
        [(0, 0), (1, 0), (1, 1), (0, 1)], [sagefe.Material("linear_elastic", youngs_modulus=20e3, poissons_ratio=0.0)],
        [sagefe.Group("quad4", [(1, 2, 3, 4)])], [sagefe.Stage(1, loads=[sagefe.Load([3], y=-100.0)])],
        supports=[sagefe.Support([1, 2], "fixed", "fixed")], ties=[sagefe.Tie([3], 4, x=False)], units=("m", "kN", "kPa"))
    np.testing.assert_allclose(model.run()[-1].nodes.displacement[2:, 1], -0.005, rtol=1e-12)


def test_no_equilibrium():
    """A smooth column without lateral support has the strength 2 c = 20 kPa: 100 kPa have no equilibrium."""
    model = sagefe.build(
        [(0, 0), (1, 0), (1, 1), (0, 1)],
        [sagefe.Material("mohr_coulomb", youngs_modulus=20e3, poissons_ratio=0.3, cohesion=10.0, friction_angle=0.0)],
        [sagefe.Group("quad4", [(1, 2, 3, 4)])],
        [sagefe.Stage(10, pressures=[sagefe.Pressure([1], 3, 100.0)])],
        supports=[sagefe.Support([1], "fixed", "fixed"), sagefe.Support([2], "", "fixed")],
        reports=[sagefe.ReportOf("nodes", nodes=[3, 4])], units=("m", "kN", "kPa"))
    result = model.run()
    assert not result.converged and result.status in ("not converged", "singular") and result.reason
    assert 1.9 < abs(result[-1].points.stress[:, 1].mean()) / 10 < 2.01
    with pytest.raises(sagefe.NotConverged) as caught:
        model.run(strict=True)
    assert caught.value.code.startswith("S5") and len(caught.value.result.report[1]) > 0


def test_stepping_with_a_load_that_changes():
    """docs/examples/stepping.cpp: pressed until 5.5 mm, then 30 kPa are left and 3 mm."""
    analysis = layer().analysis()
    settlement = lambda: -1e3 * analysis.state().nodes.displacement[-1, 1]
    while analysis.advance():
        if settlement() > 5.5:
            break
    assert analysis.increment == 6 and settlement() == pytest.approx(6.0)
    kept = analysis.state()
    analysis.set_pressure(30.0)
    while analysis.advance():
        pass
    assert settlement() == pytest.approx(3.0) and analysis.is_complete
    assert -1e3 * kept.nodes.displacement[-1, 1] == pytest.approx(6.0)  # a state stays as it is
    result = analysis.close(strict=True)
    assert result.converged and len(result.report[1]) == 10
    with pytest.raises(ValueError, match="closed"):
        analysis.advance()


def test_stepping_is_run():
    model = sagefe.read(PINNED)
    with model.analysis(keep="all") as analysis:
        states = list(analysis)
        result = analysis.result
    run = model.run()
    assert len(states) == 11
    np.testing.assert_array_equal(result.report[1].force, run.report[1].force)
    np.testing.assert_array_equal(states[-1].nodes.displacement, run[-1].nodes.displacement)


def test_loads_of_a_wrong_stage():
    analysis = layer().analysis()
    with pytest.raises(ValueError, match="no stage 7"):
        analysis.set_pressure(1.0, stage=7)
    assert (analysis.stage, analysis.increment) == (1, 0)
    with pytest.raises(ValueError, match="no pressure"):
        analysis.set_pressure(1.0, elements=[1])
    with pytest.raises(ValueError, match="no node 99"):
        analysis.set_load([99], y=1.0)


def test_law_along_a_path():
    """Drucker-Prager of the chapter: elastic with E = 3000 psi up to 150 psi at 5 % strain."""
    law = sagefe.Law("drucker_prager", E=3000, nu=0.495, c=0, phi=36.87)
    curve = law.drive("triaxial", cell=50, strain=0.1)
    assert not curve.failure
    deviator = -curve.axial_deviator if curve.axial_deviator[-1] < 0 else curve.axial_deviator
    assert deviator[-1] == pytest.approx(150.0, rel=1e-3)
    assert np.interp(0.025, curve.strain_yy, deviator) == pytest.approx(75.0, rel=1e-6)
    with pytest.raises(sagefe.DeckError, match="not set"):
        sagefe.Law("drucker_prager", E=3000).drive("triaxial", strain=0.1)
    with pytest.raises(sagefe.DeckError, match="no parameter"):
        sagefe.Law("drucker_prager", Young=3000).drive("triaxial", strain=0.1)
    with pytest.raises(ValueError, match="no test"):
        law.drive("triaxal", strain=0.1)


def elastic(p, stress, strain, dstrain, history):
    lame, shear = p.E * p.nu / ((1 + p.nu) * (1 - 2 * p.nu)), p.E / (2 * (1 + p.nu))
    tangent = np.zeros((4, 4))
    tangent[:3, :3] = lame
    tangent[np.arange(3), np.arange(3)] += 2 * shear
    tangent[3, 3] = shear
    return stress + tangent @ dstrain, tangent, history + abs(dstrain).sum()


def failing(p, stress, strain, dstrain, history):
    raise ZeroDivisionError("this law gives up")


def wrong_shape(p, stress, strain, dstrain, history):
    return stress[:3], np.eye(4)


sagefe.add_law("test_elastic", elastic, parameters={"E": None, "nu": 0.0}, history={"path": 0.0}, symmetric=True)
sagefe.add_law("test_failing", failing, parameters={})
sagefe.add_law("test_wrong_shape", wrong_shape, parameters={})


def test_law_of_python():
    model = layer(law="test_elastic", increments=2, E=20e3, nu=0.25)
    result, own = model.run(), layer(increments=2, youngs_modulus=20e3, poissons_ratio=0.25).run()
    np.testing.assert_allclose(result.report[1].uy, own.report[1].uy, rtol=1e-9)
    np.testing.assert_allclose(result[-1].points.stress, own[-1].points.stress, rtol=1e-7, atol=1e-6)
    np.testing.assert_allclose(result[-1].points["path"], abs(own[-1].points.strain).sum(axis=1), rtol=1e-6)
    curve = sagefe.Law("test_elastic", E=20e3, nu=0.25).drive("oedometer", strain=0.01)
    assert curve.stress_yy[-1] == pytest.approx(24e3 * 0.01, rel=1e-9)  # E (1-nu) / ((1+nu)(1-2nu)) = 24 000


def test_law_of_python_that_fails():
    with pytest.raises(ZeroDivisionError, match="gives up"):
        layer(law="test_failing").run()
    with pytest.raises(ValueError, match="stress of test_wrong_shape must have the shape"):
        layer(law="test_wrong_shape").run()
    with pytest.raises(ZeroDivisionError):
        sagefe.Law("test_failing").drive("oedometer", strain=0.01)
    with pytest.raises(ValueError, match="already"):
        sagefe.add_law("drucker_prager", elastic, parameters={})


def test_two_threads_get_what_one_gets():
    models = [sagefe.read(PLASTIC).with_(stages={1: dict(increments=12)}), sagefe.read(PINNED)]
    alone = [model.run().report[1].force for model in models]
    together = [None, None]

    def work(index):
        together[index] = models[index].run().report[1].force

    threads = [threading.Thread(target=work, args=(index,)) for index in (0, 1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for one, other in zip(alone, together):
        np.testing.assert_array_equal(one, other)


def test_python_goes_on_while_a_run_computes():
    """Without the interpreter's lock let go the counter would stand still for the whole run."""
    model, counts, done = sagefe.read(PLASTIC), [0], threading.Event()

    def count():
        while not done.is_set():
            counts[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    before = counts[0]
    model.run(keep="none")
    during = counts[0] - before
    done.set()
    thread.join()
    assert during >= 3


def test_ctrl_c_ends_a_run():
    program = f"""
import os, signal, threading, time
import sagefe
model = sagefe.read({str(PLASTIC)!r}).with_(stages={{1: dict(increments=1000000)}})
threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    model.run(keep="none")
except KeyboardInterrupt:
    print("interrupted")
print(sagefe.read({str(PINNED)!r}).run().converged)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120)
    assert done.stdout.split() == ["interrupted", "True"], done.stderr


def test_memory_stays_flat():
    """1000 runs: what stays of each must be less than a kilobyte."""
    import resource

    model = layer()
    for _ in range(100):
        model.run()
    gc.collect()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for index in range(1000):
        model.with_(materials={1: dict(E=20e3 + index)}).run()
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    assert grown < 1000  # kB


def test_import_takes_no_time():
    """At most .2 s of the processor, numpy included; matplotlib, meshio and scipy are left until they are used."""
    program = ("import resource, sys; before = resource.getrusage(resource.RUSAGE_SELF).ru_utime; import sagefe; "
               "print(resource.getrusage(resource.RUSAGE_SELF).ru_utime - before, "
               "[m for m in ('matplotlib', 'meshio', 'scipy') if m in sys.modules])")
    times = []
    for _ in range(3):
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
        seconds, _, loaded = done.stdout.strip().partition(" ")
        assert loaded == "[]"
        times.append(float(seconds))
    assert min(times) < 0.2


def test_to_meshio(tmp_path, pinned):
    meshio = pytest.importorskip("meshio")
    mesh = pinned.to_meshio()
    assert mesh.points.shape[0] == 435 and [(c.type, len(c.data)) for c in mesh.cells] == [("quad", 392)]
    np.testing.assert_array_equal(mesh.point_data["displacement"], pinned[-1].nodes.displacement)
    assert mesh.cell_data["stress"][0].shape == (392, 4)
    np.testing.assert_allclose(mesh.cell_data["stress"][0][0], pinned[-1].points.stress[:4].mean(axis=0))
    mesh.write(tmp_path / "state.vtu")
    assert meshio.read(tmp_path / "state.vtu").points.shape[0] == 435


def test_plots(tmp_path, pinned):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    axes = pinned.plot("stress_yy")
    drawn = axes.collections[0].get_array()
    assert len(drawn) == 392 and drawn.max() == pytest.approx(
        pinned[-1].points.stress[:, 1].reshape(392, 4).mean(axis=1).max())
    pinned.plot("displacement", scale=1.0)
    assert pinned.report[1].plot("axial_strain", "ratio").get_xlabel() == "axial_strain"
    with pytest.raises(KeyError, match="which component"):
        pinned.plot("stress")
    with pytest.raises(KeyError, match="no field"):
        pinned.plot("stres")
    pyplot.savefig(tmp_path / "plot.png")
    pyplot.close("all")


def test_place_of_a_stepped_analysis():
    analysis = sagefe.read(PINNED).with_(stages={2: dict(increments=2)}).analysis()
    places = [(state.stage, state.increment, analysis.stage, analysis.increment) for state in analysis]
    assert places == [(1, 1, 1, 1), (2, 1, 2, 1), (2, 2, 2, 2)]
    with pytest.raises(ValueError, match="no increment is left"):
        analysis.set_pressure(1.0, stage=1)
    assert analysis.close().converged


def test_library_solvers_are_found(pinned):
    """Their module is found from the place of the extension module, not from that of the interpreter."""
    result = sagefe.read(PINNED).with_(solver="umfpack").run(strict=True)
    assert result.solver == "umfpack"
    np.testing.assert_allclose(result.report[1].force, pinned.report[1].force, rtol=1e-9)


def test_sweep_gives_the_columns_of_its_table(tmp_path):
    """The chapter's pinned column of L/D = 2 (Table 7.3); the second call computes nothing, so that its journal stays."""
    study = tmp_path / "study.toml"
    study.write_text(f'deck = "{PINNED}"\ncollect = ["report1.ratio"]\n[grid]\nmaterial.1.nu = [0.25, 0.33333333, 0.495]\n')
    table = sagefe.sweep(study, output=tmp_path / "out", jobs=2)
    assert [f"{ratio:.4f}" for ratio in table["report1.ratio"]] == ["1.0181", "1.0344", "1.1189"]
    assert list(table["status"]) == ["ok"] * 3 and list(table["case"]) == [1, 2, 3]
    journal = (tmp_path / "out" / "study.cases.0").read_bytes().split()
    again = sagefe.sweep(str(study), output=str(tmp_path / "out"))
    assert np.array_equal(again["report1.ratio"], table["report1.ratio"])
    assert (tmp_path / "out" / "study.cases.0").read_bytes().split() == journal
    more = sagefe.sweep(study, output=tmp_path / "out", collect=["report1.force.max"])
    assert (more["report1.force.max"] > 0).all()


def test_sweep_reports_mistakes_of_the_study(tmp_path):
    study = tmp_path / "study.toml"
    study.write_text(f'deck = "{PINNED}"\ncollect = ["report1.ration"]\n[grid]\nmaterial.1.nu = [0.25, 0.3]\n')
    with pytest.raises(sagefe.DeckError, match="did you mean report1.ratio"):
        sagefe.sweep(study, output=tmp_path)
    with pytest.raises(TypeError):
        sagefe.sweep(study, output=tmp_path, collect="report1.ratio")
