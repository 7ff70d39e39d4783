"""A TLS client that does what none should: by OpenSSL's library through ctypes, its records kept in memory, so that they can be sent in any
pieces and as fast as the kernel takes them."""
import ctypes
import ctypes.util

_name = ctypes.util.find_library("ssl")
_ssl = ctypes.CDLL(_name) if _name else None
_crypto = ctypes.CDLL(ctypes.util.find_library("crypto")) if _name else None
WANT_READ = 2
TLS1_2, TLS1_3 = 0x0303, 0x0304


def _function(library, name, result, *arguments):
    found = getattr(library, name)
    found.restype, found.argtypes = result, arguments
    return found


if _ssl:
    _pointer, _int, _long = ctypes.c_void_p, ctypes.c_int, ctypes.c_long
    _method = _function(_ssl, "TLS_client_method", _pointer)
    _context_new = _function(_ssl, "SSL_CTX_new", _pointer, _pointer)
    _context_ctrl = _function(_ssl, "SSL_CTX_ctrl", _long, _pointer, _int, _long, _pointer)
    _new = _function(_ssl, "SSL_new", _pointer, _pointer)
    _set_bio = _function(_ssl, "SSL_set_bio", None, _pointer, _pointer, _pointer)
    _set_connect = _function(_ssl, "SSL_set_connect_state", None, _pointer)
    _handshake = _function(_ssl, "SSL_do_handshake", _int, _pointer)
    _error = _function(_ssl, "SSL_get_error", _int, _pointer, _int)
    _write = _function(_ssl, "SSL_write", _int, _pointer, ctypes.c_char_p, _int)
    _read = _function(_ssl, "SSL_read", _int, _pointer, ctypes.c_char_p, _int)
    _key_update = _function(_ssl, "SSL_key_update", _int, _pointer, _int)
    _renegotiate = _function(_ssl, "SSL_renegotiate", _int, _pointer)
    _memory = _function(_crypto, "BIO_s_mem", _pointer)
    _bio_new = _function(_crypto, "BIO_new", _pointer, _pointer)
    _bio_read = _function(_crypto, "BIO_read", _int, _pointer, ctypes.c_char_p, _int)
    _bio_write = _function(_crypto, "BIO_write", _int, _pointer, ctypes.c_char_p, _int)


def available():
    return _ssl is not None


class TlsClient:
    """`version`: the only one that is spoken. The program that tests is short: nothing of OpenSSL's is freed."""

    def __init__(self, version=TLS1_3):
        context = _context_new(_method())
        for control in (123, 124):  # SSL_CTRL_SET_MIN_PROTO_VERSION, ..MAX..
            _context_ctrl(context, control, version, None)
        self.ssl = _new(context)
        self.inward, self.outward = _bio_new(_memory()), _bio_new(_memory())
        _set_bio(self.ssl, self.inward, self.outward)
        _set_connect(self.ssl)

    def waiting(self):
        """What it wants to send."""
        data, buffer = b"", ctypes.create_string_buffer(1 << 16)
        while (count := _bio_read(self.outward, buffer, len(buffer))) > 0:
            data += buffer.raw[:count]
        return data

    def hello(self):
        _handshake(self.ssl)
        return self.waiting()

    def shake(self, stream):
        """The whole handshake over a blocking socket."""
        while (done := _handshake(self.ssl)) != 1:
            assert _error(self.ssl, done) == WANT_READ, "the handshake was refused"
            self.exchange(stream)
        stream.sendall(self.waiting())

    def exchange(self, stream):
        if out := self.waiting():
            stream.sendall(out)
        if not (heard := stream.recv(1 << 16)):
            raise ConnectionError("closed")
        _bio_write(self.inward, heard, len(heard))

    def records(self, data, size):
        """`data` in records of `size` bytes each."""
        for at in range(0, len(data), size):
            piece = data[at:at + size]
            assert _write(self.ssl, piece, len(piece)) == len(piece)
        return self.waiting()

    def key_updates(self, count):
        """So many records that change its keys and ask for no answer."""
        for _ in range(count):
            assert _key_update(self.ssl, 0) == 1 and _handshake(self.ssl) == 1
        return self.waiting()

    def renegotiate(self, stream):
        """True: the other side began the handshake anew."""
        _renegotiate(self.ssl)
        result = _handshake(self.ssl)
        while result != 1 and _error(self.ssl, result) == WANT_READ:
            self.exchange(stream)
            result = _handshake(self.ssl)
        return result == 1


def split_hello(size):
    """A ClientHello that says it has `size` bytes, each in a record of its own, and lacks the last one."""
    body = b"\x01" + size.to_bytes(3, "big") + b"\x03\x03" + bytes(size - 3)
    return b"".join(b"\x16\x03\x01\x00\x01" + body[i:i + 1] for i in range(len(body)))
