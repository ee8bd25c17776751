#!/usr/bin/env python3
"""Runs one sweep in every way there is, and holds the tables against each other, byte by byte.

python3 tests/engines/engines.py FEM WORK [KILLS]

FEM is the command, WORK a folder for all that is made, KILLS how often workers of one machine are killed (default 40). One thread, two
threads, parts by GNU parallel, workers and gathers that are killed at random moments, a real Slurm on this machine and HyperQueue's
engine, both with workers killed under them. What is missing is installed: Debian's slurm-wlm, munge and parallel, and HyperQueue's wheel
of PyPI into the environment of this Python. The wheel has the engine without its command `hq`, so a small one that speaks to it stands in.
"""

import os
import pathlib
import random
import shutil
import signal
import socket
import subprocess
import sys
import time

EXAMPLE = pathlib.Path(__file__).resolve().parents[2] / "examples/as4-3502-8ply-25mm"
SETS = ["laminate.plies=[0/45/-45/90]s,[45/-45/0/90]s", "impactor.velocity=1.5..3:10", "impactor.mass=0.1..0.5:8"]
CASES = 160
SCATTER = ["materials.as4-3502.Yt=normal(64 MPa, 8 %)", "materials.as4-3502.S12=normal(109 MPa, 8 %)", "impactor.velocity=normal(2.5 m/s, 5 %)"]
SAMPLES = ["--samples", "24", "--seed", "7"]
CORRELATED = "--correlate=materials.as4-3502.Yt,materials.as4-3502.S12=0.6"
PATIENCE = 60

HQ = """#!{python}
import sys
from hyperqueue import Client, Job
words = sys.argv[1:]
if words[:2] == ["job", "cancel"]:
    sys.exit(0)
assert words[:4] == ["--output-mode", "quiet", "submit", "--wait"], words
numbers = words[words.index("--array") + 1].split(",")
log = words[words.index("--stdout") + 1]
command = words[words.index("--") + 1:]
client, job = Client({folder!r}), Job(max_fails=None)
for k in numbers:
    path = log.replace("%{{TASK_ID}}", k)
    job.program(["env", f"HQ_TASK_ID={{k}}", *command], stdout=path, stderr=path + ".err")
submitted = client.submit(job)
print(submitted.id, flush=True)
client.wait_for_jobs([submitted], raise_on_error=False)
"""


class Test:
    def __init__(self, fem, work):
        self.fem, self.work = str(pathlib.Path(fem).resolve()), pathlib.Path(work).resolve()
        shutil.rmtree(self.work, ignore_errors=True)
        shutil.copytree(EXAMPLE, self.work / "plate", ignore=shutil.ignore_patterns("results*"))
        scene = self.work / "plate/scene.toml"
        text = scene.read_text()
        assert 'end = "1 ms"' in text
        quick = '\n[reduction]\nmethod = "ritz"\nvectors = 20\n\n[output]\nplots = false\n'
        scene.write_text(text.replace('end = "1 ms"', 'end = "0.3 ms"') + quick)
        self.environment = dict(os.environ)
        self.table = None

    def command(self, out, *words, sets=SETS):
        sets = [word for pair in sets for word in ("--set", pair)]
        return [self.fem, "sweep", str(self.work / "plate/scene.toml"), *sets, "--out", str(self.work / out), "--quiet", *words]

    def run(self, out, *words, sets=SETS):
        done = subprocess.run(self.command(out, *words, sets=sets), env=self.environment, capture_output=True, text=True, timeout=300)
        if done.returncode != 0:
            raise SystemExit(f"{out}: {done.returncode} {done.stdout} {done.stderr}")

    def same(self, out, what):
        table = (self.work / out / "sweep.csv").read_bytes()
        self.table = self.table or table
        assert table.count(b"\n") == CASES + 1, f"{what}: {table.count(10)} lines"
        assert table == self.table, f"{what}: another table"
        print(f"ok: {what}", flush=True)

    def workers(self, out):
        """Processes that march a part of the sweep in `out`."""
        found = []
        for folder in pathlib.Path("/proc").iterdir():
            if folder.name.isdigit():
                try:
                    words = (folder / "cmdline").read_bytes().decode(errors="replace").split("\0")
                except OSError:
                    continue
                ours = any(word in (f"--out={self.work / out}", str(self.work / out)) for word in words)
                if words[0] == self.fem and ours and any(word.startswith("--part=") for word in words):
                    found.append(int(folder.name))
        return found


def kill(process):
    try:
        os.kill(process, signal.SIGKILL)
        return 1
    except ProcessLookupError:
        return 0


def one_machine(test, kills):
    begun = os.times()
    test.run("one", "--threads", "1")
    one = os.times()
    test.same("one", "one worker")
    test.run("two", "--threads", "2")
    test.same("two", "two workers")
    spent = one.children_user + one.children_system - begun.children_user - begun.children_system
    print(f"   {spent:.1f} s of processors for {CASES} cases")

    line = " ".join(f"'{word}'" for word in test.command("parallel", "--part"))
    subprocess.run(["parallel", "--will-cite", "-j2", f"{line} {{}}/4", ":::", "1", "2", "3", "4"], check=True, env=test.environment)
    test.run("parallel", "--gather")
    test.same("parallel", "parts by GNU parallel, two at a time")

    random.seed(1)
    rounds = killed = 0
    out, part = "killed", ["--part", "1/1", "--resume"]
    while True:
        worker = subprocess.Popen(test.command(out, *part), env=test.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        rounds += 1
        try:
            assert worker.wait(timeout=random.uniform(0.02, 0.7) if killed < kills else 300) == 0
        except subprocess.TimeoutExpired:
            worker.kill()
            worker.wait()
            killed += 1
            continue
        if killed >= kills:
            break
        # Once more from the beginning, until it was killed often enough.
        shutil.rmtree(test.work / out)
    for _ in range(6):
        gather = subprocess.Popen(test.command(out, "--gather"), env=test.environment, stdout=subprocess.DEVNULL)
        time.sleep(random.uniform(0.0, 0.1))
        gather.kill()
        gather.wait()
    test.run(out, "--gather")
    test.same(out, f"a worker that was killed {killed} times at random moments, and six gathers")

    # The same part twice at a time, and parts of another division beside: each case counts once.
    twice = [subprocess.Popen(test.command("twice", "--part", "1/2", "--resume"), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for _ in range(2)]
    [process.wait() for process in twice]
    for part in ("1/2", "2/2", "2/3"):
        test.run("twice", "--part", part, "--resume")
    test.run("twice", "--gather")
    test.same("twice", "duplicate parts")


def under(test, engine, parts, kills):
    """The sweep by `engine`, while its workers are killed."""
    started = subprocess.Popen(test.command(engine, "--engine", engine, "--parts", str(parts)), env=test.environment,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    killed, until = 0, time.monotonic() + 3 * PATIENCE
    while started.poll() is None and time.monotonic() < until:
        workers = test.workers(engine)
        # One is left alone: three rounds without a case, and the sweep gives up.
        if len(workers) > 1 and killed < kills:
            time.sleep(random.uniform(0.0, 0.3))
            killed += kill(random.choice(workers))
        time.sleep(0.05)
    if started.poll() is None:
        started.kill()
    said = started.communicate()[0]
    if started.returncode != 0:
        logs = "".join(log.read_text() for log in sorted((test.work / engine).glob("part-*.log"))[:3])
        raise SystemExit(f"{engine}: {started.returncode} {said} {logs}")
    test.same(engine, f"{engine}, {killed} workers killed")


def slurm(test):
    folder, host = test.work / "slurm-here", socket.gethostname().split(".")[0]
    for name in ("state", "spool"):
        (folder / name).mkdir(parents=True)
    key, munge = folder / "munge.key", folder / "munge.socket"
    key.write_bytes(random.Random(time.time_ns()).randbytes(1024))
    key.chmod(0o400)
    ports = []
    for _ in range(2):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            ports.append(probe.getsockname()[1])
    conf = folder / "slurm.conf"
    conf.write_text(f"""ClusterName=fem
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={munge}
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=2
JobAcctGatherType=jobacct_gather/none
JobCompType=jobcomp/filetxt
JobCompLoc={folder}/jobs.txt
MpiDefault=none
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={os.cpu_count()} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
""")
    test.environment["SLURM_CONF"] = str(conf)
    daemons = []
    try:
        files = [f"--{name}={folder}/munge.{name}" for name in ("pid-file", "log-file", "seed-file")]
        start = lambda *words: daemons.append(subprocess.Popen(words, env=test.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
        start("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={munge}", *files)
        wait("munged", munge.exists)
        start("slurmctld", "-D", "-f", str(conf))
        start("slurmd", "-D", "-f", str(conf), "-N", host)
        idle = lambda: "idle" in subprocess.run(["sinfo", "-h", "-o", "%t"], env=test.environment, capture_output=True, text=True).stdout
        wait("slurm", idle)
        under(test, "slurm", 6, 6)
    finally:
        for daemon in reversed(daemons):
            daemon.terminate()
            try:
                daemon.wait(timeout=10)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()


def hyperqueue(test):
    from hyperqueue.cluster import LocalCluster, WorkerConfig

    commands, folder = test.work / "bin", test.work / "hyperqueue-here"
    commands.mkdir()
    hq = commands / "hq"
    hq.write_text(HQ.format(python=sys.executable, folder=str(folder)))
    hq.chmod(0o755)
    test.environment["PATH"] = f"{commands}:{test.environment['PATH']}"
    with LocalCluster(str(folder), WorkerConfig(cores=2)):
        under(test, "hyperqueue", 6, 6)
        scatter(test, "hyperqueue")


def scatter(test, engine):
    """Samples that are correlated are the same ones in every worker of an engine."""
    ways = {"scatter": [CORRELATED], "scatter-parts": [CORRELATED, "--engine", engine, "--parts", "3"], "uncorrelated": []}
    for out, words in ways.items():
        test.run(out, *SAMPLES, *words, sets=SCATTER)
    one, parts, uncorrelated = ((test.work / out / "sweep.csv").read_bytes() for out in ways)
    assert one.count(b"\n") == 25, one
    assert one == parts, "correlated samples: another table"
    assert one != uncorrelated, "nothing is correlated"
    print(f"ok: correlated samples by {engine}", flush=True)


def wait(what, there):
    until = time.monotonic() + PATIENCE
    while not there():
        if time.monotonic() > until:
            raise SystemExit(f"{what} does not start")
        time.sleep(0.1)


def install():
    packages = {"sbatch": "slurm-wlm", "munged": "munge", "parallel": "parallel"}
    missing = [package for command, package in packages.items() if not shutil.which(command, path=os.environ["PATH"] + ":/usr/sbin")]
    if missing:
        quiet = {"check": True, "stdout": subprocess.DEVNULL}
        subprocess.run(["apt-get", "update"], **quiet)
        subprocess.run(["apt-get", "install", "-y", "--no-install-recommends", *missing], **quiet)
    try:
        import hyperqueue  # noqa: F401
    except ImportError:
        subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "hyperqueue"], check=True)


def main(fem, work, kills=40):
    install()
    os.environ["PATH"] += ":/usr/sbin"
    test = Test(fem, work)
    without = dict(test.environment, PATH="/nowhere")
    for engine, remedy in (("slurm", "slurm-client"), ("hyperqueue", "hq server start")):
        done = subprocess.run(test.command("nothing", "--engine", engine), env=without, capture_output=True, text=True)
        assert done.returncode == 1 and remedy in " ".join(done.stderr.split()), done.stderr
    print("ok: an engine that is not there says what to install")
    one_machine(test, int(kills))
    slurm(test)
    hyperqueue(test)


if __name__ == "__main__":
    main(*sys.argv[1:])
