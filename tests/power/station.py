"""The two daemons that keep users' data, as programs, and clients of their own for them: a line of JSON each way for prismesh-modeld, HTTPS for
prismesh-intake. Runs in the guest of a power cut as well as on the host, so it knows neither."""
import base64
import hashlib
import json
import pathlib
import shutil
import socket
import ssl
import subprocess
import time

SETTINGS = '[remote]\nlisten = "127.0.0.1:0"\nreserved_gb = 0\n'


class Failed(Exception):
    """A daemon refuses, or doesn't answer."""


class Local:
    """A daemon's socket on this machine."""

    def __init__(self, path):
        self.link = socket.socket(socket.AF_UNIX)
        self.link.settimeout(60)
        self.link.connect(str(path))
        self.left, self.number = b"", 0
        self.ask("hello", protocol=1, program="power cuts")

    def ask(self, request, **fields):
        """The answer; raises Failed with the daemon's sentence."""
        self.number += 1
        self.link.sendall(json.dumps({"request": request, "number": self.number, **fields}).encode() + b"\n")
        while True:
            while b"\n" not in self.left:
                piece = self.link.recv(1 << 16)
                if not piece:
                    raise Failed("the daemon has ended the connection")
                self.left += piece
            line, self.left = self.left.split(b"\n", 1)
            answer = json.loads(line)
            if answer.get("to") == self.number:
                if answer["answer"] == "failed":
                    raise Failed(f"{request}: {answer['message']}")
                return answer


class Intake:
    def __init__(self, port, token=None):
        self.port, self.token = port, token
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
        self.link = context.wrap_socket(socket.create_connection(("127.0.0.1", port), 60))
        self.left = b""

    def ask(self, method, path, body=b"", **headers):
        """The answer's body and fields. Raises Failed for any other answer than a good one, also where the connection ends."""
        try:
            status, answer, fields = self._ask(method, path, body, headers)
            while status == 429:  # asked too often
                time.sleep(0.1)
                status, answer, fields = self._ask(method, path, body, headers)
        except OSError as problem:
            raise Failed(f"{method} {path}: {problem}") from None
        if status not in (200, 201, 204):
            raise Failed(f"{method} {path}: {status} {answer.decode(errors='replace')}")
        return answer, fields

    def _ask(self, method, path, body, headers):
        lines = [f"{method} {path} HTTP/1.1", f"Host: 127.0.0.1:{self.port}", f"Content-Length: {len(body)}"]
        if self.token:
            lines.append(f"Authorization: Bearer {self.token}")
        lines += [f"{name.replace('_', '-')}: {value}" for name, value in headers.items()]
        self.link.sendall("\r\n".join(lines).encode() + b"\r\n\r\n" + body)
        while b"\r\n\r\n" not in self.left:
            self._read()
        head, self.left = self.left.split(b"\r\n\r\n", 1)
        first, *rest = head.decode().split("\r\n")
        status = int(first.split()[1])
        fields = {name.lower(): value.strip() for name, value in (line.split(":", 1) for line in rest)}
        size = 0 if status == 204 else int(fields.get("content-length", 0))
        while len(self.left) < size:
            self._read()
        answer, self.left = self.left[:size], self.left[size:]
        return status, answer, fields

    def _read(self):
        piece = self.link.recv(1 << 16)
        if not piece:
            raise Failed("intake has ended the connection")
        self.left += piece

    def upload(self, content):
        tus = {"Tus_Resumable": "1.0.0"}
        _, fields = self.ask("POST", "/uploads", Upload_Length=len(content), **tus)
        self.ask("PATCH", fields["location"], content, Upload_Offset=0, Content_Type="application/offset+octet-stream", **tus)

    def publish(self, files, main, name):
        """files: {path: bytes}."""
        text = manifest(files, main)
        self.ask("POST", "/models", text, Content_Type="application/x-prismesh-set", Prismesh_Name=base64.b64encode(name.encode()).decode())

    def models(self):
        found = []
        while True:
            page = json.loads(self.ask("GET", f"/models?skip={len(found)}&count=100")[0])
            page = page["models"] if isinstance(page, dict) else page
            found += [each["model"] for each in page]
            if len(page) < 100:
                return found

    def fetch(self, model):
        """{path: SHA-256 of the bytes that come}, and the SHA-256 of the manifest. What is refused stands as its error."""
        text = self.ask("GET", f"/models/{model}/manifest")[0]
        files = {}
        for line in text.decode().splitlines()[2:]:
            said, size, path = line.split(" ", 2)
            content = self.ask("GET", f"/models/{model}/files/{said}")[0]
            files[path] = hashlib.sha256(content).hexdigest() if len(content) == int(size) else f"{len(content)} bytes instead of {size}"
        return {"manifest": hashlib.sha256(text).hexdigest(), "files": files}


def manifest(files, main):
    lines = [f"{hashlib.sha256(files[path]).hexdigest()} {len(files[path])} {path}" for path in sorted(files, key=str.encode)]
    return ("prismesh-set 1\nmain " + main + "\n" + "\n".join(lines) + "\n").encode()


def model_of(files, main):
    """A model's hash."""
    return hashlib.sha256(manifest(files, main)).hexdigest()


class Station:
    """Both daemons on `disk`, whose folder `deck` holds the deck and `state` all that they keep."""

    def __init__(self, programs, disk, work, runtime, environment=None):
        """work: for their logs. runtime: for sockets and what passes. environment: {"modeld": {..}, "intake": {..}}, what is added to theirs."""
        self.programs, self.disk, self.work, self.runtime = (pathlib.Path(path) for path in (programs, disk, work, runtime))
        self.environment = environment or {}
        self.processes = []

    def start(self):
        self.runtime.mkdir(mode=0o700, exist_ok=True)
        (self.runtime / "station.toml").write_text(SETTINGS)
        for name in ("modeld", "intake"):
            socket_path = self.runtime / {"modeld": "model.sock", "intake": "intake.sock"}[name]
            socket_path.unlink(missing_ok=True)
            # Nothing of the machine's own settings.
            environment = {"PATH": "/usr/bin:/bin", "HOME": str(self.runtime), "LC_ALL": "C", **self.environment.get(name, {})}
            log = open(self.work / f"{name}.log", "ab")
            self.processes.append(subprocess.Popen([self.programs / f"prismesh-{name}", "--runtime-dir", self.runtime, "--state-dir", self.disk / "state" / name,
                                                    "--config", self.runtime / "station.toml"],
                                                   stdin=subprocess.DEVNULL, stdout=log, stderr=log, env=environment))
            log.close()
        for process, name in zip(self.processes, ("model.sock", "intake.sock")):
            self._wait(process, self.runtime / name)
        self.modeld = Local(self.runtime / "model.sock")
        self.port = int(Local(self.runtime / "intake.sock").ask("get_intake")["address"].rsplit(":", 1)[1])

    def _wait(self, process, path):
        end = time.monotonic() + 60
        while time.monotonic() < end:
            if process.poll() is not None:
                raise Failed(f"{path.name}: the daemon has ended: " + self.logs())
            try:
                with socket.socket(socket.AF_UNIX) as link:
                    link.connect(str(path))
                return
            except OSError:
                time.sleep(0.01)
        raise Failed(f"{path.name}: the daemon doesn't answer")

    def logs(self):
        return "".join(path.read_text(errors="replace") for path in sorted(self.work.glob("*.log")))

    def pair(self, name):
        """A token of that name, for all that a session does."""
        code = Local(self.runtime / "intake.sock").ask("make_pairing_code", scopes=["read", "upload", "remove"])["code"]
        body = json.dumps({"secret": "-".join(code.split("-")[4:]), "name": name}).encode()
        return json.loads(Intake(self.port).ask("POST", "/pair", body, Content_Type="application/json")[0])["token"]

    def open_deck(self):
        """What modeld has open by itself after a start, else the deck. Returns the state."""
        end = time.monotonic() + 60
        while True:
            state = self.modeld.ask("get_state")
            if state.get("open"):
                return state
            if not state.get("busy") or time.monotonic() > end:
                return self.modeld.ask("open", path=str(self.disk / "deck" / "main.k"))
            time.sleep(0.01)

    def facts(self, out, token, tokens=()):
        """tokens: others that were given. Writes what the station has into the folder: the deck's files as they were found and as modeld saves a copy, what intake gives out."""
        copy_files(self.disk / "deck", out / "found")
        for made in (self.disk / "copies").iterdir():
            copy_files(made, out / "copies" / made.name)
        self.start()
        state = self.open_deck()
        copy = self.runtime / "copy"
        shutil.rmtree(copy, ignore_errors=True)
        self.modeld.ask("save", path=str(copy / "main.k"), stays_unsaved=True)
        copy_files(copy, out / "copy")
        copy_files(self.disk / "deck", out / "finished")
        intake = Intake(self.port, token)
        models = {}
        for model in intake.models():
            try:
                models[model] = intake.fetch(model)
            except Failed as problem:
                models[model] = {"refused": str(problem)}
                intake = Intake(self.port, token)  # it ends the connection rather than give out other bytes
        void = {}
        for each in tokens:
            try:
                Intake(self.port, each).ask("GET", "/token")
            except Failed as problem:
                void[each] = str(problem)
        (out / "facts.json").write_text(json.dumps({"models": models, "void": void, "journalled": state.get("journalled_edits"), "warnings": state.get("warnings", [])}))
        return state

    def stop(self, by_kill=False):
        for process in self.processes:
            process.kill() if by_kill else process.terminate()
        for process in self.processes:
            process.wait(60)
        self.processes = []


def copy_files(source, target):
    target.mkdir(parents=True, exist_ok=True)
    for path in source.iterdir():
        if path.is_file():
            (target / path.name).write_bytes(path.read_bytes())
