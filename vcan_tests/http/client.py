"""Programs that talk to kinebusd by HTTP and its push updates as they would themselves, and what came of it."""
import base64
import http.client
import json
import os
import queue
import socket
import threading
import urllib.parse

from daemon import PATIENCE_S, until

# Which client does what; and what is refused, as client, what, status, why.
table, refusals = {}, []


class Client:
    """A program on one kept connection: the header fields of each request are its own, in its order."""

    def __init__(self, daemon, name):
        self.daemon, self.name, self.key = daemon, name, daemon.key
        self.host = f"127.0.0.1:{daemon.port}"
        self.connection = http.client.HTTPConnection("127.0.0.1", daemon.port, timeout=PATIENCE_S)

    def works(self, what, how="yes"):
        table.setdefault(what, {})[self.name] = how

    def fields(self, has_json):
        raise NotImplementedError

    def send(self, method, path, body, fields):
        """Status, fields, bytes."""
        self.connection.putrequest(method, urllib.parse.quote(path, safe="/?=&%"), skip_host=True, skip_accept_encoding=True)
        for name, text in (("Host", self.host), *fields):
            self.connection.putheader(name, text)
        if body is not None or method == "POST":
            self.connection.putheader("Content-Length", str(len(body or b"")))
        self.connection.endheaders(body)
        response = self.connection.getresponse()
        return response.status, response.headers, response.read()

    def ask(self, method, path, body=None):
        """Status and JSON; None: there is none to parse."""
        data = None if body is None else json.dumps(body).encode()
        status, _, text = self.send(method, path, data, self.fields(body is not None))
        return status, json.loads(text) if text else None

    def get(self, path, *read):
        """JSON of a 200, in which `read` (a.b.c) must be."""
        status, told = self.ask("GET", path)
        assert status == 200, f"{self.name}: GET {path}: {status} {told}"
        for way in read:
            at(told, way)
        return told

    def post(self, path, body, expected=204):
        status, told = self.ask("POST", path, body)
        assert status == expected, f"{self.name}: POST {path} {body}: {status} {told}"
        return told

    def refused(self, what, expected, method, path, body=None):
        """An answer that this client shows as its own failure, and goes on."""
        status, told = self.ask(method, path, body)
        assert status == expected, f"{self.name}: {method} {path} {body}: expected {expected}, found {status} {told}"
        refusals.append((self.name, what, status, told["error"] if told else ""))

    def wrong_key(self, method, path, body=None):
        """What it is entered with, by a key that is none: shown as such by what comes of 401."""
        self.key = "x" * 32
        status, told = self.ask(method, path, body)
        assert status == 401, f"{self.name}: wrong key: {status} {told}"
        self.key = self.daemon.key
        self.works("wrong key is said")

    def state(self):
        return self.get("/api/job", "state")["state"]

    def flags(self):
        return self.get("/api/printer")["state"]["flags"]

    def until_state(self, *states):
        until(f"{self.name}: {states}", lambda: self.state() in states)

    def until_ready(self):
        until(f"{self.name}: ready", lambda: self.flags()["ready"])


def at(told, way):
    for name in way.split("."):
        assert isinstance(told, dict) and name in told, f"no {way} in {told}"
        told = told[name]
    return told


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


class Push:
    """The raw websocket of the push updates, as both telephones open it: without a key."""

    def __init__(self, client, *fields):
        self.client, self.messages = client, queue.SimpleQueue()
        self.connection = socket.create_connection(("127.0.0.1", client.daemon.port), PATIENCE_S)
        head = ["GET /sockjs/websocket HTTP/1.1", f"Host: {client.host}", "Upgrade: websocket", "Connection: Upgrade",
                f"Sec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}", "Sec-WebSocket-Version: 13", *fields]
        self.connection.sendall(("\r\n".join(head) + "\r\n\r\n").encode())
        self.stream = self.connection.makefile("rb")
        status = self.stream.readline()
        assert b" 101 " in status, f"{client.name}: websocket: {status}"
        while (line := self.stream.readline().strip()):
            assert b"extensions" not in line.lower() and b"protocol" not in line.lower(), line
        threading.Thread(target=self.read, daemon=True).start()

    def say(self, message):
        self.frame(0x81, json.dumps(message).encode())

    def frame(self, kind, body):
        mask = os.urandom(4)
        assert len(body) < 126
        self.connection.sendall(bytes([kind, 0x80 | len(body)]) + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(body)))

    def read(self):
        """Takes all that comes, as they do beside their pages: who takes nothing is let go."""
        while len(head := self.stream.read(2)) == 2:
            size = head[1]
            if size >= 126:
                size = int.from_bytes(self.stream.read(2 if size == 126 else 8), "big")
            body = self.stream.read(size)
            if head[0] & 15 == 1:
                self.messages.put(next(iter(json.loads(body).items())))
            if head[0] & 15 == 9:
                self.frame(0x8A, body)
        self.messages.put(("closed", None))

    def hear(self):
        """The next message: what it is, and its content."""
        return self.messages.get(timeout=PATIENCE_S)

    def until(self, kind, fits=lambda content: True):
        while True:
            heard, content = self.hear()
            assert heard not in ("reauthRequired", "closed"), f"{self.client.name}: {heard} {content}"
            if heard == kind and fits(content):
                return content

    def event(self, name):
        return self.until("event", lambda content: content["type"] == name)["payload"]
