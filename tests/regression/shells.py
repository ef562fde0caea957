"""Completion, man pages and the texts of messages against the program itself: bash completes on a pseudo terminal as for a
person, and what it offers is what --help and `sagefe list` show.  usage: shells.py SAGEFE SOURCE_FOLDER"""
import fcntl
import json
import os
import pathlib
import pty
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import termios

SAGEFE = str(pathlib.Path(sys.argv[1]).resolve())
SOURCE = pathlib.Path(sys.argv[2]).resolve()
failures = []


def expect(condition, *words):
    if not condition:
        failures.append(" ".join(str(word) for word in words))
        print("FAILED:", failures[-1][:2000])


def output(*arguments, folder=None):
    run = subprocess.run([SAGEFE, *arguments], cwd=folder, capture_output=True, text=True)
    expect(run.returncode == 0, *arguments, "exit code", run.returncode, run.stderr)
    return run.stdout


COMMANDS = re.findall(r"^  (\w+) {2,}\S", output("--help").split("Subcommands:")[1], re.MULTILINE)


def options_of(*command):
    """-o, --output ... at the left edge of the help."""
    names = set()
    for line in output(*command, "--help").splitlines():
        if found := re.match(r"  (-[\w-]+(?:,--?[\w-]+)*)", line):
            names.update(found[1].split(","))
    return names


class Bash:
    """A bash that a person types at; its line is as wide as any answer."""

    def __init__(self, folder):
        pid, self.terminal = pty.fork()
        if pid == 0:
            os.chdir(folder)
            os.environ.update(TERM="dumb", PS1="$ ", LC_ALL="C", PATH=str(folder) + ":" + os.environ["PATH"])
            fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 60000, 0, 0))
            os.execvp("bash", ["bash", "--norc", "--noprofile", "-i"])
        self.data = b""
        self.type("bind 'set enable-bracketed-paste off'; . ./completion; echo READ''Y\n")
        self.read_to(rb"READY\r\n")

    def type(self, text):
        os.write(self.terminal, text.encode())

    def read_to(self, pattern):
        while not (found := re.search(pattern, self.data)):
            self.data += os.read(self.terminal, 65536)
        self.data = self.data[found.end():]
        return found

    def offers(self, line):
        """All words with which the line can go on: Alt-* inserts them, and echo tells."""
        self.type(line + "\033*\001echo SA''ID: \n")
        words = self.read_to(rb"\nSAID: ([^\r\n]*)\r\n")[1].decode().split()
        return words[len(line.split()) - (0 if line.endswith(" ") else 1):]


def check_bash(folder):
    (folder / "completion").write_text(output("completion", "bash"))
    (folder / "sagefe").symlink_to(SAGEFE)
    (folder / "column.dat").write_text("")
    (folder / "libmine.so").write_text("")
    bash = Bash(folder)
    expect(sorted(bash.offers("sagefe ")) == sorted(COMMANDS), "commands", bash.offers("sagefe "))
    expect(bash.offers("sagefe expl") == ["explain"], "one command", bash.offers("sagefe expl"))
    for command in COMMANDS:
        offered, shown = set(bash.offers(f"sagefe {command} -")), options_of(command)
        expect(offered == shown, command, "offers", offered - shown, "and lacks", shown - offered)
    expect(set(bash.offers("sagefe layout guess --")) == {o for o in options_of("layout", "guess") if o[:2] == "--"}, "layout guess")
    expect(bash.offers("sagefe layout ") == ["check", "guess"], "parts of layout", bash.offers("sagefe layout "))
    expect(bash.offers("sagefe new ") == ["deck", "element", "law", "umat"], "new", bash.offers("sagefe new "))
    expect(bash.offers("sagefe completion ") == ["bash", "fish", "zsh"], "completion", bash.offers("sagefe completion "))
    codes = re.findall(r"^(S50\d) ", output("explain"), re.MULTILINE)
    expect(len(codes) > 4 and bash.offers("sagefe explain S50") == codes, "codes", bash.offers("sagefe explain S50"))
    solvers = [one["name"] for one in json.loads(output("list", "solvers", "--json"))["result"]["solvers"]]
    expect(bash.offers("sagefe run --solver ") == sorted(solvers), "solvers", bash.offers("sagefe run --solver "))
    fields = [one["name"] for one in json.loads(output("list", "fields", "--json"))["result"]["fields"]]
    short = ["conf", "dev", "SL", "head", "flow_net", "stream_function", "pore_pressure"]
    expect(set(bash.offers("sagefe run --picture ")) == set(fields + short), "fields", bash.offers("sagefe run --picture "))
    expect(bash.offers("sagefe run --solver=umf") == ["--solver=umfpack"], "behind =", bash.offers("sagefe run --solver=umf"))
    for line in ("sagefe run col", "sagefe check --strict col", "sagefe plot -o out col"):
        expect(bash.offers(line) == ["column.dat"], line, bash.offers(line))
    for line in ("sagefe run --plugin lib", "sagefe check --umat lib", "sagefe conform --umat lib", "sagefe conform lib"):
        expect(bash.offers(line) == ["libmine.so"], line, bash.offers(line))
    bash.type("exit\n")


def check_other_shells(folder):
    for shell in ("zsh", "fish"):
        script = folder / ("completion." + shell)
        script.write_text(output("completion", shell))
        if shutil.which(shell) is None:
            print(shell, "is not installed")
            continue
        run = subprocess.run([shell, "-n", str(script)], capture_output=True, text=True)
        expect(run.returncode == 0 and run.stderr == "", shell, run.stderr)
        if shell == "fish":
            ask = lambda line: subprocess.run(["fish", "--no-config", "-c", f"source {script}; complete -C '{line}'"],
                                              capture_output=True, text=True, env={**os.environ, "HOME": str(folder)}).stdout
            expect({line.split("\t")[0] for line in ask("sagefe ex").splitlines()} == {"explain"}, "fish", ask("sagefe ex"))
            expect("umfpack" in ask("sagefe run --solver umf"), "fish", ask("sagefe run --solver umf"))


def check_man_pages(folder):
    """Those that the build made with help2man; a build without it has none."""
    pages = pathlib.Path(SAGEFE).parent / "share/man/man1"
    if not pages.exists():
        return
    commands = COMMANDS + ["layout-guess", "layout-check"]
    expect(sorted(page.name for page in pages.iterdir()) == sorted(["sagefe.1"] + [f"sagefe-{c}.1" for c in commands]), "pages")
    for page in sorted(pages.iterdir()):
        if shutil.which("man"):
            run = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", str(page)], capture_output=True, text=True,
                                 env={**os.environ, "MANWIDTH": "100", "LC_ALL": "C.UTF-8", "MANROFFOPT": "-ww"})
            expect(run.returncode == 0 and run.stderr == "", page.name, run.stderr)
            if page.name != "sagefe.1":
                command = page.name[7:-2]
                text = re.sub(".\b", "", run.stdout)
                for option in options_of(*command.split("-")):
                    expect(re.search(rf"(^|[\s,]){option}\b", text), page.name, "has no", option)
        if shutil.which("mandoc"):
            run = subprocess.run(["mandoc", "-Tlint", "-W", "warning", str(page)], capture_output=True, text=True)
            expect(run.stdout + run.stderr == "", page.name, run.stdout, run.stderr)


def check_texts(folder):
    """What the catalogue of messages tells people to type or to read is there."""
    options = set.union(*(options_of(command) for command in COMMANDS), options_of("layout", "guess"), options_of("layout", "check"))
    fields = output("list", "fields")
    for entry in json.loads(output("explain", "--json"))["result"]["codes"]:
        text = entry["cause"] + " " + entry["cure"]
        for option in re.findall(r"(?<![\w-])--[a-z][\w-]*", text):
            expect(option in options or option in ("--install",), entry["code"], "names", option)
        # In prose sagefe is a subject: "sagefe reads", "sagefe then stops", "sagefe found".
        prose = "also can cannot cut did divide found itself must or read that then would wrote".split()
        for command in re.findall(r"\bsagefe ([a-z]+)", text):
            verb = command.endswith(("s", "ed")) or command in prose
            expect(verb or command in COMMANDS, entry["code"], "names sagefe", command)
        for field in re.findall(r"--picture ([a-z_]+)", text):
            expect(re.search(rf"^      {field}\b", fields, re.MULTILINE), entry["code"], "names the field", field)
        for file in re.findall(r"\bdocs/[\w/]+(?:\.md)?", text):
            expect((SOURCE / file).exists(), entry["code"], "names", file)
        for code in re.findall(r"\bS[1-9][0-9]{2}\b", text):
            expect(code in output("explain", code), entry["code"], "names", code)


with tempfile.TemporaryDirectory() as name:
    place = pathlib.Path(name)
    for check in (check_texts, check_man_pages, check_bash, check_other_shells):
        check(place)
sys.exit(1 if failures else 0)
