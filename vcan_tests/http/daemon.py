"""kinebusd with a simulated machine, and its clients, for tests of what it serves by HTTP."""
import http.client
import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).parent.parent))
from patience import PATIENCE_S, until  # noqa: E402

bin_folder = pathlib.Path(sys.argv[1])


class Daemon:
    def __init__(self, address, *more):
        self.folder = tempfile.TemporaryDirectory()
        self.work = pathlib.Path(self.folder.name)
        self.socket = str(self.work / "kinebus.sock")
        self.log_path = self.work / "log"
        self.arguments = [str(bin_folder / "kinebusd"), "--bus", "inproc", "--jobs", str(self.work / "jobs"), "--socket", self.socket,
                          "--no-realtime", "--http", address, *more]

    def __enter__(self):
        with self.log_path.open("w") as log:
            self.process = subprocess.Popen(self.arguments, stderr=log)
        try:
            until("the daemon listens", lambda: self.process.poll() is not None or "listening at" in self.log())
            assert self.process.poll() is None, self.log()
        except AssertionError:
            self.__exit__()
            raise
        self.port = int(re.search(r"HTTPS? port (\d+)", self.log())[1])
        self.key_path = self.work / "jobs" / ".tls" / "http-key"
        self.key = self.key_path.read_text().strip()
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGTERM)
        try:
            self.process.wait(60)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.folder.cleanup()

    def log(self):
        return self.log_path.read_text(errors="replace")

    def cli(self, *words):
        done = subprocess.run([str(bin_folder / "kinebus"), "--socket", self.socket, *words], capture_output=True, text=True,
                              timeout=PATIENCE_S)
        assert done.returncode == 0, f"kinebus {words}: {done.stdout}{done.stderr}"
        return done.stdout

    def ask(self, method, path, body=None, key=None, **fields):
        """Status and JSON (None: no body)."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE_S)
        sent = {"X-Api-Key": self.key if key is None else key, **{name.replace("_", "-"): text for name, text in fields.items()}}
        if body is not None:
            sent["Content-Type"] = "application/json"
            body = json.dumps(body)
        connection.request(method, path, body, sent)
        response = connection.getresponse()
        text = response.read()
        connection.close()
        return response.status, json.loads(text) if text else None

    def curl(self, *words, key=True):
        """The same of libcurl."""
        shown = ["-H", "X-Api-Key: " + self.key] if key else []
        done = subprocess.run(["curl", "--noproxy", "*", "--silent", "--show-error", "--write-out", "\n%{http_code}", *shown, *words],
                              capture_output=True, text=True, timeout=PATIENCE_S)
        assert done.returncode == 0, done.stderr
        text, status = done.stdout.rsplit("\n", 1)
        return int(status), json.loads(text) if text else None

    def url(self, path):
        return f"http://127.0.0.1:{self.port}{path}"

    def state(self):
        return self.ask("GET", "/api/job")[1]["state"]

    def form_upload(self, path, prints):
        return self.curl("-F", "print=" + ("true" if prints else "false"), "-F", "path=", "-F", f"file=@{path};filename={path.name}",
                         self.url("/api/files/local"))

    def put_upload(self, path, *fields):
        words = [word for field in ("Content-Type: text/x.gcode", *fields) for word in ("-H", field)]
        return self.curl("-T", str(path), *words, self.url("/api/v1/files/local/" + path.name))
