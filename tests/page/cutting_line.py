"""A line to a server on this machine that a test cuts, holds and slows down."""
import select
import socket
import struct
import threading
import time


class CuttingLine:
    def __init__(self, port):
        self.server = port
        self.listening = socket.create_server(("127.0.0.1", 0))
        # What a client has sent is on the line, not in a buffer of megabytes.
        self.listening.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 65536)
        self.port = self.listening.getsockname()[1]
        self.to_server = 0  # bytes
        self.cuts = 0
        self.cut_at = None  # of to_server: then the line is cut and stays down
        self.bytes_per_s = None
        self.down = False
        self.lock = threading.Lock()
        self.pairs = set()
        self.accepting = threading.Thread(target=self._accept, daemon=True)
        self.accepting.start()

    def cut(self):
        """Resets all connections, as a cable that is pulled, and takes no new ones until `up`."""
        with self.lock:
            self.down = True
            self.cuts += 1
            pairs, self.pairs = self.pairs, set()
        for pair in pairs:
            self._reset(pair)

    def up(self):
        self.down = False

    def quiet(self):
        """Waits until nothing comes any more of what clients left in their buffers; returns to_server."""
        while (before := self.to_server) != (time.sleep(0.2) or self.to_server):
            pass
        return before

    def close(self):
        self.listening.close()
        self.cut()

    @staticmethod
    def _reset(pair):
        for each in pair:
            try:
                each.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
                each.shutdown(socket.SHUT_RDWR)
                each.close()
            except OSError:
                pass

    def _accept(self):
        while True:
            try:
                client, _ = self.listening.accept()
            except OSError:
                return
            if self.down:
                self._reset((client,))
                continue
            try:
                pair = (client, socket.create_connection(("127.0.0.1", self.server)))
            except OSError:
                self._reset((client,))
                continue
            with self.lock:
                self.pairs.add(pair)
            threading.Thread(target=self._pass, args=pair, daemon=True).start()

    def _pass(self, client, server):
        try:
            while True:
                for each in select.select([client, server], [], [])[0]:
                    bytes_ = each.recv(16384)
                    if not bytes_:
                        return
                    if each is client:
                        self._count(len(bytes_))
                    (server if each is client else client).sendall(bytes_)
        except (OSError, ValueError):
            pass
        finally:
            with self.lock:
                self.pairs.discard((client, server))
            self._reset((client, server))

    def _count(self, count):
        self.to_server += count
        if self.cut_at is not None and self.to_server >= self.cut_at:
            self.cut_at = None
            self.cut()
        if self.bytes_per_s:
            time.sleep(count / self.bytes_per_s)
