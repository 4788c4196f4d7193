"""A client of the Lumulus frame service in one file: the standard library, and numpy where it is installed.

    from lumulus_client import Client
    with Client("127.0.0.1:7788") as client:
        frame = client.frame(width=640, height=360, encoding="png")
        open("cloud.png", "wb").write(frame.file())

Fields of requests are keyword arguments, as docs/protocol.md names them.
"""

import hashlib
import json
import os
import socket
import struct

MAGIC, VERSION = 0x534C4D4C, 1
HEADER = struct.Struct("<IHHQIIQ")  # magic, version, type, id, bytes of JSON, reserved, bytes of payload
REPLY, ERROR = 0x8000, 0x8000
TYPES = {"hello": 1, "load_scene": 2, "upload": 3, "frame": 4, "start_stream": 5, "stop_stream": 6, "composite": 7,
         "cancel": 8, "statistics": 9, "ping": 10, "change": 11, "list_uploads": 12, "delete_upload": 13,
         "list_scenes": 14, "query": 15}
CHUNK = 1 << 20


class ServiceError(Exception):
    """What the server refuses; `code` is one of docs/protocol.md."""

    def __init__(self, code, message, where=""):
        super().__init__(f"{message} ({code})")
        self.code, self.where = code, where


class Frame:
    """A reply with pictures: `info` is its JSON, `payload` its bytes (a bytearray, not copied again)."""

    def __init__(self, info, payload):
        self.info, self.payload = info, payload

    def file(self, view=0):
        """The bytes of a view that came as exr, png or jpeg."""
        entry = self.info["views"][view]
        return self.payload[entry["offset"]:entry["offset"] + entry["bytes"]]

    def values(self, product="color", view=0):
        """A product of a view that came as half or float: a numpy array (height, width, channels), or without numpy a
        flat tuple."""
        entry = self.info["views"][view]
        part = next(p for p in entry["products"] if p["name"] == product)
        data = self.payload[part["offset"]:part["offset"] + part["bytes"]]
        code, size = ("e", 2) if part["type"] == "half" else ("f", 4)
        try:
            import numpy
        except ImportError:
            return struct.unpack(f"<{len(data) // size}{code}", data)
        return numpy.frombuffer(data, f"<f{size}").reshape(entry["height"], entry["width"], part["channels"])

    def verify(self):
        """Whether the payload is what the server hashed: False too where it was asked not to."""
        return self.info["hash"] == "sha256:" + hashlib.sha256(self.payload).hexdigest()


class Client:
    """One connection: "HOST:PORT", or "unix:PATH". Says hello."""

    def __init__(self, address="127.0.0.1:7788", token="", timeout=300.0, name="python"):
        if address.startswith("unix:"):
            self.socket = socket.socket(socket.AF_UNIX)
            self.socket.settimeout(timeout)
            self.socket.connect(address[5:])
        else:
            host, port = address.rsplit(":", 1)
            self.socket = socket.create_connection((host.strip("[]"), int(port)), timeout)
            self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.next_id = 1
        self.early = []  # replies to others than the one that is waited for
        try:
            self.welcome = self.ask("hello", {"version": VERSION, "token": token, "client": name})[0]
        except Exception:
            self.close()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.socket.close()

    # Messages

    def send(self, kind, fields=None, payload=b"", request=None):
        """Sends a request and returns its id."""
        if request is None:
            request, self.next_id = self.next_id, self.next_id + 1
        text = json.dumps(fields or {}).encode()
        self.socket.sendall(HEADER.pack(MAGIC, VERSION, TYPES[kind], request, len(text), 0, len(payload)) + text)
        if payload:
            self.socket.sendall(payload)
        return request

    def receive(self):
        """The next message: (type, id, JSON as a value, payload)."""
        magic, version, kind, request, json_bytes, _, payload_bytes = HEADER.unpack(self._read(HEADER.size))
        if magic != MAGIC or version != VERSION:
            raise ConnectionError("this is no frame service of version 1")
        return kind, request, json.loads(self._read(json_bytes)), self._read(payload_bytes)

    def wait(self, request):
        """The reply to a request: (JSON, payload). Errors: ServiceError, OSError."""
        message = next((m for m in self.early if m[1] == request), None)
        if message:
            self.early.remove(message)
        while message is None:
            message = self.receive()
            if message[1] != request and not (message[0] == ERROR and message[1] == 0):
                self.early.append(message)
                message = None
        kind, _, info, payload = message
        if kind == ERROR:
            raise ServiceError(info["code"], info["message"], info.get("where", ""))
        return info, payload

    def ask(self, kind, fields=None, payload=b""):
        return self.wait(self.send(kind, fields, payload))

    def _read(self, size):
        data = bytearray(size)
        view = memoryview(data)
        while view:
            count = self.socket.recv_into(view)
            if count == 0:
                raise ConnectionError("the server closed the connection")
            view = view[count:]
        return data

    # Requests

    def scenes(self):
        """Names of the scenes in the server's folder."""
        return self.ask("list_scenes")[0]["scenes"]

    def load_scene(self, name=None, toml=None, **fields):
        """A scene of the server's folder, or TOML. Returns what the server says of it."""
        if name is not None:
            fields["name"] = name
        return self.ask("load_scene", fields, (toml or "").encode())[0]

    def upload(self, path):
        """Sends a VDB file, unless the server has it. Returns its hash, for load_scene(vdb=…) and change(vdb=…)."""
        size, digest = os.path.getsize(path), hashlib.sha256()
        with open(path, "rb") as file:
            while chunk := file.read(CHUNK):
                digest.update(chunk)
            spelled = "sha256:" + digest.hexdigest()
            file.seek(0)
            offset = 0
            while offset < size:
                chunk = file.read(CHUNK)
                info, _ = self.ask("upload", {"hash": spelled, "size": size, "offset": offset}, chunk)
                if info["complete"]:
                    break
                offset += len(chunk)
        return spelled

    def list_uploads(self):
        """What this address has uploaded: {"uploads": [{"hash", "bytes", "seconds_left"}], "bytes", "most_bytes"}."""
        return self.ask("list_uploads")[0]

    def delete_upload(self, digest):
        """Deletes an upload of this address. Returns whether there was one."""
        return self.ask("delete_upload", {"hash": digest})[0]["found"]

    def frame(self, **fields):
        return Frame(*self.ask("frame", fields))

    def start_stream(self, stream=None, **fields):
        """Starts a stream, or gives a running one new wishes. Returns its id."""
        return self.send("start_stream", fields, request=stream)

    def next_frame(self, stream):
        return Frame(*self.wait(stream))

    def stop_stream(self, stream):
        info, _ = self.ask("stop_stream", {"stream": stream})
        self.early = [message for message in self.early if message[1] != stream]
        return info["found"]

    def change(self, **fields):
        """Changes sun, extinction, wind or clouds of the scene, or the density of a cloud (vdb=… of upload(), frame=…), whose
        reply comes when it is shown; the light is the client's own from then on, unless the server lets clients share
        it."""
        return self.ask("change", fields)[0]

    def composite(self, color, depth, width, height, **fields):
        """A picture of another renderer as seen through the scene's medium: `color` and `depth` as bytes of float32,
        three a pixel and one a pixel, depth in metres from the eye."""
        return Frame(*self.ask("composite", {"width": width, "height": height, **fields}, color + depth))

    def query(self, product, rows=b"", **fields):
        """Light without a picture: `product` is "segments" (rows of x0, y0, z0, x1, y1, z1), "sun", "ambient" (rows of
        x, y, z) or "ground_shadow" (rectangle=[x0, z0, x1, z1], width, height, y). `rows` are bytes of doubles. Returns
        the answer and its floats as bytes."""
        return self.ask("query", {"products": [product], **fields}, rows)

    def statistics(self):
        return self.ask("statistics")[0]

    def ping(self):
        self.ask("ping")

    def cancel(self, request):
        return self.ask("cancel", {"request": request})[0]["found"]
