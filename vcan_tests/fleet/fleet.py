"""A fleet on this computer, for tests: its own PostgreSQL cluster, gateways with simulated machines, agents; all can be killed."""
import collections
import json
import os
import pathlib
import pwd
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).parent.parent))
from patience import until  # noqa: E402

POSTGRES = sorted(pathlib.Path("/usr/lib/postgresql").glob("*/bin/postgres"))


class Process:
    """A program that is started again and again; it has a process group of its own."""

    def __init__(self, log, *arguments, user=None):
        self.log, self.arguments, self.user, self.process = log, [str(a) for a in arguments], user, None

    def start(self):
        with self.log.open("a") as log:
            self.process = subprocess.Popen(self.arguments, stdout=log, stderr=log, start_new_session=True, user=self.user)

    def kill(self):
        """As a power cut: all its processes at once."""
        self.signal(signal.SIGKILL)
        self.process.wait()

    def signal(self, number):
        os.killpg(self.process.pid, number)

    def stop(self):
        if self.process and self.process.poll() is None:
            self.kill()


class Database(Process):
    """PostgreSQL does not run as root: then it is run by Debian's user for it."""

    def __init__(self, folder):
        self.folder = folder / "database"
        self.folder.mkdir()
        user = None
        if os.geteuid() == 0:
            user = "postgres"
            for path in (folder, self.folder):
                os.chown(path, pwd.getpwnam(user).pw_uid, -1)
        data = self.folder / "data"
        subprocess.run([POSTGRES[-1].parent / "initdb", "-D", data, "-A", "trust", "-U", "fleet", "--no-instructions"], check=True,
                       stdout=subprocess.DEVNULL, user=user, cwd="/")
        super().__init__(folder / "database.log", POSTGRES[-1], "-D", data, "-k", self.folder, "-c", "listen_addresses=", "-c",
                         "max_connections=40", user=user)
        self.where = f"host={self.folder} user=fleet dbname=postgres"

    def answers(self):
        return subprocess.run([POSTGRES[-1].parent / "pg_isready", "-q", "-h", self.folder], check=False).returncode == 0


class Broker(Process):
    """Mosquitto, which forgets all when it is killed."""

    def __init__(self, folder):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        settings = folder / "mosquitto.conf"
        settings.write_text(f"listener {self.port} 127.0.0.1\nallow_anonymous true\npersistence false\n")
        super().__init__(folder / "broker.log", shutil.which("mosquitto") or "/usr/sbin/mosquitto", "-c", settings)

    def hear(self, topic, count, seconds=20):
        """The next messages as (topic, payload), fewer when no more come within the time."""
        heard = subprocess.run(["mosquitto_sub", "-p", str(self.port), "-t", topic, "-C", str(count), "-W", str(seconds), "-F", "%t %x"],
                               check=False, text=True, capture_output=True)
        return [(line.split()[0], bytes.fromhex(line.split()[1])) for line in heard.stdout.splitlines()]


class Fleet:
    """`agents` serve all gateways, each of them."""

    def __init__(self, bin_folder, gateways, agents):
        self.bin = pathlib.Path(bin_folder)
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        self.folder.chmod(0o755)
        self.database = Database(self.folder)
        self.broker = Broker(self.folder)
        self.gateways, text = {}, ""
        for number in range(gateways):
            name = f"gateway{number}"
            place = self.folder / f"{name}.sock"
            self.gateways[name] = Process(self.folder / f"{name}.log", self.bin / "kinebusd", "--bus", "inproc", "--socket", place,
                                          "--jobs", self.folder / name / "jobs", "--flight", self.folder / name / "flight",
                                          "--no-realtime", "--no-mdns")
            (self.folder / name).mkdir()
            text += f'[[gateway]]\nname = "{name}"\nsocket = "{place}"\nkind = "m1"\nmaterial = "PLA"\nnozzle_mm = 0.4\n'
        (self.folder / "gateways.toml").write_text(text)
        self.agents = [Process(self.folder / f"agent{n}.log", self.bin / "kinebus-fleet", "--database", self.database.where, "agent",
                               "--gateways", self.folder / "gateways.toml", "--home", "--give-up", "--period", "0.2",
                               "--broker", f"127.0.0.1:{self.broker.port}", "--node", f"agent{n}")
                       for n in range(agents)]

    def __enter__(self):
        try:
            for process in [self.broker, self.database, *self.gateways.values()]:
                process.start()
            until("the database answers", self.database.answers)
            self.fleet("init")
            for agent in self.agents:
                agent.start()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for process in [*self.agents, *self.gateways.values(), self.database, self.broker]:
            process.stop()
        keep = os.environ.get("KINEBUS_FLEET_KEEP")
        if keep:
            shutil.copytree(self.folder, keep, dirs_exist_ok=True, ignore=shutil.ignore_patterns("data", "*.sock", ".s.*"))
        self.temporary.cleanup()

    def fleet(self, *arguments, check=True):
        return subprocess.run([self.bin / "kinebus-fleet", "--database", self.database.where, *arguments], check=check, text=True,
                              capture_output=True)

    def kinebus(self, gateway, *arguments):
        return subprocess.run([self.bin / "kinebus", "--socket", self.folder / f"{gateway}.sock", *arguments], check=False, text=True,
                              capture_output=True)

    def add(self, text, *arguments):
        path = self.folder / "part.gcode"
        path.write_text(text)
        return [int(line) for line in self.fleet("add", str(path), *arguments).stdout.split()]

    def sql(self, query):
        found = subprocess.run(["psql", "-h", self.database.folder, "-U", "fleet", "-d", "postgres", "-AtF", " ", "-c", query],
                               check=False, text=True, capture_output=True)
        return [line.split(" ") for line in found.stdout.splitlines()] if found.returncode == 0 else None

    def states(self):
        """Of every job, or None: the database does not answer."""
        rows = self.sql("SELECT id, state FROM jobs")
        return None if rows is None else {int(number): state for number, state in rows}

    def history(self, gateway):
        """Its runs, the newest first; a gateway that does not answer is asked again."""
        def ask():
            found = self.kinebus(gateway, "--as-json", "history")
            return [json.loads(found.stdout)] if found.returncode == 0 else None
        return until(f"{gateway} tells its history", ask)[0].get("runs", [])

    def starts(self):
        """How often each job was begun, over all gateways, by their own histories."""
        count = collections.Counter()
        for gateway in self.gateways:
            for run in self.history(gateway):
                words = run.get("first_error", "")
                never_taken = run.get("result") == "JOB_REFUSED"
                if run["name"].startswith("fleet-") and not never_taken:
                    count[int(run["name"].split("-")[1])] += 1
                elif never_taken:
                    print(f"{gateway}: {run['name']} refused: {words}")
        return count
