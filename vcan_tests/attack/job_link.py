"""The job link, written anew from its description: frames and as much of protobuf as attacks need."""
import struct
import zlib

FIELDS = {"hello": 10, "ping": 11, "get_status": 13, "upload_begin": 20, "list_jobs": 24, "read_job": 26, "hold": 41, "resume": 42, "stop": 44, "bring_up": 46,
          "take_control": 60, "release_control": 61, "get_events": 71, "check_machine_file": 73}

REPLY, ERROR = 1, 2  # of ServerMessage, of Reply


def varint(value):
    out = b""
    while value > 0x7F:
        out += bytes([value & 0x7F | 0x80])
        value >>= 7
    return out + bytes([value])


def field(number, value):
    if isinstance(value, int):
        return varint(number << 3) + varint(value)
    data = value.encode() if isinstance(value, str) else value
    return varint(number << 3 | 2) + varint(len(data)) + data


def fields(data):
    found, i = {}, 0

    def number():
        nonlocal i
        value, shift = 0, 0
        while True:
            byte = data[i]
            i += 1
            value |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                return value

    while i < len(data):
        tag = number()
        kind = tag & 7
        if kind == 0:
            value = number()
        elif kind == 2:
            size = number()
            value = data[i:i + size]
            i += size
        else:
            size = 8 if kind == 1 else 4
            value = data[i:i + size]
            i += size
        found.setdefault(tag >> 3, []).append(value)
    return found


def frame(session, sequence, message, length=None, crc=None):
    head = b"KBJ1" + struct.pack("<IIII", len(message) if length is None else length, session, sequence,
                                 zlib.crc32(message) if crc is None else crc)
    return head + struct.pack("<I", zlib.crc32(head)) + message


class Client:
    def __init__(self, stream, token="", name="attack", session=7):
        self.stream, self.session, self.sequence, self.request, self.buffer = stream, session, 0, 0, b""
        self.reply = self.ask("hello", field(1, 2) + field(3, name) + (field(5, token) if token else b""))
        assert ERROR not in self.reply, self.reply

    def send(self, kind, body=b""):
        self.request += 1
        self.stream.sendall(frame(self.session, self.sequence, field(1, self.request) + field(FIELDS[kind], body)))
        self.sequence += 1
        return self.request

    def receive(self):
        """The next message of the gateway, as fields."""
        while True:
            if len(self.buffer) >= 24:
                length = struct.unpack_from("<I", self.buffer, 4)[0]
                if len(self.buffer) >= 24 + length:
                    message, self.buffer = self.buffer[24:24 + length], self.buffer[24 + length:]
                    return fields(message)
            data = self.stream.recv(1 << 20)
            if not data:
                raise ConnectionError("closed")
            self.buffer += data

    def ask(self, kind, body=b""):
        request = self.send(kind, body)
        while True:
            message = self.receive()
            for reply in message.get(REPLY, []):
                reply = fields(reply)
                if reply.get(1, [0])[0] == request:
                    return reply
