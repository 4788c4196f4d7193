"""What hostile clients cost a frame service: memory, and the delay of another client's ping and frame while each kind attacks.
Writes a table for docs/service.md.
"""

import hashlib
import multiprocessing
import socket
import time

from study.lumulus import add_program_option
from study.service import Server, ServiceError, percentile
from study.tables import Table

from lumulus_client import HEADER, MAGIC, TYPES, Client
from raw_websocket import WebSocket

LIMITS = "token_guesses_per_second = 1\nwrite_seconds = 2\nconnections = 48\nhttp_connections = 48\n"
MEGABYTE = 1 << 20


def head(kind, number, json_bytes=0, payload_bytes=0):
    return HEADER.pack(MAGIC, 1, TYPES[kind], number, json_bytes, 0, payload_bytes)


def again(attack):
    """An attack that begins anew whenever the server ends it."""
    def run(tcp, http):
        while True:
            try:
                attack(tcp, http)
            except (OSError, ServiceError):
                time.sleep(0.01)
    return run


def connect(address):
    host, port = address.rsplit(":", 1)
    return socket.create_connection((host, int(port)), 10)


def nothing(tcp, http):
    time.sleep(3600)


def strangers(tcp, http):
    crowd = []
    for number in range(32):
        if number % 2:
            crowd.append(WebSocket(http))
            crowd[-1].begin(65536)
            crowd[-1].socket.sendall(head("hello", 1, 4096) + b" " * 4095)
        else:
            crowd.append(connect(tcp))
            crowd[-1].sendall(head("hello", 1, 4096) + b" " * 4095)
    time.sleep(1)


def large_before_hello(tcp, http):
    with WebSocket(http) as one:
        one.begin(64 * MEGABYTE)
        while True:
            one.socket.sendall(bytes(MEGABYTE))


def pings_in_one_message(tcp, http):
    pings = b"".join(head("ping", number + 2) for number in range(200000))
    with WebSocket(http) as one:
        one.send(head("hello", 1, 2) + b"{}")
        one.begin(len(pings))
        one.socket.sendall(pings)
        one.socket.settimeout(1)
        while one.socket.recv(MEGABYTE):
            pass


def bad_json(tcp, http):
    text = b'{"a":' + b"[" * 65000
    with Client(tcp, timeout=10) as one:
        while True:
            one.socket.sendall((head("frame", 9, len(text)) + text) * 16)
            for _ in range(16):
                one.receive()


def uploads(tcp, http):
    piece = bytes(32 * MEGABYTE)
    with Client(tcp, timeout=30) as one:
        for number in range(100):
            digest = hashlib.sha256(str((time.time(), number)).encode()).hexdigest()
            for offset in range(0, len(piece) * 4, len(piece)):
                one.send("upload", {"hash": digest, "size": len(piece) * 4, "offset": offset}, piece)
            for _ in range(4):
                one.receive()


def large_composites(tcp, http):
    side = 2000
    with Client(tcp, timeout=30) as one:
        while True:
            one.ask("composite", {"width": side, "height": side}, bytes(side * side * 16))


def no_readers(tcp, http):
    crowd = [Client(tcp, timeout=30) for _ in range(8)]
    for one in crowd:
        one.start_stream(width=1024, height=768, max_rate=1000, budget={"photons": 0}, encoding="float")
    time.sleep(4)


def slow_readers(tcp, http):
    crowd = [Client(tcp, timeout=30) for _ in range(8)]
    for one in crowd:
        one.start_stream(width=1024, height=768, max_rate=1000, budget={"photons": 0}, encoding="float")
    while True:
        for one in crowd:
            one.socket.recv(64)
        time.sleep(0.1)


def connections(tcp, http):
    crowd = []
    for number in range(200):
        crowd.append(connect(http if number % 2 else tcp))
    time.sleep(0.2)


def malformed_http(tcp, http):
    for _ in range(100):
        with connect(http) as one:
            one.sendall(b"nonsense\r\n\r\n" + b"x" * 5000)
            one.recv(4096)


ATTACKS = {
    "nobody": nothing,
    "32 connections without a hello, each with most of one": strangers,
    "64 MiB to a WebSocket before hello": large_before_hello,
    "200,000 pings in one message of a WebSocket": pings_in_one_message,
    "requests of 64 KiB that are no JSON": bad_json,
    "uploads of 128 MiB in pieces of 32 MiB": uploads,
    "pictures of 4 Mpixel to be seen through fog": large_composites,
    "8 streams of 12 MiB frames that nobody reads": no_readers,
    "the same, read at 640 B/s": slow_readers,
    "200 connections at once, again and again": connections,
    "bytes that are no HTTP": malformed_http,
}


def measure(lumulus, attack, seconds):
    """Growth of the memory at most [bytes], and milliseconds of pings and small frames."""
    server = Server(lumulus, limits=LIMITS)
    process = multiprocessing.Process(target=again(attack), args=(server.tcp, server.http), daemon=True)
    pings, frames, peak = [], [], 0
    try:
        with server.client(timeout=60) as client:
            for _ in range(10):
                client.frame(width=64, height=36)
            before = server.memory()
            process.start()
            end = time.monotonic() + seconds
            while time.monotonic() < end:
                started = time.perf_counter()
                client.ping()
                pings.append(1e3 * (time.perf_counter() - started))
                started = time.perf_counter()
                client.frame(width=64, height=36)
                frames.append(1e3 * (time.perf_counter() - started))
                peak = max(peak, server.memory())
                time.sleep(0.005)
    finally:
        process.kill()
        process.join()
        server.stop()
    return peak - before, pings, frames


def add_options(parser):
    add_program_option(parser)
    parser.add_argument("--seconds", type=float, default=10.0, help="of each attack")
    parser.add_argument("--only", default="", help="attacks whose name has this text")


def main(options):
    table = Table(["attack", "memory", "ping p50", "p99", "most", "frame p50", "p99"])
    for name, attack in ATTACKS.items():
        if options.only not in name:
            continue
        growth, pings, frames = measure(str(options.lumulus), attack, options.seconds)
        shown = [percentile(pings, 0.5), percentile(pings, 0.99), max(pings), percentile(frames, 0.5),
                 percentile(frames, 0.99)]
        table.add({"attack": name, "bytes": growth, "milliseconds": shown},
                  [name, f"{growth / 1e6:.1f} MB", *(f"{value:.1f} ms" for value in shown)])
