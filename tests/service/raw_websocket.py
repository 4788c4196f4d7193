"""A WebSocket by hand (RFC 6455), for tests that send what no library would."""

import socket
import struct

OPEN = ("GET /frames HTTP/1.1\r\nHost: {}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n")
BINARY, CLOSE = 2, 8


class WebSocket:
    def __init__(self, address, timeout=20):
        host, port = address.rsplit(":", 1)
        self.socket = socket.create_connection((host, int(port)), timeout)
        self.socket.sendall(OPEN.format(address).encode())
        self.bytes = b""
        while b"\r\n\r\n" not in self.bytes:
            self.bytes += self._some()
        head, self.bytes = self.bytes.split(b"\r\n\r\n", 1)
        self.status = int(head.split()[1])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def begin(self, size, kind=BINARY):
        """The head of a message of so many bytes; the mask is zero, so that bytes go as they are."""
        if size < 126:
            length = struct.pack(">B", 0x80 | size)
        else:
            length = struct.pack(">BH", 0x80 | 126, size) if size < 65536 else struct.pack(">BQ", 0x80 | 127, size)
        self.socket.sendall(bytes([0x80 | kind]) + length + bytes(4))

    def send(self, data):
        self.begin(len(data))
        self.socket.sendall(data)

    def frame(self):
        """The next frame: (whether it is the last of its message, kind, payload)."""
        first, length = self._read(2)
        if length == 126:
            length, = struct.unpack(">H", self._read(2))
        elif length == 127:
            length, = struct.unpack(">Q", self._read(8))
        return bool(first & 0x80), first & 15, self._read(length)

    def message(self):
        """The payload of the next message, whatever fragments it comes in."""
        payload, last = b"", False
        while not last:
            last, _, part = self.frame()
            payload += part
        return payload

    def _some(self):
        data = self.socket.recv(65536)
        if not data:
            raise ConnectionError("the server closed the connection")
        return data

    def _read(self, size):
        while len(self.bytes) < size:
            self.bytes += self._some()
        data, self.bytes = self.bytes[:size], self.bytes[size:]
        return data
