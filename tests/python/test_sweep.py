"""sagefe sweep, as a program: the same table whatever computes it, and every mistake before the first case."""

import csv
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

import pytest

SOURCE = pathlib.Path(os.environ["SAGE_SOURCE_DIR"])
PROGRAM = os.environ["SAGE_EXECUTABLE"]
PINNED = SOURCE / "legacy_inputs" / "chapter7" / "pinned_ld2_nu0495" / "deck.dat"
PLASTIC = SOURCE / "legacy_inputs" / "chapter7" / "dp_285" / "deck.dat"


def study(folder, text, deck=PINNED, name="study"):
    file = folder / f"{name}.toml"
    file.write_text(f'deck = "{deck}"\n{text}')
    return file


def sweep(file, folder, *options, code=0):
    done = subprocess.run([PROGRAM, "sweep", str(file), "-o", str(folder), *options], capture_output=True, text=True,
                          timeout=600)
    assert done.returncode == code, done.stdout + done.stderr
    return done


def rows_of(folder, name="study"):
    with open(folder / f"{name}.sweep.csv", newline="") as file:
        return list(csv.DictReader(file))


TABLE = 'collect = ["report1.ratio"]\n[grid]\n"material.1.nu" = [0.25, 0.33333333, 0.495]\n'


def test_grid_gives_table_7_3(tmp_path):
    """The chapter's pinned column of L/D = 2."""
    done = sweep(study(tmp_path, TABLE), tmp_path)
    rows = rows_of(tmp_path)
    assert [f"{float(row['report1.ratio']):.4f}" for row in rows] == ["1.0181", "1.0344", "1.1189"]
    assert [row["case"] for row in rows] == ["1", "2", "3"] and {row["status"] for row in rows} == {"ok"}
    assert "3 computed, 0 kept" in done.stdout
    assert (tmp_path / "study.sweep.svg").read_text().startswith("<svg")


def test_a_model_file_has_the_answers_of_its_deck(tmp_path):
    """Parameters of materials, stages and reports, by the same names."""
    model = tmp_path / "pinned.sage.toml"
    subprocess.run([PROGRAM, "convert", str(PINNED), str(model)], check=True, capture_output=True)
    text = ('collect = ["report1.ratio", "report1.force"]\n[grid]\n"material.1.nu" = [0.25, 0.495]\n'
            '"stage.2.increments" = [5, 10]\n"report.1.cell_pressure" = [50, 60]\n')
    sweep(study(tmp_path, text), tmp_path / "cards")
    sweep(study(tmp_path, text, model, "drawn"), tmp_path / "drawn")
    cards, drawn = rows_of(tmp_path / "cards"), rows_of(tmp_path / "drawn", "drawn")
    assert len(cards) == 8 and [row["report1.ratio"] for row in cards] == [row["report1.ratio"] for row in drawn]
    assert [row["report1.force"] for row in cards] == [row["report1.force"] for row in drawn]
    assert len({row["report1.ratio"] for row in drawn}) > 1


def test_finished_cases_are_kept(tmp_path):
    file = study(tmp_path, TABLE)
    sweep(file, tmp_path)
    first = (tmp_path / "study.sweep.csv").read_bytes()
    assert "0 computed, 3 kept" in sweep(file, tmp_path).stdout
    assert (tmp_path / "study.sweep.csv").read_bytes() == first
    study(tmp_path, TABLE.replace("0.25,", "0.25, 0.3,"))
    assert "1 computed, 3 kept" in sweep(file, tmp_path).stdout
    assert "4 computed, 0 kept" in sweep(file, tmp_path, "--collect", "report1.force.max").stdout  # other options


def test_each_case_has_a_page_of_its_own(tmp_path):
    """Though its outcome is kept, and never that of another study's case of the same number."""
    file = study(tmp_path, TABLE)
    sweep(file, tmp_path)
    assert "page" not in rows_of(tmp_path)[0]
    assert "3 computed, 0 kept" in sweep(file, tmp_path, "--report").stdout
    pages = {row["material.1.nu"]: row["page"] for row in rows_of(tmp_path)}
    assert len(set(pages.values())) == 3
    for nu, page in pages.items():
        assert f"material.1.nu = {float(nu):.6g}" in (tmp_path / page).read_text()
        assert (tmp_path / page.replace(".html", ".report1.csv")).exists()
    assert all(page in (tmp_path / "study.sweep.html").read_text() for page in pages.values())
    assert "0 computed, 3 kept" in sweep(file, tmp_path, "--report").stdout
    (tmp_path / pages["0.25"]).unlink()
    study(tmp_path, TABLE.replace("[0.25, 0.33333333, 0.495]", "[0.495, 0.25]"))
    assert "1 computed, 1 kept" in sweep(file, tmp_path, "--report").stdout
    assert [row["page"] for row in rows_of(tmp_path)] == [pages["0.495"], pages["0.25"]]


def test_same_bytes_for_any_number_of_workers_and_after_kills(tmp_path):
    text = ('collect = ["report1.ratio", "report1.force.max"]\n[grid]\n'
            '"material.1.nu" = {from = 0.1, to = 0.49, count = 60}\n"material.1.E" = [1000, 3000, 9000]\n')
    file = study(tmp_path, text)
    tables = []
    for jobs in ("1", "2", "5"):
        sweep(file, tmp_path / jobs, "-j", jobs)
        tables.append((tmp_path / jobs / "study.sweep.csv").read_bytes())
    killed = tmp_path / "killed"
    for pause in (0.05, 0.1, 0.15):
        process = subprocess.Popen([PROGRAM, "sweep", str(file), "-o", str(killed), "-j", "2"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(pause)
        process.send_signal(signal.SIGKILL)
        process.wait()
    sweep(file, killed)
    tables.append((killed / "study.sweep.csv").read_bytes())
    assert len(set(tables)) == 1
    keys = [line.split("\t")[0] for journal in killed.glob("study.cases.*") for line in journal.read_text().split("\n")
            if line.count("\t") == 5]
    assert len(keys) == len(set(keys)) == 180  # no case ran twice


def test_parts_are_merged(tmp_path):
    file = study(tmp_path, TABLE)
    sweep(file, tmp_path / "whole")
    for part in ("2/2", "1/2"):
        sweep(file, tmp_path / "parts", "--part", part)
    assert not (tmp_path / "parts" / "study.sweep.csv").exists()
    assert "0 computed, 3 kept" in sweep(file, tmp_path / "parts").stdout
    assert (tmp_path / "parts" / "study.sweep.csv").read_bytes() == (tmp_path / "whole" / "study.sweep.csv").read_bytes()


def test_interrupt_goes_on(tmp_path):
    file = study(tmp_path, 'collect = ["report1.ratio"]\n[grid]\n"material.1.nu" = {from = 0.1, to = 0.49, count = 4000}\n')
    process = subprocess.Popen([PROGRAM, "sweep", str(file), "-o", str(tmp_path), "-j", "1"], stderr=subprocess.PIPE, text=True)
    time.sleep(0.7)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 5 and "the same command goes on" in err
    assert not (tmp_path / "study.sweep.csv").exists()


def test_pairs_cases_and_fixed_values(tmp_path):
    file = study(tmp_path, """
collect = ["report1.ratio", "run.increments"]
[set]
stage.2.increments = 2
[pairs]
material.1.nu = [0.2, 0.3]
material.1.E = [1000, 2000]
[[case]]
formulation = "b-bar"
""")
    sweep(file, tmp_path)
    rows = rows_of(tmp_path)
    assert [(row["material.1.nu"], row["material.1.E"], row["formulation"]) for row in rows] == [
        ("0.2", "1000", ""), ("0.3", "2000", ""), ("", "", "b-bar")]
    assert {row["run.increments"] for row in rows} == {"3"}
    assert abs(float(rows[2]["report1.ratio"]) - 1.086254) < 5e-3  # hp finite elements, tables.csv


def test_equal_models_are_named(tmp_path):
    done = sweep(study(tmp_path, TABLE.replace("0.25,", "0.3, 0.25, 0.3,")), tmp_path)
    rows = rows_of(tmp_path)
    assert [row["same_as"] for row in rows] == ["", "", "1", "", ""]
    assert rows[0]["report1.ratio"] == rows[2]["report1.ratio"]
    assert "1 and 3" in done.stdout and "4 computed" in done.stdout


def test_failures_are_rows_with_their_reason(tmp_path):
    file = study(tmp_path, """
collect = ["report1.ratio"]
[grid]
material.1.nu = [0.3, 0.6]
material.1.E = [3000, 1e-3]
""")
    sweep(file, tmp_path)
    rows = rows_of(tmp_path)
    assert rows[0]["status"] == "ok"
    assert rows[2]["status"] == "input" and rows[2]["report1.ratio"] == "" and "S224" in rows[2]["reason"]
    assert rows[1]["status"] in ("ok", "warning") and len(rows) == 4


def test_warnings_that_the_deck_has_not_are_failures(tmp_path):
    """nu = .495 locks with full integration (S325): the deck has that warning itself; with .3 in the deck it is new."""
    text = 'collect = ["report1.ratio"]\n[grid]\nmaterial.1.nu = [0.25, 0.495]\n'
    other = SOURCE / "legacy_inputs" / "chapter7" / "pinned_ld2_nu025" / "deck.dat"
    sweep(study(tmp_path, text, other), tmp_path)
    rows = rows_of(tmp_path)
    assert [row["status"] for row in rows] == ["ok", "warning"] and "S325" in rows[1]["reason"]
    sweep(study(tmp_path, 'allow = ["S325"]\n' + text, other), tmp_path)
    assert [row["status"] for row in rows_of(tmp_path)] == ["ok", "ok"]


@pytest.mark.parametrize("text, code, words", [
    ('[grid]\n"material.1.nus" = [0.2, 0.3]\n', "S730", "did you mean material.1.nu"),
    ('[grid]\n"material.1.nu" = [0.2, "0.3"]\n', "S731", "finite number"),
    ('[grid]\n"stage.2.increments" = [1, 2.5]\n', "S731", "whole number"),
    ('[grid]\n"material.1.nu" = [0.2, 0.3]\n"material.1.poissons_ratio" = [0.2, 0.3]\n', "S731", "the same number"),
    ('[grid]\n"material.1.nu" = []\n', "S732", "list of values"),
    ('[gird]\n"material.1.nu" = [0.2]\n', "S732", "did you mean grid"),
    ('[set]\n"material.1.nu" = 0.2\n', "S732", "no case"),
    ('[pairs]\n"material.1.nu" = [0.2, 0.3]\n"material.1.E" = [1]\n', "S732", "one length"),
    ('[set]\n"material.1.nu" = 0.2\n[grid]\n"material.1.nu" = [0.3]\n', "S732", "two places"),
    ('[random]\ndraws = 3\nseed = 1\n[random.variables]\nmaterial.1.nu = {distribution = "gauss", mean = 1, sd = 1}\n',
     "S732", "normal, lognormal or uniform"),
    ('[random]\ndraws = 3\nseed = 1\ncorrelation = [[1, 0.5], [0.4, 1]]\n[random.variables]\n'
     'material.1.nu = {distribution = "normal", mean = 0.3, sd = 0.01}\n'
     'material.1.E = {distribution = "normal", mean = 3000, sd = 1}\n', "S732", "symmetric"),
    ('[grid]\n"material.1.nu" = [0.2\n', "S732", ""),
    ('[grid]\n"material.1.nu" = [0.2, 0.3]\n[failure]\nwhen = "report1.ratio above 2"\n', "S732", "< or >"),
    ('[grid]\n"material.1.nu" = [0.2, 0.3]\n[failure]\nwhen = "report1.rato > 2"\n', "S734", "did you mean report1.ratio"),
    ('[grid]\n"material.1.nu" = [0.2, 0.3]\n[plot]\nx = "material.1.nv"\n', "S734", "did you mean material.1.nu"),
])
def test_mistakes_show_before_the_first_case(tmp_path, text, code, words):
    file = study(tmp_path, 'collect = ["report1.ratio"]\n' + text)
    done = sweep(file, tmp_path / "out", code=2)
    assert code in done.stderr and words in done.stderr
    assert not list((tmp_path / "out").glob("*.csv"))
    journal = tmp_path / "out" / "study.cases.0"
    assert not journal.exists() or not journal.read_text().strip()


def test_unknown_quantities(tmp_path):
    done = sweep(study(tmp_path, TABLE.replace("ratio", "ration")), tmp_path, code=2)
    assert "S734" in done.stderr and "did you mean report1.ratio" in done.stderr
    done = sweep(study(tmp_path, TABLE.replace('collect = ["report1.ratio"]', "")), tmp_path, code=2)
    assert "what is to be collected" in done.stderr


def test_values_that_nothing_reads(tmp_path):
    """A material that no group has, and a weight without gravity."""
    deck = tmp_path / "deck.dat"
    text = PINNED.read_text()
    lines = text.splitlines()
    control = next(i for i, line in enumerate(lines) if line.startswith("    2    0    4    1    1"))
    lines[control] = "    2    0    4    1    2" + lines[control][25:]
    group = next(i for i, line in enumerate(lines) if line.startswith("    1    1    1    1specimen"))
    lines[group - 1:group - 1] = ["    2    1    2          spare", "     3000.      .3"]
    deck.write_text("\n".join(lines) + "\n")
    file = study(tmp_path, 'collect = ["report1.ratio"]\n[grid]\nmaterial.spare.nu = [0.2, 0.3]\n', deck)
    done = sweep(file, tmp_path, code=2)
    assert "S734" in done.stderr and "no group has this material" in done.stderr


RANDOM = """
collect = ["report1.measured_deviator"]
[random]
draws = 200
seed = 12
correlation = [[1, -0.5], [-0.5, 1]]
[random.variables]
material.1.E = {distribution = "lognormal", mean = 3000, cov = 0.1}
material.1.nu = {distribution = "normal", mean = 0.3, sd = 0.02, low = 0.2, high = 0.4}
[failure]
when = "report1.measured_deviator < 300"
"""


def test_random_draws_and_probability(tmp_path):
    """The deviator is near E * 10 %, so that it is below 300 psi in near half of the cases: the sorted table says how many."""
    file = study(tmp_path, RANDOM)
    done = sweep(file, tmp_path, "--json")
    answer = json.loads(done.stdout)["result"]
    rows = rows_of(tmp_path)
    failures = sum(float(row["report1.measured_deviator"]) < 300 for row in rows)
    assert sum(row["fails"] == "1" for row in rows) == failures
    (probability,) = answer["probability"]
    assert probability["probability"] == failures / 200 and (probability["failures"], probability["cases"]) == (failures, 200)
    assert probability["low"] < failures / 200 < probability["high"] < 1
    assert 40 < failures < 120
    study(tmp_path, RANDOM.replace("draws = 200", "draws = 210"))
    assert "10 computed, 200 kept" in sweep(file, tmp_path).stdout  # the first draws are the same
    study(tmp_path, RANDOM.replace("seed = 12", "seed = 13"))
    assert "200 computed, 0 kept" in sweep(file, tmp_path).stdout


def test_ten_thousand_cases_take_little_time_each(tmp_path):
    """6 ms of one core for a case of the 14 x 28 deck; measured as processor time of 300, a sanitizer build takes longer."""
    import resource

    file = study(tmp_path, 'collect = ["report1.ratio"]\n[grid]\nmaterial.1.nu = {from = 0.1, to = 0.49, count = 300}\n')
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    sweep(file, tmp_path)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    assert seconds < 300 * (0.006 if "release" in PROGRAM else 0.2)


def test_gnu_parallel_gives_the_same_table(tmp_path):
    file = study(tmp_path, TABLE)
    if shutil.which("parallel") is None:
        done = sweep(file, tmp_path, "--parallel", "2", code=1)
        assert "S737" in done.stderr
        pytest.skip("there is no GNU parallel on this machine")
    sweep(file, tmp_path / "whole")
    assert "0 computed, 3 kept" in sweep(file, tmp_path / "parts", "--parallel", "2").stdout
    assert (tmp_path / "parts" / "study.sweep.csv").read_bytes() == (tmp_path / "whole" / "study.sweep.csv").read_bytes()


MANY = ('collect = ["report1.ratio"]\n[grid]\n"material.1.nu" = {from = 0.1, to = 0.49, count = 300}\n')


def kill_worker(process, part, folder):
    """Ends the worker of that part of `folder`, once it has finished some cases."""
    deadline = time.monotonic() + 60
    while process.poll() is None and time.monotonic() < deadline:
        number = part.split("/")[0]
        journal = folder / f"study.cases.{number}"
        if journal.exists() and journal.read_bytes().count(b"\n") > 3:
            for cmdline in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
                try:
                    words = cmdline.read_bytes().split(b"\0")
                except OSError:
                    continue
                if words[0].endswith(b"sagefe") and part.encode() in words and str(folder).encode() in words:
                    os.kill(int(cmdline.parent.name), signal.SIGKILL)
                    return True
        time.sleep(0.005)
    return False


def expect_same_after_kill(tmp_path, option, environment=None):
    file = study(tmp_path, MANY)
    sweep(file, tmp_path / "whole")
    parts = tmp_path / "parts"
    process = subprocess.Popen([PROGRAM, "sweep", str(file), "-o", str(parts), option, "2"], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True, env=environment)
    killed = kill_worker(process, "1/2", parts)
    out, err = process.communicate(timeout=120)
    assert killed and process.returncode == 0, out + err
    assert (parts / "study.sweep.csv").read_bytes() == (tmp_path / "whole" / "study.sweep.csv").read_bytes()
    keys = [line.split("\t")[0] for journal in parts.glob("study.cases.*") for line in journal.read_text().split("\n")
            if line.count("\t") == 5]
    assert len(keys) == len(set(keys)) == 300  # no case ran twice


def test_gnu_parallel_after_the_kill_of_a_worker(tmp_path):
    if shutil.which("parallel") is None:
        pytest.skip("there is no GNU parallel on this machine (apt-get install parallel)")
    expect_same_after_kill(tmp_path, "--parallel")


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    try:
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]
    finally:
        for one in sockets:
            one.close()


@pytest.fixture
def slurm(tmp_path):
    """A cluster of this machine alone: munge and Slurm with a socket, ports and a state folder of their own.  Ends with the test."""
    if os.geteuid() != 0:
        pytest.skip("starting Slurm needs root")
    missing = [tool for tool in ("munged", "slurmctld", "slurmd", "sbatch", "sinfo") if shutil.which(tool) is None]
    if missing:
        pytest.skip(f"{', '.join(missing)} not found (apt-get install slurm-wlm munge)")
    folder = tmp_path / "slurm"
    for name in ("state", "spool"):
        (folder / name).mkdir(parents=True)
    key = folder / "key"
    key.write_bytes(os.urandom(1024))
    key.chmod(0o600)
    host = socket.gethostname().split(".")[0]
    ports = free_ports(2)
    config = folder / "slurm.conf"
    config.write_text(f"""
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket={folder}/socket
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/ctld.pid
SlurmdPidFile={folder}/d.pid
SlurmctldLogFile={folder}/ctld.log
SlurmdLogFile={folder}/d.log
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,batch_sched_delay=0
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={min(2, os.cpu_count() or 1)} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
""")
    environment = {**os.environ, "SLURM_CONF": str(config)}
    munge = ["munged", "--force", "--foreground", *(f"--{name}-file={folder}/{name}" for name in ("key", "pid", "log", "seed")),
             f"--socket={folder}/socket"]
    started = []
    try:
        for command, ready in ((munge, lambda: (folder / "socket").exists()), (["slurmctld", "-D"], lambda: sinfo(environment)),
                               (["slurmd", "-D"], lambda: "idle" in sinfo(environment))):
            started.append(subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
            deadline = time.monotonic() + 30
            while not ready():
                if started[-1].poll() is not None or time.monotonic() > deadline:
                    pytest.skip(f"{command[0]} does not start here")
                time.sleep(0.1)
        yield environment
    finally:
        for one in reversed(started):
            one.terminate()
            one.wait(timeout=60)


def sinfo(environment):
    return subprocess.run(["sinfo", "-h", "-o", "%T"], env=environment, capture_output=True, text=True, timeout=60).stdout


def test_slurm_gives_the_same_table(tmp_path, slurm):
    file = study(tmp_path, TABLE)
    sweep(file, tmp_path / "whole")
    done = subprocess.run([PROGRAM, "sweep", str(file), "-o", str(tmp_path / "parts"), "--slurm", "2"], capture_output=True,
                          text=True, env=slurm, timeout=120)
    assert done.returncode == 0, done.stderr
    assert "0 computed, 3 kept" in done.stdout
    assert "#SBATCH --array=1-2" in (tmp_path / "parts" / "study.slurm.sh").read_text()
    assert (tmp_path / "parts" / "study.sweep.csv").read_bytes() == (tmp_path / "whole" / "study.sweep.csv").read_bytes()


def test_slurm_after_the_kill_of_a_worker(tmp_path, slurm):
    expect_same_after_kill(tmp_path, "--slurm", slurm)


def test_without_slurm(tmp_path):
    """With an sbatch of the test's own, which runs the array one after the other."""
    file = study(tmp_path, TABLE)
    sweep(file, tmp_path / "whole")
    tools = tmp_path / "tools"
    tools.mkdir()
    (tools / "sbatch").write_text(
        "#!/bin/sh\nfor i in 1 2; do SLURM_ARRAY_TASK_ID=$i sh \"$2\" || exit 1; done\n")
    (tools / "sbatch").chmod(0o755)
    done = subprocess.run([PROGRAM, "sweep", str(file), "-o", str(tmp_path / "parts"), "--slurm", "2"],
                          capture_output=True, text=True, env={**os.environ, "PATH": f"{tools}:{os.environ['PATH']}"})
    assert done.returncode == 0, done.stderr
    assert "0 computed, 3 kept" in done.stdout
    assert "#SBATCH --array=1-2" in (tmp_path / "parts" / "study.slurm.sh").read_text()
    assert (tmp_path / "parts" / "study.sweep.csv").read_bytes() == (tmp_path / "whole" / "study.sweep.csv").read_bytes()


FIELDS = """
collect = ["report1.measured_deviator"]
[random]
draws = 4
seed = 12
[random.variables]
material.1.E = {distribution = "lognormal", mean = 3000, cov = 0.3, correlation_length = [0.4, 0.2]}
"""


def test_random_fields_are_another_in_each_draw(tmp_path):
    """A specimen of E between the harmonic and the arithmetic mean of its points: draws differ, and by less than single values
    would (cov .3), since the specimen is several correlation lengths long.  The same study gives the same bytes."""
    sweep(study(tmp_path, FIELDS), tmp_path)
    first = (tmp_path / "study.sweep.csv").read_bytes()
    deviators = [float(row["report1.measured_deviator"]) for row in rows_of(tmp_path)]
    assert len(set(deviators)) == 4
    (even,) = (float(row["report1.measured_deviator"]) for row in _even(tmp_path))
    mean = sum(deviators) / 4
    assert 0.7 * even < mean < 1.1 * even
    assert max(abs(one / mean - 1) for one in deviators) < 0.3
    sweep(study(tmp_path, FIELDS), tmp_path / "again", "-j", "1")
    assert (tmp_path / "again" / "study.sweep.csv").read_bytes() == first


def _even(folder):
    sweep(study(folder, 'collect = ["report1.measured_deviator"]\n[grid]\nmaterial.1.E = [3000]\n', name="even"), folder)
    return rows_of(folder, "even")


@pytest.mark.parametrize("name, words", [
    ("stage.2.displacement_factor", "can't differ from place to place"),
    ("material.1.unit_weight", "can't differ from place to place"),
])
def test_fields_are_of_parameters_of_laws(tmp_path, name, words):
    text = FIELDS.replace("material.1.E", name)
    assert words in sweep(study(tmp_path, text), tmp_path, code=2).stderr


def test_field_variables_are_checked(tmp_path):
    done = sweep(study(tmp_path, FIELDS.replace("[0.4, 0.2]", "0")), tmp_path, code=2)
    assert "S732" in done.stderr and "above 0" in done.stderr
