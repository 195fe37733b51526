"""OpenStack Swift on this host: its proxy with the S3 API and tempauth, its account, container and object servers, with a folder and ports of their own.

Needs Debian's python3-swift, whose code the packages swift-proxy, swift-account, swift-container and swift-object start; no root, no memcached and
no service of the machine. Nothing of it is left when it ends.
"""
import os
import pathlib
import pwd
import socket
import subprocess
import sys
import tempfile
import time

PYTHON = "/usr/bin/python3"  # Debian's, which has its packages
ACCESS_KEY = "test:tester"
SECRET_KEY = "testing"
REGION = "us-east-1"
PATIENCE_S = 60

SERVERS = ("account", "container", "object")
# The programs swift-proxy-server and so on are a call of run_wsgi each; here they are forks of one process, which imports Swift once, and read
# another swift.conf.
START = """
import ctypes, os, signal, sys
from swift.common import utils
utils.set_swift_dir(sys.argv[1])
from swift.common.ring import RingBuilder
from swift.common.wsgi import run_wsgi
for name, port in (each.split(":") for each in sys.argv[2:]):
    ring = RingBuilder(2, 1, 0)
    ring.add_dev({"region": 1, "zone": 1, "ip": "127.0.0.1", "port": int(port), "device": "disk", "weight": 1, "meta": ""})
    ring.rebalance()
    ring.get_ring().save(f"{sys.argv[1]}/{name}.ring.gz")
import swift.proxy.server, swift.account.server, swift.container.server, swift.obj.server, swift.common.middleware.s3api.s3api
children = []
for server in ("account", "container", "object", "proxy"):
    children.append(os.fork())
    if children[-1] == 0:
        ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG: each has a session of its own, which a kill of this one's doesn't reach
        sys.exit(run_wsgi(f"{sys.argv[1]}/{server}-server.conf", f"{server}-server"))
signal.signal(signal.SIGCHLD, lambda *_: sys.exit("a server has ended"))
try:
    sys.stdin.read()  # until the test ends, however it does
finally:
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    for child in children:
        os.kill(child, signal.SIGKILL)  # they keep nothing that is looked at later
        os.waitpid(child, 0)
"""
PROXY = """[DEFAULT]
bind_ip = 127.0.0.1
bind_port = {port}
workers = 0
user = {user}
swift_dir = {folder}
log_address = {folder}/no-log
[pipeline:main]
pipeline = cache s3api tempauth proxy-server
[app:proxy-server]
use = egg:swift#proxy
allow_account_management = true
account_autocreate = true
conn_timeout = 30
node_timeout = 60
recoverable_node_timeout = 60
[filter:cache]
paste.filter_factory = memory_cache:factory
[filter:s3api]
use = egg:swift#s3api
location = {region}
[filter:tempauth]
use = egg:swift#tempauth
user_test_tester = {secret} .admin
"""
# What memcached would hold for one proxy, in its own memory.
CACHE = """
class Memory:
    def __init__(self):
        self.values = {}
    def get(self, key, *_, **__):
        return self.values.get(key)
    def set(self, key, value, *_, **__):
        self.values[key] = value
    def incr(self, key, delta=1, *_, **__):
        self.values[key] = self.values.get(key, 0) + delta
        return self.values[key]
    def delete(self, key, *_, **__):
        self.values.pop(key, None)

def factory(conf, **_):
    memory = Memory()
    def wrap(app):
        def call(environment, start):
            environment["swift.cache"] = memory
            return app(environment, start)
        return call
    return wrap
"""
# What is late for a list is put into it by a daemon that doesn't run here: so nothing may be late.
STORAGE = """[DEFAULT]
bind_ip = 127.0.0.1
bind_port = {port}
workers = 0
user = {user}
swift_dir = {folder}
devices = {folder}/devices
mount_check = false
disable_fallocate = true
log_address = {folder}/no-log
conn_timeout = 30
node_timeout = 60
container_update_timeout = 60
[pipeline:main]
pipeline = {server}-server
[app:{server}-server]
use = egg:swift#{server}
"""


def missing():
    """Why there can be no Swift here; empty: there can."""
    if not os.path.exists(PYTHON) or not os.path.exists("/usr/lib/python3/dist-packages/swift/common/middleware/s3api"):
        return "not installed: python3-swift"
    with tempfile.NamedTemporaryFile() as file:
        try:
            os.setxattr(file.name, "user.swift.metadata", b"1")
        except OSError:
            return f"the file system of {tempfile.gettempdir()} keeps no extended attributes"
    return ""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


class SwiftStore:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.servers = None
        self.port, *self.inner = free_ports(1 + len(SERVERS))

    def __enter__(self):
        try:
            (self.folder / "devices" / "disk").mkdir(parents=True)
            (self.folder / "swift.conf").write_text("[swift-hash]\nswift_hash_path_suffix = prismesh\n[storage-policy:0]\nname = one\ndefault = yes\n")
            user = pwd.getpwuid(os.geteuid()).pw_name
            for server, port in zip(SERVERS, self.inner):
                self.write(server, STORAGE.format(server=server, port=port, folder=self.folder, user=user))
            self.write("proxy", PROXY.format(port=self.port, folder=self.folder, user=user, secret=SECRET_KEY, region=REGION))
            with open(self.folder / "swift.out", "ab") as log:
                (self.folder / "memory_cache.py").write_text(CACHE)
                command = [PYTHON, "-c", START, str(self.folder), *(f"{server}:{port}" for server, port in zip(SERVERS, self.inner))]
                self.servers = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=log, stderr=log, env={**os.environ, "PYTHONPATH": str(self.folder)})
            for port in (*self.inner, self.port):
                self.until_it_listens(port)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        if self.servers is None:
            return
        self.servers.stdin.close()
        self.servers.wait()

    def write(self, name, conf):
        (self.folder / f"{name}-server.conf").write_text(conf)

    def until_it_listens(self, port):
        end = time.monotonic() + PATIENCE_S
        while True:
            try:
                socket.create_connection(("127.0.0.1", port), 1).close()
                return
            except OSError:
                if self.servers.poll() is not None:
                    raise RuntimeError(f"a server of Swift has ended: {self.logs()}") from None
                if time.monotonic() > end:
                    raise RuntimeError(f"a server of Swift doesn't listen: {self.logs()}") from None
                time.sleep(0.05)

    def logs(self):
        return (self.folder / "swift.out").read_text(errors="replace")[-3000:]

