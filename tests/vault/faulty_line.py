"""A line to a store that fails as it is told: a proxy on loopback that passes requests on, one a connection, and notes them.

A fault is a function of a request that returns None or one of
    ("answer", STATUS)          answers by itself, with a refusal in XML; nothing is passed on
    ("cut request", N)          ends both connections after N bytes of the body
    ("cut answer", N)           ends the client's connection after N bytes of the answer's body
    ("lose answer",)            passes the request on and ends the client's connection without an answer
    ("stall request",)          takes the request, passes nothing on and never answers
    ("stall answer", N)         stops after N bytes of the answer's body, and leaves the connection open
    ("flip request", N)         passes the body on with bit 0 of byte N flipped
    ("flip answer", N)          the same of the answer's body
"""
import socket
import socketserver
import ssl
import threading

REFUSAL = b"<?xml version='1.0' encoding='UTF-8'?>\n<Error><Code>%s</Code><Message>planted</Message></Error>"
CODES = {500: b"InternalError", 503: b"SlowDown", 403: b"AccessDenied"}


class Request:
    def __init__(self, method, target, headers):
        self.method, self.target = method, target
        self.size, self.range = int(headers.get("content-length", 0)), headers.get("range")
        self.path = target.split("?")[0]
        self.fault = None
        self.status = None  # None: the client got no answer

    def __repr__(self):
        return f"{self.method} {self.target} {self.fault} -> {self.status}"


class FaultyLine:
    def __init__(self, port, identity=None):
        """To the store at `port` of this host. `identity`: files of a certificate and its key, for a line over TLS."""
        self.upstream = ("127.0.0.1", port)
        self.rule = lambda request: None
        self.requests = []
        self.over = threading.Event()
        line = self
        tls = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER) if identity else None
        if tls:
            tls.load_cert_chain(*identity)

        class Handler(socketserver.BaseRequestHandler):
            def handle(self):
                try:
                    if tls is None:
                        line.serve(self.request)
                    else:
                        with tls.wrap_socket(self.request, server_side=True) as client:
                            line.serve(client)
                except (ConnectionError, TimeoutError, ssl.SSLError):
                    pass

        class Server(socketserver.ThreadingTCPServer):
            daemon_threads = True
            allow_reuse_address = True

        self.server = Server(("127.0.0.1", 0), Handler)
        self.port = self.server.server_address[1]
        threading.Thread(target=self.server.serve_forever, args=(0.05,), daemon=True).start()

    def close(self):
        self.over.set()
        self.server.shutdown()
        self.server.server_close()

    def begin(self, rule=None):
        """From now on requests are noted anew, and fail by this rule."""
        self.requests = []
        self.rule = rule or (lambda request: None)

    def count(self, method, part=""):
        """Requests that were passed on and answered with success."""
        return sum(request.method == method and part in request.path and request.status in (200, 206) for request in self.requests)

    def serve(self, client):
        head, _, rest = read_head(client)
        if head is None:
            return
        first, *lines = head.decode("latin-1").split("\r\n")
        method, target, _ = first.split(" ")
        headers = {line.split(":", 1)[0].lower(): line.split(":", 1)[1].strip() for line in lines}
        request = Request(method, target, headers)
        request.fault = self.rule(request)
        self.requests.append(request)
        fault, *number = request.fault or ("none",)
        if headers.get("expect"):
            client.sendall(b"HTTP/1.1 100 Continue\r\n\r\n")
        wanted = number[0] if fault == "cut request" else request.size
        body = bytearray(rest)
        while len(body) < wanted:
            some = client.recv(1 << 20)
            if not some:
                return
            body += some
        if fault == "answer":
            refusal = REFUSAL % CODES[number[0]]
            request.status = number[0]
            client.sendall(b"HTTP/1.1 %d planted\r\nContent-Type: application/xml\r\nConnection: close\r\nContent-Length: %d\r\n\r\n" % (number[0], len(refusal)) + refusal)
            return
        if fault == "stall request":
            self.hold(client)
            return
        if fault == "flip request":
            body[number[0]] ^= 1
        kept = [line for line in lines if line.split(":")[0].lower() not in ("expect", "connection")]
        with socket.create_connection(self.upstream) as store:
            store.sendall("\r\n".join([first, *kept, "Connection: close", "", ""]).encode("latin-1"))
            store.sendall(bytes(body[: wanted if fault == "cut request" else None]))
            if fault == "cut request":
                return
            self.answer(client, store, request, fault, number)

    def answer(self, client, store, request, fault, number):
        head, raw, rest = read_head(store)
        while head is not None and head.split(b" ")[1] == b"100":
            head, raw, rest = read_head(store, rest)
        if head is None or fault == "lose answer":
            return
        request.status = int(head.split(b" ")[1])
        client.sendall(raw.replace(b"\r\n", b"\r\nConnection: close\r\n", 1))
        passed = 0
        while True:
            if rest:
                if fault in ("cut answer", "stall answer") and passed + len(rest) > number[0]:
                    client.sendall(rest[: number[0] - passed])
                    if fault == "stall answer":
                        self.hold(client)
                    return
                if fault == "flip answer" and passed <= number[0] < passed + len(rest):
                    rest = bytearray(rest)
                    rest[number[0] - passed] ^= 1
                client.sendall(rest)
                passed += len(rest)
            rest = store.recv(1 << 20)
            if not rest:
                return

    def hold(self, client):
        """Until the client gives up."""
        client.settimeout(0.1)
        while not self.over.is_set():
            try:
                if not client.recv(1 << 20):
                    return
            except TimeoutError:
                continue


def read_head(connection, begun=b""):
    """The first line and the headers, the same with their end, and what came behind them."""
    text = bytes(begun)
    while b"\r\n\r\n" not in text:
        some = connection.recv(1 << 16)
        if not some:
            return None, None, b""
        text += some
    head, end, rest = text.partition(b"\r\n\r\n")
    return head, head + end, rest
